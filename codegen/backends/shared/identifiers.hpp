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

/// The parts of a name as one word: PLANT.HYST and XOUT → plant_hyst_xout. Anything but letters and digits becomes an
/// underscore, with never two in a row. Empty parts do not count.
std::string identifier_text(std::initializer_list<std::string_view> parts, LetterCase letter_case);

class Identifiers {
 public:
  /// `reserved` are the words of the target that no identifier may be.
  explicit Identifiers(std::span<const std::string_view> reserved, LetterCase letter_case = LetterCase::Lower)
      : letter_case_(letter_case) {
    for (const std::string_view word : reserved) {
      taken_.add(word);
    }
  }

  /// An identifier close to the parts of a name, numbered where it is taken. It stays where it is as long as this
  /// object lives.
  std::string_view make(std::initializer_list<std::string_view> parts);

 private:
  LetterCase letter_case_;
  NameTable taken_;
  std::vector<std::uint32_t> next_number_;  ///< by number in taken_: below it all are taken
  std::string text_;                        ///< of the identifier that is being made
};

}  // namespace hysteron
