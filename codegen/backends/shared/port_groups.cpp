#include "codegen/backends/shared/port_groups.hpp"

#include <algorithm>

#include "support/element_name.hpp"

namespace hysteron {

std::vector<PortGroup> port_groups(const std::vector<Port>& ports) {
  std::vector<PortGroup> groups;
  for (std::uint32_t i = 0; i < ports.size();) {
    const auto begin = element_of(ports[i].name);
    std::uint32_t length = 1;
    const auto before = i > 0 ? element_of(ports[i - 1].name) : std::nullopt;
    // What begins below 0 is no array of a target, in which 0 is the first.
    const bool goes_on = begin && before && before->vector == begin->vector && before->index < 0;
    if (begin && begin->index == 0 && !goes_on) {
      const auto continues = [&](std::size_t at) {
        const auto element = at < ports.size() ? element_of(ports[at].name) : std::nullopt;
        return element && element->vector == begin->vector && element->index == length &&
               ports[at].type == ports[i].type;
      };
      while (continues(i + length)) {
        ++length;
      }
    }
    groups.push_back(
        {.name = length > 1 ? begin->vector : std::string_view(ports[i].name), .first = i, .length = length});
    i += length;
  }
  return groups;
}

bool has_arrays(const std::vector<Port>& ports) {
  return std::ranges::any_of(port_groups(ports), &PortGroup::is_array);
}

}  // namespace hysteron
