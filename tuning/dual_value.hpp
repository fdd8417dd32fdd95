// What runs with plain and with dual scalars alike ask of them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <span>

#include "codegen/interpreter/machine.hpp"
#include "tuning/dual.hpp"
#include "tuning/simulation.hpp"

namespace hysteron {

template <class S>
inline constexpr bool is_dual = false;
template <int N, int W>
inline constexpr bool is_dual<Dual<N, W>> = true;

/// An unknown: a variable where it is among the columns of the pass, else a constant.
template <class S>
S seeded(double value, Eigen::Index column, std::span<const Eigen::Index> columns) {
  if constexpr (is_dual<S>) {
    const auto found = std::ranges::find(columns, column);
    if (found != columns.end()) {
      return S::variable(value, static_cast<int>(found - columns.begin()));
    }
  }
  return S(value);
}

/// The inputs of a step; one that stands still is set in the first.
template <class S>
void set_inputs(Machine<S>& machine, const Drive& drive, std::size_t step) {
  for (std::size_t i = 0; i < drive.inputs.size(); ++i) {
    if (step == 0 || drive.inputs[i].size() > 1) {
      machine.set_input(i, at_step(drive.inputs[i], step));
    }
  }
}

}  // namespace hysteron
