#include "support/shell_words.hpp"

#include <algorithm>
#include <cctype>

namespace hysteron {

std::string shell_quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result + "'";
}

std::string shell_word(std::string_view word) {
  const bool is_plain = !word.empty() && std::ranges::all_of(word, [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-./+:,=@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  return is_plain ? std::string(word) : shell_quoted(word);
}

}  // namespace hysteron
