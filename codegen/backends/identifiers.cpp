#include "codegen/backends/identifiers.hpp"

#include <algorithm>
#include <unordered_set>

#include "codegen/backends/c_library_names.hpp"
#include "codegen/backends/cpp_words.hpp"

namespace hysteron {
namespace {

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

/// One character of an identifier; two underscores in a row are the compiler's.
void append_letter(std::string& text, char letter) {
  if (letter >= 'A' && letter <= 'Z') {
    text += static_cast<char>(letter - 'A' + 'a');
  } else if ((letter >= 'a' && letter <= 'z') || is_digit(letter)) {
    text += letter;
  } else if (text.empty() || text.back() != '_') {
    text += '_';
  }
}

void append_lower(std::string& text, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) {
    if (!text.empty() && !part.empty()) {
      append_letter(text, '.');
    }
    std::ranges::for_each(part, [&](char letter) { append_letter(text, letter); });
  }
  if (text.empty() || is_digit(text.front())) {
    text.insert(0, "_");
  }
}

}  // namespace

std::string field_identifier(std::string_view name) {
  std::string text;
  append_lower(text, {name});
  return std::ranges::find(cpp_keywords, text) == cpp_keywords.end() ? text : text + "_2";
}

std::string namespace_identifier(std::string_view name) {
  static const std::unordered_set<std::string_view> taken = [] {
    std::unordered_set<std::string_view> words(cpp_keywords.begin(), cpp_keywords.end());
    words.insert(cpp_own_words.begin(), cpp_own_words.end());
    for (std::string_view rest = c_library_names; !rest.empty();) {
      const auto length = std::min(rest.find_first_of(" \n"), rest.size());
      words.insert(rest.substr(0, length));
      rest.remove_prefix(std::min(length + 1, rest.size()));
    }
    return words;
  }();
  std::string text;
  append_lower(text, {name});
  return taken.contains(text) ? text + "_2" : text;
}

std::string_view Identifiers::make(std::initializer_list<std::string_view> parts) {
  text_.clear();
  append_lower(text_, parts);
  const auto [base, is_new] = taken_.add(text_);
  if (is_new) {
    return taken_[base];
  }
  if (next_number_.size() <= base) {
    next_number_.resize(taken_.size(), 2);
  }
  const std::size_t length = text_.size();
  for (;;) {
    text_.resize(length);
    text_ += '_';
    text_ += std::to_string(next_number_[base]++);
    if (const auto numbered = taken_.add(text_); numbered.is_new) {
      return taken_[numbered.number];
    }
  }
}

}  // namespace hysteron
