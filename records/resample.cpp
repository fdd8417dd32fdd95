#include "records/resample.hpp"

#include <algorithm>
#include <cmath>

#include "support/median.hpp"

namespace hysteron::records {
namespace {

/// A time that is meant to be that of a sample may be off by rounding: of the sample time.
constexpr double rounding = 1e-6;

}  // namespace

std::vector<double> even_times(double first, double last, double sample_time) {
  const auto steps = static_cast<std::size_t>(std::floor((last - first) / sample_time + rounding));
  std::vector<double> times(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k) {
    times[k] = first + static_cast<double>(k) * sample_time;
  }
  return times;
}

std::vector<double> resampled(std::span<const double> time, std::span<const double> values, std::span<const double> at,
                              Resampling way, ResamplingCost& cost) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < time.size(); ++k) {
    steps.push_back(time[k] - time[k - 1]);
  }
  const double usual = median(steps);
  const double half = at.size() > 1 ? 0.5 * (at[1] - at[0]) : 0.5 * usual;
  const double equal = rounding * 2.0 * half;
  std::vector<double> result;
  result.reserve(at.size());
  std::size_t behind = 0;  // the first sample later than the row
  std::size_t low = 0;     // the first sample within half a sample time
  std::size_t made_up = 0;
  double late = 0.0;
  double farthest = 0.0;
  for (const double now : at) {
    while (behind < time.size() && time[behind] <= now + equal) {
      ++behind;
    }
    const std::size_t before = behind > 0 ? behind - 1 : 0;
    const std::size_t after = std::min(behind, time.size() - 1);
    const double since = now - time[before];
    const double until = time[after] - now;
    const bool in_gap = time[after] - time[before] > 1.5 * usual && since > equal && until > equal;
    made_up += in_gap ? 1 : 0;
    const double nearer = std::max(0.0, std::min(std::abs(since), std::abs(until)));
    farthest = std::max(farthest, way == Resampling::Hold ? std::abs(since) : nearer);
    late += way == Resampling::Hold ? std::max(0.0, since) : 0.0;
    const double span = time[after] - time[before];
    const double part = span > 0.0 ? std::clamp(since / span, 0.0, 1.0) : 0.0;
    const double on_line = values[before] + part * (values[after] - values[before]);
    switch (way) {
      case Resampling::Hold:
        result.push_back(values[before]);
        break;
      case Resampling::Average: {
        // As wide on both sides, also at the ends, and samples at the edges count by half: a ramp stays a ramp.
        const double within = std::min({half, now - time.front() + equal, time.back() - now + equal});
        while (low < time.size() && time[low] < now - half - equal) {
          ++low;
        }
        double sum = 0.0;
        double weights = 0.0;
        for (std::size_t k = low; k < time.size() && time[k] <= now + within + equal; ++k) {
          const double off = std::abs(time[k] - now);
          const double weight = off > within + equal ? 0.0 : off > within - equal && within > 2.0 * equal ? 0.5 : 1.0;
          sum += weight * values[k];
          weights += weight;
        }
        result.push_back(weights > 0.0 ? sum / weights : on_line);
        break;
      }
      default:
        result.push_back(on_line);
    }
  }
  cost.rows = at.size();
  cost.made_up = std::max(cost.made_up, made_up);
  cost.farthest = std::max(cost.farthest, farthest);
  cost.delay = std::max(cost.delay, at.empty() ? 0.0 : late / static_cast<double>(at.size()));
  return result;
}

std::string name_of(Resampling way) {
  switch (way) {
    case Resampling::Linear:
      return "linear";
    case Resampling::Hold:
      return "hold";
    case Resampling::Average:
      return "average";
    default:
      return "none";
  }
}

}  // namespace hysteron::records
