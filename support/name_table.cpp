#include "support/name_table.hpp"

#include <algorithm>
#include <functional>

namespace hysteron {

NameTable::Entry NameTable::add(std::string_view name) {
  const auto hash = static_cast<std::uint32_t>(std::hash<std::string_view>{}(name));
  const std::size_t at = slots_.find(hash, [&](std::uint32_t number) { return names_[number] == name; });
  if (!slots_[at].is_free()) {
    return {slots_[at].entry, false};
  }
  const auto number = static_cast<std::uint32_t>(names_.size());
  slots_.fill(at, {hash, number});
  auto* const text = static_cast<char*>(memory_.allocate(name.size(), 1));
  std::ranges::copy(name, text);
  names_.emplace_back(text, name.size());
  return {number, true};
}

}  // namespace hysteron
