// Identifiers for generated text: the names of the diagram, in lower case, unique, and none of the target's words.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace hysteron {

class Identifiers {
 public:
  /// `reserved` are the words of the target that no identifier may be.
  explicit Identifiers(std::span<const std::string_view> reserved) {
    for (const std::string_view word : reserved) {
      taken_.emplace(word);
    }
  }

  /// An identifier close to a name: PLANT.HYST → plant_hyst. Numbered where it is taken.
  std::string make(std::string_view name);

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, int> next_number_;  ///< by name: below it all are taken
};

/// A name in lower case, with anything but letters and digits made an underscore.
std::string lower_identifier(std::string_view name);

}  // namespace hysteron
