// The slots of a hash table whose entries stand elsewhere, each with a number: open addressing, linear probing.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace hysteron {

class HashSlots {
 public:
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t entry = free;
    [[nodiscard]] bool is_free() const { return entry == free; }
  };

  /// The slot of the entry with this hash that `is_it`, or the free one where it would stand. Until the next `fill`.
  template <class IsIt>
  [[nodiscard]] std::size_t find(std::uint32_t hash, IsIt is_it) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash & mask;
    while (!slots_[at].is_free() && !(slots_[at].hash == hash && is_it(slots_[at].entry))) {
      at = (at + 1) & mask;
    }
    return at;
  }
  [[nodiscard]] const Slot& operator[](std::size_t at) const { return slots_[at]; }

  /// Fills a slot that `find` gave.
  void fill(std::size_t at, Slot slot) {
    slots_[at] = slot;
    if (2 * ++count_ > slots_.size()) {
      grow(2 * slots_.size());
    }
  }

  void reserve(std::size_t entries) {
    if (2 * entries > slots_.size()) {
      grow(std::bit_ceil(2 * entries));
    }
  }

 private:
  static constexpr std::uint32_t free = 0xFFFFFFFF;

  void grow(std::size_t size) {
    std::vector<Slot> smaller = std::exchange(slots_, std::vector<Slot>(size));
    for (const Slot& slot : smaller) {
      if (!slot.is_free()) {
        slots_[find(slot.hash, [](std::uint32_t) { return false; })] = slot;
      }
    }
  }

  std::vector<Slot> slots_ = std::vector<Slot>(16);  ///< a power of two, at most half of it taken
  std::size_t count_ = 0;
};

}  // namespace hysteron
