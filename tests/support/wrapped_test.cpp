// Text broken to a width.
#include "support/wrapped.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "support/utf8.hpp"

namespace hysteron {
namespace {

TEST(Wrapped, BreaksAtBlanksBelowTheFirstWord) {
  EXPECT_EQ(wrapped("one two three four five six\n", 20), "one two three four\nfive six\n");
  EXPECT_EQ(wrapped("  one two three four five six", 20), "  one two three four\n  five six");
  EXPECT_EQ(wrapped("short\n\nlines\n", 20), "short\n\nlines\n");
}

TEST(Wrapped, HangsBelowTheSecondOfTwoColumns) {
  EXPECT_EQ(wrapped("  --out FILE     The result, and what is said of it in words.", 40),
            "  --out FILE     The result, and what is\n                 said of it in words.");
}

TEST(Wrapped, PutsTheSecondColumnBelowWhereItHasNoRoom) {
  EXPECT_EQ(wrapped("  --out FILE                The result, and what is said of it.", 30),
            "  --out FILE\n      The result, and what is\n      said of it.");
  EXPECT_EQ(wrapped("  -p FILE, --params FILE, --more FILE      Read.", 24),
            "  -p FILE, --params\n      FILE, --more FILE\n      Read.");
}

TEST(Wrapped, PutsFurtherOutWhatIsIndentedTooFar) {
  EXPECT_EQ(wrapped("                    The result, and what is said of it.", 30),
            "      The result, and what is\n      said of it.");
}

TEST(Wrapped, LeavesCommandsToBeCopied) {
  const char* const command = "      $ echo performance > /sys/devices/system/cpu/cpu3/cpufreq/scaling_governor";
  EXPECT_EQ(wrapped(command, 40), command);
}

TEST(Wrapped, LeavesTablesSourcesAndLongWords) {
  for (const char* const text :
       {"HYST.C1  8.0123  um/V  on its lower bound, as at the start",
        "     9 |   AMP(XNI := U, and more that stands in the line of the text);",
        "https://a.place/with/a/name/that/is/longer/than/all/that", "                      \n"}) {
    EXPECT_EQ(wrapped(text, 24), text);
  }
  EXPECT_EQ(wrapped("see https://a.place/with/a/name/that/is/long", 20),
            "see\nhttps://a.place/with/a/name/that/is/long");
}

TEST(Wrapped, CountsCharactersAndNoColours) {
  EXPECT_EQ(wrapped("größer größer größer", 20), "größer größer größer");
  EXPECT_EQ(wrapped("\033[31mone\033[0m two three four five", 20), "\033[31mone\033[0m two three four\nfive");
  EXPECT_EQ(wrapped("one two three four five six seven", 0), "one two three four five six seven");
}

TEST(Wrapped, NeverLosesAWord) {
  std::string text;
  for (int k = 0; k < 120; ++k) {
    text += std::string(1 + static_cast<std::size_t>(k * k % 17), static_cast<char>('a' + k % 26)) + " ";
  }
  for (std::size_t width = 20; width < 120; width += 7) {
    std::istringstream before(text);
    std::istringstream after(wrapped(text, width));
    std::string a;
    std::string b;
    while (before >> a) {
      ASSERT_TRUE(after >> b);
      ASSERT_EQ(a, b);
    }
    EXPECT_FALSE(after >> b);
    std::istringstream lines(wrapped(text, width));
    while (std::getline(lines, a)) {
      EXPECT_LE(character_count(a), width);
    }
  }
}

TEST(TerminalWidth, IsWhatColumnsSays) {
  ASSERT_EQ(setenv("COLUMNS", "57", 1), 0);
  EXPECT_EQ(terminal_width(stdout), 57U);
  ASSERT_EQ(setenv("COLUMNS", "wide", 1), 0);
  EXPECT_NE(terminal_width(stdout), 57U);
  unsetenv("COLUMNS");
}

}  // namespace
}  // namespace hysteron
