#include "support/markup.hpp"

namespace hysteron {

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";  // XML has &apos;, HTML 4 has not
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace hysteron
