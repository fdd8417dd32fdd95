#include "support/name_index.hpp"

#include <algorithm>
#include <cstring>

#include "support/names.hpp"

namespace hysteron {
namespace {

/// Eight characters at a time. A bit that tells small letters from capitals is set in each; that it is set in other
/// characters, too, lets some names share a hash.
std::uint32_t hash_of(std::string_view name) {
  constexpr std::uint64_t small = 0x2020202020202020;
  constexpr std::uint64_t factor = 0x9E3779B97F4A7C15;
  std::uint64_t hash = name.size();
  for (; !name.empty(); name.remove_prefix(std::min<std::size_t>(name.size(), 8))) {
    std::uint64_t word = 0;
    std::memcpy(&word, name.data(), std::min<std::size_t>(name.size(), 8));
    hash = (hash ^ (word | small)) * factor;
    hash ^= hash >> 32U;
  }
  return static_cast<std::uint32_t>(hash);
}

bool same(std::string_view a, std::string_view b) {
  return a == b || equal_ignoring_case(a, b);
}

}  // namespace

std::size_t NameIndex::slot_of(std::string_view name, std::uint32_t hash) const {
  return slots_.find(hash, [&](std::uint32_t entry) { return same(name_of(entries_[entry]), name); });
}

bool NameIndex::add(std::string_view name, std::uint32_t number) {
  const std::uint32_t hash = hash_of(name);
  const std::size_t at = slot_of(name, hash);
  if (!slots_[at].is_free()) {
    return false;
  }
  slots_.fill(at, {hash, static_cast<std::uint32_t>(entries_.size())});
  entries_.push_back({static_cast<std::uint32_t>(names_.size()), static_cast<std::uint32_t>(name.size()), number});
  names_ += name;
  return true;
}

const std::uint32_t* NameIndex::find(std::string_view name) const {
  const HashSlots::Slot& slot = slots_[slot_of(name, hash_of(name))];
  return slot.is_free() ? nullptr : &entries_[slot.entry].number;
}

void NameIndex::reserve(std::size_t names) {
  entries_.reserve(names);
  slots_.reserve(names);
}

}  // namespace hysteron
