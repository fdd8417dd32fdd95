// Distinct names, each with a number: the texts stand side by side in memory that is never moved.
//
// A diagram of 10⁵ instances has half a million names; as strings of their own in a set they cost more time than all
// the text that is written with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <string_view>
#include <vector>

#include "support/hash_slots.hpp"

namespace hysteron {

class NameTable {
 public:
  struct Entry {
    std::uint32_t number = 0;  ///< 0, 1, 2 … in the order of their coming
    bool is_new = false;
  };

  /// The number of a name; the next one where the name is not there yet.
  Entry add(std::string_view name);

  /// A name by its number. It stays where it is as long as the table lives.
  [[nodiscard]] std::string_view operator[](std::uint32_t number) const { return names_[number]; }
  [[nodiscard]] std::size_t size() const { return names_.size(); }

 private:
  std::pmr::monotonic_buffer_resource memory_;
  std::vector<std::string_view> names_;
  HashSlots slots_{};
};

}  // namespace hysteron
