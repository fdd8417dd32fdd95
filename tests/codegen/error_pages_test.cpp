// The pages of the diagnostics of diagrams: each number has its page with its title, the text that fails gives that
// number, and the text that mends it gives none.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/language/syntax.hpp"
#include "support/errors.hpp"
#include "tests/support/error_page.hpp"

namespace hysteron::test {
namespace {

/// What a text is found guilty of.
using Checker = std::function<std::vector<int>(const std::string&)>;

std::vector<int> numbers_of(const Diagnostics& diagnostics) {
  std::vector<int> numbers;
  for (const auto& one : diagnostics.all()) {
    numbers.push_back(one.number);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<int> parsed(const std::string& text) {
  Diagnostics diagnostics;
  language::parse("page.st", text, diagnostics);
  return numbers_of(diagnostics);
}

std::vector<int> compiled(const std::string& text) {
  Diagnostics diagnostics;
  auto file = language::parse("page.st", text, diagnostics);
  if (file.valid) {
    compile(std::make_shared<const language::SourceFile>(std::move(file)), {}, diagnostics);
  }
  return numbers_of(diagnostics);
}

/// With what `check` alone tells.
std::vector<int> checked(const std::string& text) {
  Diagnostics diagnostics;
  auto file = language::parse("page.st", text, diagnostics);
  check(std::make_shared<const language::SourceFile>(std::move(file)), diagnostics);
  return numbers_of(diagnostics);
}

/// Compiled, and laid out to be run.
std::vector<int> run(const std::string& text) {
  try {
    const Machine<double> machine(compile_text(text));
    return {};
  } catch (const InputError& problem) {
    return numbers_of(problem.diagnostics());
  }
}

/// Numbers that a diagram can have, by the checker that finds them.
std::vector<std::pair<int, Checker>> diagram_errors() {
  std::vector<std::pair<int, Checker>> list;
  for (const auto& title : error_titles()) {
    if (title.number < 500) {
      const bool is_run = title.number == error::missing_sample_time;
      const bool is_checked = title.number == error::other_meaning_elsewhere;
      // Of what a body cannot have some is seen when its graph is made.
      const bool is_parsed = title.number < 200 && title.number != error::refused_in_body;
      list.emplace_back(title.number, is_parsed    ? Checker(parsed)
                                      : is_run     ? Checker(run)
                                      : is_checked ? Checker(checked)
                                                   : Checker(compiled));
    }
  }
  return list;
}

TEST(ErrorPages, EveryNumberHasItsPageWithItsTitle) {
  for (const auto& title : error_titles()) {
    const auto number = "HY" + std::to_string(title.number);
    try {
      const auto page = read_error_page(number);
      EXPECT_EQ(page.number, number);
      EXPECT_EQ(page.title, title.title);
    } catch (const std::exception& problem) {
      ADD_FAILURE() << number << ": " << problem.what();
    }
  }
}

TEST(ErrorPages, EveryPageHasItsNumber) {
  for (const auto& entry : std::filesystem::directory_iterator(HYSTERON_SOURCE_DIR "/docs/errors")) {
    const auto name = entry.path().stem().string();
    if (name == "README") {
      continue;  // their list
    }
    EXPECT_TRUE(std::ranges::any_of(error_titles(), [&](const ErrorTitle& title) {
      return name == "HY" + std::to_string(title.number);
    })) << entry.path();
  }
}

TEST(ErrorPages, AreListedByTheirTitles) {
  std::ifstream file(HYSTERON_SOURCE_DIR "/docs/errors/README.md");
  std::string listed;
  for (std::string line; std::getline(file, line);) {
    listed += line.starts_with("| [HY") ? line + "\n" : "";
  }
  std::string expected;
  for (const auto& title : error_titles()) {
    expected += "| [HY" + std::to_string(title.number) + "](HY" + std::to_string(title.number) + ".md) | " +
                std::string(title.title) + " |\n";
  }
  EXPECT_EQ(listed, expected) << "print it by scripts/make-reference";
}

TEST(ErrorPages, NumbersAreSortedAndSingle) {
  EXPECT_TRUE(std::ranges::is_sorted(error_titles(),
                                     [](const ErrorTitle& a, const ErrorTitle& b) { return a.number <= b.number; }));
}

TEST(ErrorPages, DiagramsFailAndAreMendedAsThePageSays) {
  std::size_t tried = 0;
  for (const auto& [number, check] : diagram_errors()) {
    const auto page = read_error_page("HY" + std::to_string(number));
    if (page.fails.kind != "st") {
      continue;  // a command line, run by the tests of the tool
    }
    ++tried;
    // One slip is one message.
    EXPECT_EQ(check(page.fails.text), std::vector<int>{number}) << page.number << "\n" << page.fails.text;
    EXPECT_EQ(check(page.mended.text), std::vector<int>{}) << page.number;
    EXPECT_EQ(compiled(page.mended.text), std::vector<int>{}) << page.number << "\n" << page.mended.text;
    Diagnostics diagnostics;
    const auto mended = language::parse("page.st", page.mended.text, diagnostics);
    EXPECT_EQ(language::format(mended), page.mended.text) << page.number;
  }
  EXPECT_GT(tried, 40U);
}

}  // namespace
}  // namespace hysteron::test
