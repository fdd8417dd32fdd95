// Identifiers for generated text: the names of the diagram, in lower case, unique, and none of the target's words.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/name_table.hpp"

namespace hysteron {

class Identifiers {
 public:
  /// `reserved` are the words of the target that no identifier may be.
  explicit Identifiers(std::span<const std::string_view> reserved) {
    for (const std::string_view word : reserved) {
      taken_.add(word);
    }
  }

  /// An identifier close to the parts of a name: PLANT.HYST and XOUT → plant_hyst_xout. Empty parts do not count.
  /// Numbered where it is taken. It stays where it is as long as this object lives.
  std::string_view make(std::initializer_list<std::string_view> parts);

 private:
  NameTable taken_;
  std::vector<std::uint32_t> next_number_;  ///< by number in taken_: below it all are taken
  std::string text_;                        ///< of the identifier that is being made
};

/// A name in lower case, with anything but letters and digits made an underscore; numbered where it is a keyword.
std::string field_identifier(std::string_view name);

/// The same for the namespace of a diagram, which the C library's names must not be either.
std::string namespace_identifier(std::string_view name);

}  // namespace hysteron
