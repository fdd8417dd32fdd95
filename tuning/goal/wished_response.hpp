// The response that a control loop is wished to have: a lag of first order, or an oscillation, behind a dead time.
//
//   order 1:   T·y' + y = u                  order 2:   T²·y'' + 2·ζ·T·y' + y = u
#pragma once

#include "codegen/parameters/parameter_file.hpp"
#include "tuning/simulation.hpp"

namespace hysteron {

struct WishedResponse {
  int order = 2;
  double time = 1.0;       ///< T, in s
  double damping = 1.0;    ///< ζ
  double dead_time = 0.0;  ///< in s
  double settling = 0.0;   ///< after a step, in s: from then on within 2 %, the dead time included
};

/// From rise_time (10 to 90 % of a step) or settling_time (to 2 %, without the dead time) of a goal that has one.
[[nodiscard]] WishedResponse wished_response(const parameters::GoalSettings& goal);

/// Its output for an input that is held from sample to sample and stood for ever at its first value: exact. The dead
/// time is a whole number of samples, the nearest.
[[nodiscard]] Signal response_to(const WishedResponse& wished, const Signal& input, double sample_time);

}  // namespace hysteron
