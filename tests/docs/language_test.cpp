// The page of the language says what the compiler does: each name that it lists as reserved is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>

#include "codegen/compile.hpp"
#include "codegen/language/syntax.hpp"
#include "support/errors.hpp"
#include "tests/docs/page.hpp"

namespace hysteron::test {
namespace {

std::string reserved_words() {
  const Page page = read_page(source_folder() / "docs" / "reference" / "language.md");
  const auto found =
      std::ranges::find_if(page.snippets, [](const Snippet& snippet) { return snippet.has("reserved"); });
  return found == page.snippets.end() ? std::string() : found->text;
}

/// The number of the first error of a diagram whose input has this name; 0 for none.
int error_of_name(const std::string& name) {
  Diagnostics diagnostics;
  auto file = language::parse("name.st",
                              "FUNCTION_BLOCK F\nVAR_INPUT " + name +
                                  " : LREAL; END_VAR\nVAR_OUTPUT Y : LREAL := 0.0; " + "END_VAR\nEND_FUNCTION_BLOCK\n",
                              diagnostics);
  if (file.valid) {
    check(std::make_shared<const language::SourceFile>(std::move(file)), diagnostics);
  }
  return diagnostics.all().empty() ? 0 : diagnostics.all().front().number;
}

TEST(LanguagePage, EveryReservedNameIsRefused) {
  std::istringstream words(reserved_words());
  std::size_t count = 0;
  for (std::string word; words >> word; ++count) {
    const int number = error_of_name(word);
    // Words that end or begin a part of a block are refused as such: HY1xx.
    EXPECT_TRUE(number == error::reserved_name || (number > 100 && number < 200)) << word << ": HY" << number;
  }
  EXPECT_GT(count, 150U);
  EXPECT_EQ(error_of_name("POSITION"), 0);
}

}  // namespace
}  // namespace hysteron::test
