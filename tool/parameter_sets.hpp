// Sets of parameters for a batch: the rows of a table, a grid, or random draws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron::tool {

struct SetOptions {
  std::string file{};                    ///< a table in CSV: its head names parameters, each row is a set
  std::vector<std::string> sweeps{};     ///< INV.C1=0.1..0.3/21: 21 values, ends included; several make a grid
  std::vector<std::string> draws{};      ///< INV.C1=normal(0.2,0.01) or uniform(0.1,0.3)
  std::optional<std::uint64_t> count{};  ///< of draws
  std::uint64_t seed = 1;                ///< of draws
};

struct ParameterSets {
  std::vector<std::string> paths{};          ///< of the parameters that are varied, in capitals
  std::vector<std::vector<double>> rows{};   ///< by set: their values
  std::vector<std::vector<double>> whole{};  ///< by set: the values of all parameters of the graph, elements of arrays
                                             ///< one after the other
  [[nodiscard]] std::size_t size() const { return rows.size(); }
};

/// More sets than these are refused: their table would not be read by anybody.
inline constexpr std::size_t most_sets = 1'000'000;

/// The same draws for the same seed, on any machine. Throws InputError: HY730 where an option says no set or more than
/// one kind of them, HY501 to HY506 for the table, and HY603, HY604 and HY214 where the diagram cannot take a value.
[[nodiscard]] ParameterSets parameter_sets(const SetOptions& options, const Graph& graph);

}  // namespace hysteron::tool
