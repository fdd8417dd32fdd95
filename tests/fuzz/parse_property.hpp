// What holds for every text whatever, right or wrong, when it is parsed and formatted.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/language/syntax.hpp"
#include "support/errors.hpp"
#include "tests/codegen/language/dump.hpp"

namespace hysteron::test {

namespace detail {

inline std::string flaw_of_diagnostic(const Diagnostic& one, std::uint32_t lines) {
  const bool known =
      std::ranges::any_of(error_titles(), [&](const ErrorTitle& title) { return title.number == one.number; });
  if (!known || one.number < 100 || one.number > 199) {
    return "a diagnostic with a number that is not of the syntax";
  }
  if (one.place.line < 1 || one.place.line > lines || one.place.column < 1 || one.place.length < 1) {
    return "a diagnostic outside of the text";
  }
  return one.cause.empty() || one.mend.empty() ? "a diagnostic without cause or mend" : "";
}

inline language::StatementOrders reversed(const language::SourceFile& file) {
  language::StatementOrders orders;
  for (const auto& block : file.blocks) {
    auto& order = orders.emplace_back(block.statements.size());
    std::iota(order.rbegin(), order.rend(), 0U);
  }
  return orders;
}

inline std::string flaw_of_format(const language::SourceFile& file) {
  const auto once = language::format(file);
  Diagnostics diagnostics;
  const auto again = language::parse("again", once, diagnostics);
  if (!again.valid) {
    return "formatting makes an error: " + diagnostics.all().front().cause;
  }
  if (Dump(again).whole() != Dump(file).whole()) {
    return "formatting changes the tree";
  }
  if (language::format(again) != once) {
    return "formatting twice differs from formatting once";
  }
  const auto turned = language::parse("turned", language::format(file, reversed(file)), diagnostics);
  if (!turned.valid || language::format(turned) != *turned.text) {
    return "formatting with another order of the statements is not stable";
  }
  for (std::size_t b = 0; b < file.blocks.size(); ++b) {
    const auto& statements = file.blocks[b].statements;
    for (std::size_t i = 0; i < statements.size(); ++i) {
      if (Dump(turned).statement(turned.blocks[b].statements[statements.size() - 1 - i]) !=
          Dump(file).statement(statements[i])) {
        return "the statements are not in the order that was given";
      }
    }
  }
  return "";
}

}  // namespace detail

/// What is wrong with the parser or the formatter, seen on this text; empty if nothing.
inline std::string parse_flaw(std::string_view text) {
  Diagnostics diagnostics;
  const auto file = language::parse("text", std::string(text), diagnostics);
  if (file.valid == diagnostics.has_errors()) {
    return "valid and has_errors contradict each other";
  }
  const auto lines = static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n') + 1);
  for (const auto& one : diagnostics.all()) {
    if (auto flaw = detail::flaw_of_diagnostic(one, lines); !flaw.empty()) {
      return flaw;
    }
  }
  if (!file.valid) {
    return language::format(file) == text ? "" : "formatting changes a text that it cannot read";
  }
  return detail::flaw_of_format(file);
}

}  // namespace hysteron::test
