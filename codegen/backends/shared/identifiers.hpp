// Identifiers for generated text: the names of the diagram, unique, and none of the target's words.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/name_table.hpp"

namespace hysteron {

enum class LetterCase : std::uint8_t { Lower, Upper };

/// The parts of a name as one word: PLANT.HYST and XOUT → plant_hyst_xout, Y[2] → y_2. Anything but letters and digits becomes an
/// underscore, with never two in a row. Empty parts do not count.
std::string identifier_text(std::initializer_list<std::string_view> parts, LetterCase letter_case);

class Identifiers {
 public:
  /// `reserved` are the words of the target that no identifier may be.
  explicit Identifiers(std::span<const std::string_view> reserved) {
    for (const std::string_view word : reserved) {
      taken_.add(word);
    }
  }

  /// For a target whose words are told by a function.
  Identifiers(bool (*is_word)(std::string_view), LetterCase letter_case)
      : is_word_(is_word), letter_case_(letter_case) {}

  /// An identifier close to the parts of a name, numbered where it is taken. It stays where it is as long as this
  /// object lives.
  std::string_view make(std::initializer_list<std::string_view> parts);

  /// A name as it stands, also where it is a word of the target.
  std::string_view take(std::string_view name);

 private:
  bool (*is_word_)(std::string_view) = nullptr;  ///< null: the words are in taken_
  LetterCase letter_case_ = LetterCase::Lower;
  NameTable taken_;
  std::vector<std::uint32_t> next_number_;  ///< by number in taken_: below it all are taken
  std::string text_;                        ///< of the identifier that is being made
};

}  // namespace hysteron
