// A small plot of expected and got round a failing step, as text.
//
//       step          t    expected         got
//          3    0.00015        0.75        0.75  |         *         |
//   >      4     0.0002         1.5        1.25  |             o  x  |
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "tuning/simulation.hpp"

namespace hysteron::tool {

/// Rows of the steps round `step`; what is expected may be known at some of them only.
[[nodiscard]] std::string plot_of(std::size_t step, std::span<const double> time,
                                  const std::map<std::size_t, double>& expected, const Signal& got);

}  // namespace hysteron::tool
