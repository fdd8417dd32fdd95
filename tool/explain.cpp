#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/whole_number.hpp"
#include "support/wrapped.hpp"
#include "tool/commands.hpp"
#include "tool/error_pages.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view explain_examples = R"(Examples:
  hysteron explain HY402
  hysteron explain

Prints the page of an error: what it means, a text that fails, and the text that mends it. Without a number it lists all.
Exit codes: 0 done; 2 there is no such error.
)";

/// HY402, hy402 or 402; 0 where it is none of these.
int number_of(std::string_view text) {
  if (text.size() > 2 && equal_ignoring_case(text.substr(0, 2), "HY")) {
    text.remove_prefix(2);
  }
  return whole_number<int>(text).value_or(0);
}

/// Whether a line of Markdown stands by itself: a title, a row of a table.
bool stands_alone(std::string_view line) {
  return line.empty() || line.front() == '#' || line.front() == '|';
}

/// Whether it begins an item of a list.
bool is_item(std::string_view line) {
  const auto behind = std::min(line.find_first_not_of("0123456789"), line.size());
  return line.starts_with("- ") || (behind > 0 && line.substr(behind).starts_with(". "));
}

/// Markdown with each paragraph and each item in one line, so that it can be broken to the width of a terminal.
std::string with_flowing_paragraphs(std::string_view page) {
  std::string text;
  bool is_code = false;
  bool goes_on = false;
  while (!page.empty()) {
    const auto end = std::min(page.find('\n'), page.size());
    auto line = page.substr(0, end);
    page.remove_prefix(std::min(end + 1, page.size()));
    const bool is_fence = line.starts_with("```");
    is_code = is_fence ? !is_code : is_code;
    const bool stays = is_code || is_fence || stands_alone(line);
    if (goes_on && !stays && !is_item(line)) {
      line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
      text += ' ';
    } else {
      text += text.empty() ? "" : "\n";
    }
    text += line;
    goes_on = !stays;
  }
  return text + "\n";
}

int explain(const std::string& wanted, Console& console) {
  if (wanted.empty()) {
    for (const ErrorTitle& one : error_titles()) {
      console.print(fmt::format("HY{}  {}\n", one.number, one.title));
    }
    return exit_ok;
  }
  const int number = number_of(wanted);
  const auto pages = error_pages();
  const auto page = std::ranges::find(pages, number, &ErrorPage::number);
  if (page == pages.end()) {
    throw InputError(error::bad_usage, {}, fmt::format("There is no error {}.", wanted),
                     "`hysteron explain` lists all; an error has the form HY402.");
  }
  console.print(terminal_width(stdout) == 0 ? std::string(page->text) : with_flowing_paragraphs(page->text));
  return exit_ok;
}

}  // namespace

Action add_explain(CLI::App& app) {
  const auto wanted = std::make_shared<std::string>();
  app.add_option("ERROR", *wanted, "The number of the error, as HY402.");
  app.footer(std::string(explain_examples));
  return [wanted](Console& console) { return explain(*wanted, console); };
}

}  // namespace hysteron::tool
