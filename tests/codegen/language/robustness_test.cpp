// Random texts: soups of tokens and mutated diagrams. Whatever they are, the parser says what is wrong or reads them,
// and what it reads is formatted without loss.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <string_view>

#include "tests/codegen/language/samples.hpp"
#include "tests/fuzz/parse_property.hpp"

namespace hysteron::test {
namespace {

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(engine_()) % n; }

 private:
  std::mt19937 engine_;
};

constexpr std::array<std::string_view, 62> words{"FUNCTION_BLOCK",
                                                 "END_FUNCTION_BLOCK",
                                                 "VAR",
                                                 "VAR_INPUT",
                                                 "VAR_OUTPUT",
                                                 "CONSTANT",
                                                 "END_VAR",
                                                 "VAR_IN_OUT",
                                                 "RETAIN",
                                                 "IF",
                                                 "THEN",
                                                 "END_IF",
                                                 "ELSE",
                                                 "FOR",
                                                 "END_FOR",
                                                 "NOT",
                                                 "AND",
                                                 "OR",
                                                 "XOR",
                                                 "MOD",
                                                 "TRUE",
                                                 "FALSE",
                                                 "ARRAY",
                                                 "PROGRAM",
                                                 "LREAL",
                                                 "BOOL",
                                                 "A",
                                                 "B_1",
                                                 "C__D",
                                                 "HY_GAIN",
                                                 "1.0",
                                                 "42",
                                                 "16#FF",
                                                 "1.",
                                                 "T#1s",
                                                 "LREAL#1.0",
                                                 "(",
                                                 ")",
                                                 "[",
                                                 "]",
                                                 ",",
                                                 ";",
                                                 ":",
                                                 ":=",
                                                 "=>",
                                                 ".",
                                                 "+",
                                                 "-",
                                                 "*",
                                                 "/",
                                                 "**",
                                                 "<",
                                                 "<=",
                                                 "<>",
                                                 "=",
                                                 "&",
                                                 "(* @unit um *)",
                                                 "(* c\n  c *)",
                                                 "//x\n",
                                                 "{p}",
                                                 "'s'",
                                                 "\n"};

TEST(Robustness, SoupsOfTokens) {
  Random random(1);
  for (int round = 0; round < 3000; ++round) {
    std::string text = round % 3 == 0 ? "" : (round % 3 == 1 ? "FUNCTION_BLOCK F " : "FUNCTION_BLOCK F VAR ");
    for (auto left = random.below(60); left > 0; --left) {
      text += words[random.below(words.size())];
      text += random.below(5) == 0 ? "" : " ";
    }
    ASSERT_EQ(parse_flaw(text), "") << text;
  }
}

TEST(Robustness, SoupsOfBytes) {
  Random random(2);
  for (int round = 0; round < 1000; ++round) {
    std::string text;
    for (auto left = random.below(200); left > 0; --left) {
      text += static_cast<char>(random.below(256));
    }
    ASSERT_EQ(parse_flaw(text), "") << text;
  }
}

TEST(Robustness, MutatedDiagrams) {
  Random random(3);
  int still_right = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string text(sample_diagrams[random.below(sample_diagrams.size())]);
    for (auto left = 1 + random.below(3); left > 0; --left) {
      const auto at = random.below(text.size());
      const auto length = 1 + random.below(8);
      switch (random.below(6)) {
        case 0:
          text.erase(at, length);
          break;
        case 1:
          text.insert(at, words[random.below(words.size())]);
          break;
        case 2:
          text.insert(at, text.substr(random.below(text.size()), length));
          break;
        case 3:
          text[at] = static_cast<char>(random.below(256));
          break;
        case 4:
          text.insert(at, random.below(2) == 0 ? " " : "\n");
          break;
        default:
          text.insert(at, "(* x *)");
      }
      text += text.empty() ? " " : "";
    }
    ASSERT_EQ(parse_flaw(text), "") << text;
    Diagnostics diagnostics;
    still_right += language::parse("", text, diagnostics).valid ? 1 : 0;
  }
  EXPECT_GT(still_right, 200);
}

TEST(Robustness, EveryBeginningOfADiagram) {
  for (const auto sample : sample_diagrams) {
    for (std::size_t length = 0; length < sample.size(); ++length) {
      ASSERT_EQ(parse_flaw(sample.substr(0, length)), "") << sample.substr(0, length);
    }
  }
}

}  // namespace
}  // namespace hysteron::test
