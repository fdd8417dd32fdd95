#include "support/name_table.hpp"

#include <algorithm>
#include <functional>

namespace hysteron {

NameTable::Entry NameTable::add(std::string_view name) {
  const auto hash = static_cast<std::uint32_t>(std::hash<std::string_view>{}(name));
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = hash & mask;
  for (; slots_[at].number != free; at = (at + 1) & mask) {
    if (slots_[at].hash == hash && names_[slots_[at].number] == name) {
      return {slots_[at].number, false};
    }
  }
  const auto number = static_cast<std::uint32_t>(names_.size());
  slots_[at] = {hash, number};
  auto* const text = static_cast<char*>(memory_.allocate(name.size(), 1));
  std::ranges::copy(name, text);
  names_.emplace_back(text, name.size());
  if (2 * names_.size() > slots_.size()) {
    grow();
  }
  return {number, true};
}

void NameTable::grow() {
  std::vector<Slot> larger(2 * slots_.size());
  const std::size_t mask = larger.size() - 1;
  for (const Slot& slot : slots_) {
    if (slot.number != free) {
      std::size_t at = slot.hash & mask;
      while (larger[at].number != free) {
        at = (at + 1) & mask;
      }
      larger[at] = slot;
    }
  }
  slots_ = std::move(larger);
}

}  // namespace hysteron
