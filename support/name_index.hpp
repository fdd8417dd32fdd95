// Names with a number each, found without regard to the case of ASCII letters.
//
// A map of strings in capitals would do the same. Of 10⁵ instances it takes an eighth of the time in which their text
// is read: each question makes a string, and follows two pointers into memory that is far away.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "support/hash_slots.hpp"

namespace hysteron {

class NameIndex {
 public:
  /// False where the name is there: its number stays.
  bool add(std::string_view name, std::uint32_t number);

  /// The number of a name; null where it is not there. Until the next name is added.
  [[nodiscard]] const std::uint32_t* find(std::string_view name) const;
  [[nodiscard]] bool contains(std::string_view name) const { return find(name) != nullptr; }
  /// Of a name that is there.
  [[nodiscard]] std::uint32_t at(std::string_view name) const { return *find(name); }

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  void reserve(std::size_t names);

 private:
  struct Entry {
    std::uint32_t begin = 0;  ///< in names_
    std::uint32_t length = 0;
    std::uint32_t number = 0;
  };
  /// Where a name is, or where it would stand.
  [[nodiscard]] std::size_t slot_of(std::string_view name, std::uint32_t hash) const;
  [[nodiscard]] std::string_view name_of(const Entry& entry) const {
    return std::string_view(names_).substr(entry.begin, entry.length);
  }

  std::string names_{};  ///< one behind the other, as they were written
  std::vector<Entry> entries_{};
  HashSlots slots_{};
};

}  // namespace hysteron
