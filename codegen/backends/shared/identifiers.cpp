#include "codegen/backends/shared/identifiers.hpp"

#include <algorithm>

namespace hysteron {
namespace {

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

/// One character of an identifier; two underscores in a row are the compiler's.
void append_letter(std::string& text, char letter, LetterCase letter_case) {
  constexpr char between = 'a' - 'A';
  if (letter >= 'A' && letter <= 'Z') {
    text += static_cast<char>(letter_case == LetterCase::Lower ? letter + between : letter);
  } else if (letter >= 'a' && letter <= 'z') {
    text += static_cast<char>(letter_case == LetterCase::Upper ? letter - between : letter);
  } else if (is_digit(letter)) {
    text += letter;
  } else if (letter != ']' && (text.empty() || text.back() != '_')) {  // Y[2] is y_2
    text += '_';
  }
}

void append_identifier(std::string& text, std::initializer_list<std::string_view> parts, LetterCase letter_case) {
  for (const std::string_view part : parts) {
    if (!text.empty() && !part.empty()) {
      append_letter(text, '.', letter_case);
    }
    char before = 0;
    for (const char letter : part) {  // Y[-1] is y_m1: y_1 is Y[1]
      append_letter(text, before == '[' && letter == '-' ? 'm' : letter, letter_case);
      before = letter;
    }
  }
  if (letter_case == LetterCase::Upper && text.size() > 1 && text.back() == '_') {  // IEC 61131-3 has none at the end
    text.pop_back();
  }
  if (text.empty() || is_digit(text.front())) {
    text.insert(0, "_");
  }
}

}  // namespace

std::string identifier_text(std::initializer_list<std::string_view> parts, LetterCase letter_case) {
  std::string text;
  append_identifier(text, parts, letter_case);
  return text;
}

std::string_view Identifiers::make(std::initializer_list<std::string_view> parts) {
  text_.clear();
  append_identifier(text_, parts, letter_case_);
  const auto [base, is_new] = taken_.add(text_);
  if (is_new && (is_word_ == nullptr || !is_word_(text_))) {
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
    // The numbered name may be a word itself: M_PI_2 is one of C.
    if (const auto numbered = taken_.add(text_); numbered.is_new && (is_word_ == nullptr || !is_word_(text_))) {
      return taken_[numbered.number];
    }
  }
}

std::string_view Identifiers::take(std::string_view name) {
  return taken_[taken_.add(name).number];
}

}  // namespace hysteron
