// Texts that once broke the parser, or reach far into it, stay mended: the corpus of the fuzzer, in every build.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/fuzz/parse_property.hpp"

namespace hysteron::test {
namespace {

TEST(Corpus, ParserAndFormatterHoldOnEveryText) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HYSTERON_SOURCE_DIR "/tests/fuzz/corpus/parse")) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    EXPECT_EQ(parse_flaw(text), "") << entry.path();
    ++count;
  }
  EXPECT_GT(count, 10U);
}

}  // namespace
}  // namespace hysteron::test
