// The points as a Prometheus server scrapes them: the text format, version 0.0.4.
//
//   # HELP hysteron_task_cycles_total cycles that were run
//   # TYPE hysteron_task_cycles_total counter
//   hysteron_task_cycles_total{point="task.cycles"} 1200
//   # HELP hysteron_output_u the output U
//   # TYPE hysteron_output_u gauge
//   hysteron_output_u{point="U",unit="V"} 12.5
//
// A name is derived from a point: hysteron_, its kind (but for what the task says of itself), its name in small letters
// with _ for what a metric's name may not have, _seconds where it is a time, which is then given in seconds, and _total
// where it counts. The label `point` has the name as it is. Points whose names differ by that label alone are one
// family. Commands are orders, and left out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/point.hpp"

namespace hysteron::runtime::web {

inline constexpr std::string_view metrics_target = "/metrics";
inline constexpr std::string_view metrics_type = "text/plain; version=0.0.4; charset=utf-8";

class Metrics {
 public:
  explicit Metrics(std::span<const Point> points);

  /// The whole exposition. `values` are those of the points, in their order.
  [[nodiscard]] std::string text(std::span<const double> values) const;

 private:
  struct Sample {
    std::size_t point = 0;
    std::string series{};  ///< its name and labels
    double divisor = 1.0;
  };
  struct Family {
    std::string name{};
    std::string heading{};  ///< HELP and TYPE
    std::vector<Sample> samples{};
  };

  std::vector<Family> families_{};
};

}  // namespace hysteron::runtime::web
