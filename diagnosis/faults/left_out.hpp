// Samples that no fit shall see, since a few of them would outweigh all else: glitches, and values that were repeated
// because a sample was missed. They are counted, not fitted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/noise/noise_floor.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// Those of one kind in one output.
struct LeftOut {
  std::string effect{};                        ///< glitches, clock
  std::size_t output = 0;                      ///< by its place among the task's
  double rms = 0.0;                            ///< √(Σe²/N) over all N samples, in the unit of the output
  std::string remark{};                        ///< for the user
  std::vector<ParameterFinding> parameters{};  ///< how many, and how large
  std::vector<std::size_t> glitches{};         ///< their rows in the output
};

/// What was counted, not fitted, and has no interval.
[[nodiscard]] ParameterFinding as_counted(std::string name, double value, std::string unit = "1");

/// Of an explanation, with what was left out of its fit.
[[nodiscard]] Model model_of_all_rows(const Task& task, const Explanation& one);

/// Finds them, the largest ones of an output first, and takes their rows out of the task. `task.scales` are set.
[[nodiscard]] std::vector<LeftOut> leave_out(Task& task, const Program& program);

/// Takes out what only shows beside an explanation, where what is new of it is no small part of the noise: whether
/// there was any.
[[nodiscard]] bool leave_out_beside(std::vector<LeftOut>& found, Task& task, const Explanation& chosen,
                                    const std::vector<NoiseFloor>& floors);

/// Glitches that an explanation gives, as the answer to a single sample of the input, are none: it never saw them.
void forget_explained(std::vector<LeftOut>& found, const Task& task, const Explanation& chosen);

}  // namespace hysteron::diagnosis
