// A sensor whose clock runs fast: a record then holds the output ahead of its time, by more and more,
//
//   y_record(t) = y((1 + a)·t),   a > 0,
//
// which no causal block repeats, HY_CLOCK with a SKEW of −a but for a few samples, as it cannot know what comes. The
// record does: the output is read at t/(1 + a) instead, between samples by a cubic through the four about it (Catmull
// and Rom 1974), and is as a sensor with the right clock would have given it. It is mended so before anything is
// searched, where the calibrated diagram then leaves no more than noise, or a hundredth of its energy, of more than two
// floors before: a clock that runs slow, and one beside other effects, are the search's.
#pragma once

#include <optional>

#include "diagnosis/faults/left_out.hpp"

namespace hysteron::diagnosis {

struct FastClock {
  Task task{};        ///< with the output as it would have been
  LeftOut finding{};  ///< SKEW of HY_CLOCK, below 0
};

/// `task.scales` are set. Nothing where samples are left out: they would be smeared.
[[nodiscard]] std::optional<FastClock> fast_clock(const Task& task, const Program& program);

}  // namespace hysteron::diagnosis
