#include "records/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "records/time/time_grid.hpp"
#include "support/names.hpp"

namespace hysteron::records {
namespace {

/// A time that is meant to be that of a sample may be off by rounding: of the sample time.
constexpr double rounding = 1e-6;

struct Way {
  Resampling way{};
  std::string_view name{};
};
constexpr std::array ways{Way{Resampling::None, "none"}, Way{Resampling::Linear, "linear"},
                          Way{Resampling::Hold, "hold"}, Way{Resampling::Average, "average"}};

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
  const double usual = median_step(time);
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

std::string_view name_of(Resampling way) {
  return std::ranges::find(ways, way, &Way::way)->name;
}

std::optional<Resampling> resampling_of(std::string_view name) {
  const auto* const found =
      std::ranges::find_if(ways, [&](const Way& one) { return equal_ignoring_case(one.name, name); });
  return found == ways.end() || found->way == Resampling::None ? std::nullopt : std::optional(found->way);
}

}  // namespace hysteron::records
