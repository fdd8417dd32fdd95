// Circles of a directed graph: its strongly connected components.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace hysteron {

/// The strongly connected components of `count` nodes, each after those that it needs (R. Tarjan, SIAM J. Comput. 1
/// (1972) 146), without recursion. `needs` gives the nodes that a node needs, as a list; it is asked once for each.
template <class Needs>
[[nodiscard]] std::vector<std::vector<std::uint32_t>> components_of(std::uint32_t count, const Needs& needs) {
  constexpr auto none = std::numeric_limits<std::uint32_t>::max();
  struct Visit {
    std::uint32_t node = 0;
    std::uint32_t next = 0;
    std::vector<std::uint32_t> needs{};
  };
  std::vector<std::vector<std::uint32_t>> components;
  std::vector<std::uint32_t> number(count, none);
  std::vector<std::uint32_t> lowest(count, 0);
  std::vector<bool> open(count, false);
  std::vector<std::uint32_t> component;
  std::vector<Visit> stack;
  std::uint32_t counter = 0;
  const auto enter = [&](std::uint32_t node) {
    number[node] = lowest[node] = counter++;
    open[node] = true;
    component.push_back(node);
    stack.push_back({node, 0, needs(node)});
  };
  for (std::uint32_t root = 0; root < count; ++root) {
    if (number[root] == none) {
      enter(root);
    }
    while (!stack.empty()) {
      Visit& visit = stack.back();
      const std::uint32_t node = visit.node;
      if (visit.next < visit.needs.size()) {
        const std::uint32_t other = visit.needs[visit.next++];
        if (number[other] == none) {
          enter(other);
        } else if (open[other]) {
          lowest[node] = std::min(lowest[node], number[other]);
        }
        continue;
      }
      stack.pop_back();
      if (!stack.empty()) {
        std::uint32_t& outer = lowest[stack.back().node];
        outer = std::min(outer, lowest[node]);
      }
      if (lowest[node] == number[node]) {
        components.emplace_back();
        std::uint32_t last = none;
        while (last != node) {
          last = component.back();
          component.pop_back();
          open[last] = false;
          components.back().push_back(last);
        }
      }
    }
  }
  return components;
}

}  // namespace hysteron
