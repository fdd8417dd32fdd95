// Example 2: the paper's Procedure 1 and its alternatives, on points of M(p) = C1 + C2·p^C3 (17).
#pragma once

#include <array>
#include <vector>

#include "examples/example.hpp"
#include "tuning/hysteresis_points.hpp"
#include "tuning/static_map.hpp"

namespace hysteron::examples {

struct MapPoints {
  std::vector<double> p{};
  std::vector<double> M{};
  [[nodiscard]] StaticMapPoints view() const { return {.p = p, .M = M, .weight = {}, .source = "the simulated loop"}; }
};

/// The map of Example 1, with the reconciled α: (2.45e-9 m/V, 1.6e-11 m/V², 1).
StaticMap loop_map();

/// Steps 1 and 2 of Procedure 1 on the loop of Example 1, 1 kHz, |du/dt| above 250 V/s. Without noise the rates are
/// differences of two samples, which are exact for this loop. With noise on y (standard deviation in m) they are slopes
/// of the parabola through 11 samples.
MapPoints points_from_loop(double noise);

/// 200 exact points of M = 0.05 + 1.3·p^1.7 over 0 < p ≤ 1, on which Procedure 1 as printed leaves the truth.
inline constexpr StaticMap counterexample_map{0.05, 1.3, 1.7};
MapPoints counterexample();

struct NamedFit {
  const char* name = "";
  StaticMapFit fit{};
};

/// The four fits on the same points. Both forms of Procedure 1 start from 0.95 times the true C1; the form as printed
/// ends after 20 rounds.
std::array<NamedFit, 4> four_fits(const MapPoints& points, const StaticMap& truth);

}  // namespace hysteron::examples
