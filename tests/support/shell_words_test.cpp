#include "support/shell_words.hpp"

#include <gtest/gtest.h>

namespace hysteron {
namespace {

TEST(ShellWords, AreQuotedWhereAShellWouldTakeThemApart) {
  EXPECT_EQ(shell_word("--rows=1..60"), "--rows=1..60");
  EXPECT_EQ(shell_word("Motor speed"), "'Motor speed'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
  EXPECT_EQ(shell_quoted("a"), "'a'");
}

}  // namespace
}  // namespace hysteron
