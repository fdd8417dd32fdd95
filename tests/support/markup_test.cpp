#include "support/markup.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

namespace hysteron {
namespace {

/// The text as a reader of XML sees it.
std::string read_back(std::string text) {
  // &amp; last: what it gives is no entity.
  const std::array<std::pair<std::string, std::string>, 5> entities{
      {{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}}};
  for (const auto& [entity, character] : entities) {
    for (auto at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1)) {
      text.replace(at, entity.size(), character);
    }
  }
  return text;
}

TEST(Markup, EscapesWhatMarkupReads) {
  EXPECT_EQ(escaped("a < b && c > 'd' \"e\""), "a &lt; b &amp;&amp; c &gt; &#39;d&#39; &quot;e&quot;");
  EXPECT_EQ(escaped(""), "");
  EXPECT_EQ(escaped("µm/V\t½\n"), "µm/V\t½\n");
}

TEST(Markup, EveryByteReadsBackAndNoneOpensATag) {
  std::string text;
  for (int byte = 0; byte < 256; ++byte) {
    text += static_cast<char>(byte);
  }
  text += "&amp; &lt;b&gt; &#39;";  // text that looks escaped is escaped again
  EXPECT_EQ(read_back(escaped(text)), text);
  EXPECT_EQ(escaped(text).find_first_of("<>\"'"), std::string::npos);
}

}  // namespace
}  // namespace hysteron
