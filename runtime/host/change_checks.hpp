// What is known of an online change before a step of it is tried: what is wished, whether the new version has the same
// inputs and outputs, and how far each output may jump.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/task/changeable_program.hpp"
#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

struct ChangeWish {
  bool only_check = false;
  std::map<std::string, double> bumps{};  ///< by output: a limit for this change alone, in its unit
  std::vector<std::string> as_given{};  ///< parameters that are not carried over, but taken as the new version has them
  std::optional<double> load{};         ///< of the period, what a step may take at this change
};

/// The wish with every name as the version has it: a name is looked for without regard to case, and that of a vector is
/// each of its elements. Throws InputError HY730 where there is none, and where two limits are of one output.
[[nodiscard]] ChangeWish as_named(const ChangeWish& wish, const ProgramShape& next);

/// Registers and devices were planned with the inputs and outputs: throws InputError HY850 where a version has others.
void require_same_interface(const ProgramShape& has, const ProgramShape& next);

/// How far an output may jump, where the run file says it: bump under [outputs.NAME]; else 1 % of the range between low
/// and high; else, without a range, not at all.
struct OutputLimit {
  BumpLimit limit{};
  std::string origin{};
};
[[nodiscard]] std::vector<OutputLimit> bump_limits(const RunConfig& config, const ProgramShape& shape);

}  // namespace hysteron::runtime
