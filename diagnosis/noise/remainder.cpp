#include "diagnosis/noise/remainder.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "diagnosis/noise/discrepancy.hpp"
#include "diagnosis/noise/noise_colour.hpp"
#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {
namespace {

/// What may be noise where a record is too short to show its fast part.
constexpr double unseen_of_differences = 1.67;
/// Slow noise may be so many times the fast part; what is more moves the machine, though no cycle repeats it and it
/// goes on while inputs rest.
constexpr double slow_over_fast = 2.0;

double most_noise(const NoiseFloor& floor) {
  constexpr double of_differences = 3.0;  // a pole of 0.8
  if (floor.evidence == "differences") {
    return of_differences;
  }
  return floor.evidence == "repeats" ? 1.0 : policy::hidden_noise.value;
}

Discrepancy largest_discrepancy(const Model& model, const VectorXd& residuals, std::size_t outputs) {
  const Index rows = residuals.size() / static_cast<Index>(outputs);
  Discrepancy largest;
  for (Index output = 0; output < static_cast<Index>(outputs); ++output) {
    const Discrepancy here = discrepancy(model.problem().experiments, residuals.segment(output * rows, rows));
    if (here.rms > largest.rms) {
      largest = here;
    }
  }
  return largest;
}

}  // namespace

double possible_noise(const NoiseFloor& floor, const VectorXd& residuals, const std::vector<std::size_t>& samples) {
  const double fast = noise_by_fast_part(residuals, samples);
  if (!(fast > 0.0)) {
    return floor.evidence == "differences" ? unseen_of_differences : 1.0;
  }
  return std::clamp(fast, 1.0 / slow_over_fast, most_noise(floor));
}

std::vector<double> possible_noise(const Model& model, const std::vector<NoiseFloor>& floors,
                                   const VectorXd& residuals) {
  const std::vector<std::size_t> samples = model.samples();
  const Index rows = residuals.size() / std::ssize(floors);
  std::vector<double> noise;
  for (Index output = 0; output < std::ssize(floors); ++output) {
    const NoiseFloor& floor = floors[static_cast<std::size_t>(output)];
    noise.push_back(possible_noise(floor, residuals.segment(output * rows, rows), samples));
  }
  return noise;
}

double excess_of(double size) {
  return 1.0 - std::pow(policy::suspicious.value / std::max(size, policy::suspicious.value), 2);
}

Remainder remainder_of(const Model& model, const VectorXd& calibrated, const VectorXd& left,
                       const std::vector<double>& noise) {
  const Index rows = left.size() / std::ssize(noise);
  const auto in_noise = [&](const VectorXd& residuals) {
    double squares = 0.0;
    for (Index output = 0; output < std::ssize(noise); ++output) {
      squares +=
          residuals.segment(output * rows, rows).squaredNorm() / std::pow(noise[static_cast<std::size_t>(output)], 2);
    }
    return squares / static_cast<double>(left.size());
  };
  const double square = in_noise(left);
  const double gap = in_noise(calibrated) - 1.0;
  Remainder result{.size = std::sqrt(square), .open = gap > 0.0 ? std::clamp((square - 1.0) / gap, 0.0, 1.0) : 0.0};
  result.excess = excess_of(result.size);
  const Discrepancy foretold = largest_discrepancy(model, left, noise.size());
  constexpr double notable_share = 0.02;
  constexpr double notable_size = 0.25;  // of what is left, or of four units
  result.share = foretold.share;
  result.is_predictable =
      foretold.share_low > notable_share && foretold.rms > notable_size * std::min(result.size, 4.0);
  return result;
}

double unknown_score(const Remainder& left, double named) {
  const double open = std::pow(left.open, 0.25) * left.excess;
  const double in_doubt = (1.0 - named) * left.excess;
  return 1.0 - (1.0 - open) * (1.0 - in_doubt);
}

}  // namespace hysteron::diagnosis
