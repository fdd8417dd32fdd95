#include "support/utf8.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace hysteron {
namespace {

TEST(Utf8, TellsWhereATextStopsBeingUtf8) {
  EXPECT_EQ(first_invalid_utf8("plain text, longer than eight bytes"), std::string_view::npos);
  EXPECT_EQ(first_invalid_utf8("µm, Ω, 日本, 😀"), std::string_view::npos);
  EXPECT_EQ(first_invalid_utf8("12345678\xB5m"), 8U) << "µ in Latin-1";
  EXPECT_EQ(first_invalid_utf8("a\xC3"), 1U) << "cut off";
  EXPECT_EQ(first_invalid_utf8("\xC0\x80"), 0U) << "overlong";
  EXPECT_EQ(first_invalid_utf8("\xE0\x80\x80"), 0U) << "overlong";
  EXPECT_EQ(first_invalid_utf8("\xED\xA0\x80"), 0U) << "surrogate";
  EXPECT_EQ(first_invalid_utf8("\xF4\x90\x80\x80"), 0U) << "beyond U+10FFFF";
  EXPECT_EQ(first_invalid_utf8("\xFF\xFEt"), 0U) << "UTF-16";
}

std::string encoded(unsigned code) {
  const auto byte = [](unsigned value) { return static_cast<char>(value); };
  if (code < 0x80) {
    return {byte(code)};
  }
  if (code < 0x800) {
    return {byte(0xC0 | (code >> 6U)), byte(0x80 | (code & 0x3FU))};
  }
  if (code < 0x10000) {
    return {byte(0xE0 | (code >> 12U)), byte(0x80 | ((code >> 6U) & 0x3FU)), byte(0x80 | (code & 0x3FU))};
  }
  return {byte(0xF0 | (code >> 18U)), byte(0x80 | ((code >> 12U) & 0x3FU)), byte(0x80 | ((code >> 6U) & 0x3FU)),
          byte(0x80 | (code & 0x3FU))};
}

TEST(Utf8, EveryCodePointIsOneCharacter) {
  for (unsigned code = 0; code <= 0x10FFFF; ++code) {
    const auto text = encoded(code);
    const bool surrogate = code >= 0xD800 && code < 0xE000;
    ASSERT_EQ(first_invalid_utf8(text) == std::string_view::npos, !surrogate) << code;
    ASSERT_EQ(utf8_length(text), surrogate ? 1U : text.size()) << code;
  }
  EXPECT_EQ(character_count("5 µm 😀"), 6U);
  EXPECT_EQ(character_count("\xFF\xFE"), 2U);
}

TEST(Utf8, PrintableTextCannotSteerATerminal) {
  EXPECT_EQ(printable("a\033[2Jb\rc\td\x7F"), "a\uFFFD[2Jb\uFFFDc\td\uFFFD");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\uFFFD31m")
      << "CSI as a C1 control";
  EXPECT_EQ(printable("5 \xB5m"), "5 \uFFFDm");
  EXPECT_EQ(printable("5 µm"), "5 µm");
}

TEST(Utf8, AClippedTextKeepsWholeCharacters) {
  EXPECT_EQ(clipped("µmµm", 4), "µmµm");
  EXPECT_EQ(clipped("µmµmµ", 4), "µmµ…");
  EXPECT_EQ(clipped("abc", 1), "…");
  EXPECT_EQ(clipped("", 3), "");
  for (std::size_t most = 1; most < 8; ++most) {
    EXPECT_LE(character_count(clipped("a€\xff𝄞b", most)), std::max<std::size_t>(most, 1));
  }
}

}  // namespace
}  // namespace hysteron
