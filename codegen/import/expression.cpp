#include "codegen/import/expression.hpp"

#include <algorithm>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron::import {
namespace {

constexpr std::string_view before = "FUNCTION_BLOCK A VAR_OUTPUT A : LREAL; END_VAR A := ";

/// The text as the only assignment of a block; nothing where it is more or less than that.
std::optional<language::SourceFile> parsed(const std::string& text, language::ExpressionId& value) {
  if (text.find_first_of(";@\n\r") != std::string::npos || text.find("(*") != std::string::npos) {
    return std::nullopt;
  }
  Diagnostics diagnostics;
  language::SourceFile file =
      language::parse("expression", std::string(before) + text + "; END_FUNCTION_BLOCK", diagnostics);
  if (diagnostics.has_errors() || file.blocks.size() != 1 || file.blocks.front().statements.size() != 1) {
    return std::nullopt;
  }
  const auto* const assignment = std::get_if<language::Assignment>(&file.blocks.front().statements.front());
  if (assignment == nullptr) {
    return std::nullopt;
  }
  value = assignment->value;
  return file;
}

/// Of V[2] and V[-1].
std::optional<std::int64_t> constant_place(const language::SourceFile& file, language::ExpressionId index) {
  double number = 0.0;
  Type type{};
  const bool known = index != language::no_expression && constant_value(file, index, number, type);
  return known && type == Type::Int ? std::optional(static_cast<std::int64_t>(number)) : std::nullopt;
}

}  // namespace

std::optional<std::string> rewrite_expression(const std::string& text, const Rename& rename) {
  language::ExpressionId value = language::no_expression;
  const auto file = parsed(text, value);
  if (!file) {
    return std::nullopt;
  }
  std::vector<const language::Expression*> references;
  bool plain = true;
  for (const language::Expression& one : file->expressions) {
    if (std::holds_alternative<language::Reference>(one.node)) {
      references.push_back(&one);
    }
    plain = plain && !std::holds_alternative<language::Binary>(one.node) &&
            !std::holds_alternative<language::Unary>(one.node);
  }
  std::ranges::sort(references, {}, [](const language::Expression* one) { return one->span.offset; });
  std::string result;
  std::size_t end = before.size();
  for (const language::Expression* const one : references) {
    const auto& reference = std::get<language::Reference>(one->node);
    NameRead read{.name = std::string(reference.name.text), .pin = std::string(reference.pin.text)};
    read.place = read.pin.empty() ? constant_place(*file, reference.index) : std::nullopt;
    const language::Span& last = read.pin.empty() ? reference.name.span : reference.pin.span;
    result += file->text->substr(end, one->span.offset - end);
    result += rename(read);
    end = read.place ? one->span.offset + one->span.length : last.offset + last.length;
  }
  result += text.substr(end - before.size());
  return plain ? result : "(" + result + ")";
}

std::optional<Type> type_of_literal(const std::string& text) {
  language::ExpressionId value = language::no_expression;
  const auto file = parsed(text, value);
  double number = 0.0;
  Type type{};
  return file && constant_value(*file, value, number, type) ? std::optional(type) : std::nullopt;
}

}  // namespace hysteron::import
