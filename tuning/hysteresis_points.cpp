// See hysteresis_points.hpp.
#include "tuning/hysteresis_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

/// Indices of the turning points of u: an extreme counts once u has gone back from it by more than the dead band. On a
/// plateau it is the last sample of the plateau, where the new branch begins.
std::vector<std::size_t> turning_points(std::span<const double> u, double dead_band) {
  std::vector<std::size_t> turns;
  std::size_t extreme = 0;
  int direction = 0;
  for (std::size_t k = 1; k < u.size(); ++k) {
    const double ahead = direction >= 0 ? u[k] - u[extreme] : u[extreme] - u[k];
    if (direction == 0) {
      if (std::fabs(ahead) > dead_band) {
        direction = ahead > 0.0 ? 1 : -1;
        extreme = k;
      }
    } else if (ahead >= 0.0) {
      extreme = k;
    } else if (-ahead > dead_band) {
      turns.push_back(extreme);
      direction = -direction;
      extreme = k;
    }
  }
  return turns;
}

struct Formula {
  std::size_t behind = 0;  ///< samples that it needs before k
  std::size_t ahead = 0;   ///< and after
};

Formula reach(const HysteresisPointOptions& options) {
  switch (options.formula) {
    case RateFormula::TwoPoint:
      return {1, 0};
    case RateFormula::Central:
      return {1, 1};
    case RateFormula::LocalQuadratic:
      return {options.half_width, options.half_width};
  }
  return {};
}

double rate(std::span<const double> x, std::size_t k, double sample_time, const HysteresisPointOptions& options) {
  switch (options.formula) {
    case RateFormula::TwoPoint:
      return (x[k] - x[k - 1]) / sample_time;
    case RateFormula::Central:
      return (x[k + 1] - x[k - 1]) / (2.0 * sample_time);
    case RateFormula::LocalQuadratic: {
      // Σ j·x(k+j) / Σ j²: on an even grid the parabola has the slope of the line.
      double weighted = 0.0;
      double squares = 0.0;
      for (std::size_t j = 1; j <= options.half_width; ++j) {
        const auto distance = static_cast<double>(j);
        weighted += distance * (x[k + j] - x[k - j]);
        squares += 2.0 * distance * distance;
      }
      return weighted / (squares * sample_time);
    }
  }
  return 0.0;
}

}  // namespace

HysteresisPoints hysteresis_points(std::span<const double> u, std::span<const double> y, double sample_time,
                                   const HysteresisPointOptions& options, const std::string& source) {
  if (u.size() != y.size() || !(sample_time > 0.0) ||
      (options.formula == RateFormula::LocalQuadratic && options.half_width == 0)) {
    throw std::invalid_argument("hysteresis points: u and y of different lengths, no sample time, or no width");
  }
  for (std::size_t k = 0; k < u.size(); ++k) {
    if (!std::isfinite(u[k]) || !std::isfinite(y[k])) {
      throw InputError(error::unusable_point, {.file = source},
                       fmt::format("Sample {} of the record is not finite.", k + 1),
                       "Cut the record there, or look for the fault in its recording.");
    }
  }
  HysteresisPoints result;
  result.source = source;
  result.branching_samples = turning_points(u, options.dead_band);
  if (result.branching_samples.empty()) {
    throw InputError(
        error::too_few_points, {.file = source},
        "The input never reverses its direction, so that p, the distance from the last branching point, is "
        "unknown.",
        "Record an input with several reversals that covers the range of the actuator.");
  }
  const Formula needs = reach(options);
  double fastest = 0.0;
  for (std::size_t b = 0; b < result.branching_samples.size(); ++b) {
    const std::size_t begin = result.branching_samples[b];
    const std::size_t end = b + 1 < result.branching_samples.size() ? result.branching_samples[b + 1] : u.size() - 1;
    for (std::size_t k = begin + needs.behind; k + needs.ahead <= end; ++k) {
      const double u_rate = rate(u, k, sample_time, options);
      fastest = std::max(fastest, std::fabs(u_rate));
      if (!(std::fabs(u_rate) > options.rate_threshold)) {
        ++result.slow;
        continue;
      }
      const double here = options.formula == RateFormula::TwoPoint ? 0.5 * (u[k] + u[k - 1]) : u[k];
      result.p.push_back(std::fabs(here - u[begin]));
      result.M.push_back(rate(y, k, sample_time, options) / u_rate);
      result.sample.push_back(k);
    }
  }
  if (result.p.empty()) {
    throw InputError(error::no_motion, {.file = source},
                     fmt::format("No sample has |du/dt| above the threshold {}; the fastest has {}.",
                                 options.rate_threshold, fastest),
                     "Lower the threshold, or record a faster input.");
  }
  return result;
}

}  // namespace hysteron
