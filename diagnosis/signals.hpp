// The signals on the edges of a diagram while it runs over the records, and the sizes that a search scales itself by.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/edges.hpp"
#include "diagnosis/model.hpp"

namespace hysteron::diagnosis {

/// How large a signal is and how fast it moves, over all records.
struct Extent {
  double low = 0.0;
  double high = 0.0;
  std::vector<double> levels{};  ///< its values in steps of 1 % of the samples, 101 of them
  std::vector<double> rates{};   ///< |rate| a second, likewise

  [[nodiscard]] double range() const { return high - low; }
};

struct EdgeSignal {
  std::vector<std::vector<double>> values{};  ///< by record
  Extent extent{};
};

[[nodiscard]] Extent extent_of(const std::vector<std::vector<double>>& values, double sample_time);

/// The values of a wire of a program, by record, with the parameters of the task.
[[nodiscard]] std::vector<std::vector<double>> wire_values(const Task& task, const Program& program, const Wire& wire,
                                                           const VectorXd& known);

}  // namespace hysteron::diagnosis
