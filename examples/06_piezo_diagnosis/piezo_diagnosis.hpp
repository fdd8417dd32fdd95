// Example 6: what the paper's model of a real piezo stack lacks, effect by effect.
#pragma once

#include <string>
#include <vector>

#include "examples/06_piezo_diagnosis/rounds.hpp"

namespace hysteron::examples {

/// The effects that a stack on one axis can have: nothing rubs or turns, and there is no second axis.
[[nodiscard]] const std::vector<std::string>& effects_of_a_stack();

/// The record from the lowest voltage of cycle 2 on, where the model's first branch begins.
struct StackCycles {
  records::Record fitted;  ///< cycles 2 to 21
  records::Record whole;
  double range = 0.0;  ///< of y over the whole, um
};

[[nodiscard]] StackCycles cycles_of(const records::Record& identification);

/// How far a model is from the stack.
struct StackGap {
  std::vector<double> residual{};  ///< model - measured over the whole, um
  double fitted = 0.0;             ///< RMSE over the range of y, cycles 2 to 21
  double held_out = 0.0;           ///< and over the rest
};

[[nodiscard]] StackGap gap_of(const Round& round, const StackCycles& cycles);

}  // namespace hysteron::examples
