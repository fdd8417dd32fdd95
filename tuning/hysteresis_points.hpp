// From a measured record u(t), y(t) to points (p, M) of the static map: steps 1 and 2 of Procedure 1.
//
//   p = |u − u_i|,   M = ∂y/∂u = ẏ/u̇ ,   u_i the last branching point                         (11), (12)
//
// Both derivatives come from the same formula, so that its gain and delay cancel in the quotient. Points are left out
// - before the first branching point, where p is unknown;
// - where the formula reaches across a branching point;
// - where |u̇| is not above a threshold (250 V/s in the paper): there noise divided by little is all that is left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "tuning/static_map.hpp"

namespace hysteron {

enum class RateFormula : std::uint8_t {
  TwoPoint,  ///< (x(k) − x(k−1))/TS: M in the middle of the step, and p is taken there too. Exact for a quadratic y(u).
  Central,        ///< (x(k+1) − x(k−1))/2TS
  LocalQuadratic  ///< slope of the least-squares parabola through 2h+1 samples (Savitzky and Golay): noise falls as
                  ///< h^−1.5
};

struct HysteresisPointOptions {
  RateFormula formula = RateFormula::Central;
  std::size_t half_width = 5;   ///< h of the local parabola, samples
  double rate_threshold = 0.0;  ///< of |u̇|, unit of u over s; a point needs more than this
  double dead_band = 0.0;       ///< unit of u: a reversal counts once u has gone back by more than this
};

struct HysteresisPoints {
  std::vector<double> p{};
  std::vector<double> M{};
  std::vector<std::size_t> sample{};             ///< index in the record
  std::vector<std::size_t> branching_samples{};  ///< where the direction of u reverses
  std::size_t slow = 0;                          ///< points left out for their rate
  std::string source{};

  [[nodiscard]] StaticMapPoints points() const { return {.p = p, .M = M, .weight = {}, .source = source}; }
};

/// @param sample_time seconds
/// @throws InputError HY710 where u never reverses, HY713 where no sample is fast enough, HY714 for a sample that is
/// not finite.
HysteresisPoints hysteresis_points(std::span<const double> u, std::span<const double> y, double sample_time,
                                   const HysteresisPointOptions& options = {}, const std::string& source = {});

}  // namespace hysteron
