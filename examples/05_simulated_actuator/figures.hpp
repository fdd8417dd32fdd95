// What the records of the simulated machine show, in the figures by which a real actuator is described.
#pragma once

#include <cstddef>
#include <span>

namespace simulated {

struct LoopFigures {
  double range = 0.0;     ///< largest less smallest y after the first period, µm
  double width = 0.0;     ///< of the loop, falling less rising branch at the middle voltage, share of the range
  double line_rms = 0.0;  ///< what the best straight line y(u) leaves, share of the range
  double creep = 0.0;     ///< growth of the mean of a period, µm in a decade of time
  double noise = 0.0;     ///< from period to period, standard deviation, µm
};

/// Of a record of whole periods after the first, which is left out.
LoopFigures figures_of(std::span<const double> u, std::span<const double> y, std::size_t samples_per_period);

}  // namespace simulated
