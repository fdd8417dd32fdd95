// Units: what a unit text means, and whether the units along all wires of a graph agree.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "codegen/graph/schedule.hpp"

namespace hysteron::units {

/// Whether a text is a unit (SI symbols and prefixes, products, quotients, powers; `1` for none). Says why not.
bool is_unit(std::string_view text, std::string& reason);

/// The factor from one unit to another (`um` to `m`: 1e-6); false where their dimensions differ or one is unknown.
bool conversion(std::string_view from, std::string_view to, double& factor);

/// Checks the units of all wires. Blocks are polymorphic in unit variables ('x): each instance takes the units that
/// are wired. A port without a unit is not checked. Reports HY301 where two units cannot agree.
void check(const Graph& graph, const Schedule& schedule, Diagnostics& diagnostics);

/// The units of a graph as its wires give them, solved once for all that is asked: C1 of a slope between um and V is
/// um/V. A text is empty where the diagram does not say enough.
class Solution {
 public:
  /// The graph must outlive it.
  Solution(const Graph& graph, const Schedule& schedule);
  Solution(const Solution&) = delete;
  Solution& operator=(const Solution&) = delete;
  ~Solution();

  [[nodiscard]] std::vector<std::string> parameters() const;
  /// By node and output; an operation has none.
  [[nodiscard]] std::vector<std::vector<std::string>> outputs() const;
  /// By node and state; an operation has none.
  [[nodiscard]] std::vector<std::vector<std::string>> states() const;

 private:
  struct Solved;
  std::unique_ptr<Solved> solved_;
};

}  // namespace hysteron::units
