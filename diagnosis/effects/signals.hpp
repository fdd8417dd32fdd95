// The signals on the edges of a diagram while it runs over the records, and the sizes that a search scales itself by.
#pragma once

#include <span>
#include <vector>

#include "diagnosis/effects/edges.hpp"
#include "diagnosis/model/model.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {

/// A signal over each of the records.
using RecordSignals = std::vector<Signal>;

/// How large a signal is and how fast it moves, over all records.
struct Extent {
  double low = 0.0;
  double high = 0.0;
  double usual = 0.0;           ///< what lies between its first and its last percent: the range but for rare peaks
  std::size_t levels = 0;       ///< how many of its 101 percentiles differ: few where it is switched between levels
  double first = 0.0;           ///< the largest |value| at a record's start
  double begin = 0.0;           ///< the value at the first record's start
  std::vector<double> rates{};  ///< its |rate| a second in steps of 1 % of the samples, 101 of them

  [[nodiscard]] double range() const { return high - low; }
};

[[nodiscard]] Extent extent_of(const RecordSignals& values, double sample_time);

/// The signals of some wires of a program, with the values of the task's file and of its known parameters.
[[nodiscard]] std::vector<RecordSignals> wire_signals(const Task& task, const Program& program,
                                                      const std::vector<Wire>& wires, const VectorXd& known);

}  // namespace hysteron::diagnosis
