#include "codegen/backends/shared/port_groups.hpp"

#include <algorithm>
#include <optional>

#include "support/element_name.hpp"

namespace hysteron {
namespace {

/// `name(i)` of each of `count` variables; `alike(a, b)`: two elements may stand in one array.
template <class Name, class Alike>
std::vector<PortGroup> groups_of(std::size_t count, Name name, Alike alike) {
  std::vector<PortGroup> groups;
  for (std::uint32_t i = 0; i < count;) {
    const std::optional<ElementName> begin = element_of(name(i));
    std::uint32_t length = 1;
    const auto before = i > 0 && alike(i - 1, i) ? element_of(name(i - 1)) : std::nullopt;
    // What begins below 0 is no array of a target, in which 0 is the first.
    const bool goes_on = begin && before && before->vector == begin->vector && before->index < 0;
    if (begin && begin->index == 0 && !goes_on) {
      const auto continues = [&](std::uint32_t at) {
        const auto element = at < count ? element_of(name(at)) : std::nullopt;
        return element && element->vector == begin->vector && element->index == length && alike(i, at);
      };
      while (continues(i + length)) {
        ++length;
      }
    }
    groups.push_back({.name = length > 1 ? begin->vector : name(i), .first = i, .length = length});
    i += length;
  }
  return groups;
}

}  // namespace

std::vector<PortGroup> port_groups(const std::vector<Port>& ports) {
  return groups_of(
      ports.size(), [&](std::uint32_t i) { return std::string_view(ports[i].name); },
      [&](std::uint32_t a, std::uint32_t b) { return ports[a].type == ports[b].type; });
}

std::vector<PortGroup> cell_groups(std::span<const CellInfo> cells) {
  return groups_of(
      cells.size(), [&](std::uint32_t i) { return cells[i].field.name; },
      [&](std::uint32_t a, std::uint32_t b) {
        const CellInfo& one = cells[a];
        const CellInfo& other = cells[b];
        return one.node == other.node && one.held == other.held && one.field.type == other.field.type &&
               one.instance == other.instance && one.field.length == 1 && other.field.length == 1;
      });
}

std::vector<std::uint32_t> declared_lengths(std::span<const CellInfo> cells) {
  std::vector<std::uint32_t> lengths(cells.size(), 0);
  for (const PortGroup& group : cell_groups(cells)) {
    lengths[group.first] = group.is_array() ? group.length : cells[group.first].field.length;
  }
  return lengths;
}

bool has_arrays(const std::vector<Port>& ports) {
  return std::ranges::any_of(port_groups(ports), &PortGroup::is_array);
}

}  // namespace hysteron
