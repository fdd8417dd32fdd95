// Positions of the protocol against offsets.
#include "lsp/document.hpp"

#include <gmock/gmock.h>

namespace hysteron {
namespace {

TEST(LspPosition, ComesBackFromEveryBeginOfACharacter) {
  const std::string text = "a\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80z\r\nx\n\nlast";
  for (const auto encoding : {lsp::Encoding::Utf16, lsp::Encoding::Utf8}) {
    for (const std::size_t offset : {0U, 1U, 3U, 6U, 10U, 11U, 13U, 14U, 15U, 16U, 20U}) {
      EXPECT_EQ(lsp::offset_of(text, lsp::position_of(text, offset, encoding), encoding), offset);
    }
  }
}

TEST(LspPosition, CountsTwoUnitsAboveTheBasicPlane) {
  const std::string text = "\xF0\x9F\x98\x80z";
  EXPECT_EQ(lsp::position_of(text, 4, lsp::Encoding::Utf16).character, 2U);
  EXPECT_EQ(lsp::position_of(text, 4, lsp::Encoding::Utf8).character, 4U);
  EXPECT_EQ(lsp::offset_of(text, {0, 1}, lsp::Encoding::Utf16), 0U) << "within a character";
}

TEST(LspPosition, BehindTheEndIsTheEnd) {
  EXPECT_EQ(lsp::offset_of("ab\r\ncd", {0, 99}, lsp::Encoding::Utf16), 2U);
  EXPECT_EQ(lsp::offset_of("ab\r\ncd", {99, 0}, lsp::Encoding::Utf16), 6U);
  EXPECT_EQ(lsp::offset_of("", {5, 5}, lsp::Encoding::Utf16), 0U);
}

TEST(LspPosition, PathsOfUrisAreDecoded) {
  EXPECT_EQ(lsp::path_of("file:///a%20b/%C3%A4.st"), "/a b/\xC3\xA4.st");
  EXPECT_EQ(lsp::path_of("file:///a%zz%2"), "/a%zz%2");
  EXPECT_EQ(lsp::path_of("untitled:1"), "untitled:1");
}

}  // namespace
}  // namespace hysteron
