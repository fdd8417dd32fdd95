#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/whole_number.hpp"
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
  console.print(page->text);
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
