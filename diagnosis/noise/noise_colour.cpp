#include "diagnosis/noise/noise_colour.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A longer stretch has more frequencies, a shorter one more of its like.
constexpr Index longest_stretch = 256;
constexpr Index fewest_stretches = 8;  // that do not overlap
constexpr Index shortest_stretch = 32;
/// From so many cycles a sample on.
constexpr double fast = 0.1;
/// Nats that a colour has to gain: it has two numbers more than white.
constexpr double of_colour = 3.0;
/// Of independent stretches so many are worth one: they overlap by half, under a window, and have a median.
constexpr double worth = 0.2;

/// The power of each frequency in stretches of so many samples, straight lines taken off, under a Hann window.
class Stretches {
 public:
  explicit Stretches(Index length) : window_(length), powers_(static_cast<std::size_t>(length / 2)) {
    for (Index k = 0; k < length; ++k) {
      window_[k] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(length));
    }
  }

  void add(const VectorXd& record) {
    const Index length = window_.size();
    const VectorXd line = VectorXd::LinSpaced(length, -1.0, 1.0);
    for (Index first = 0; first + length <= record.size(); first += length / 2) {
      VectorXd stretch = record.segment(first, length);
      stretch.array() -= stretch.mean();
      stretch -= line * (line.dot(stretch) / line.squaredNorm());
      stretch.array() *= window_.array();
      std::vector<std::complex<double>> transform;
      fft_.fwd(transform, std::vector<double>(stretch.begin(), stretch.end()));
      for (std::size_t k = 0; k < powers_.size(); ++k) {
        powers_[k].push_back(std::norm(transform[k]) / window_.squaredNorm());
      }
      ++count_;
    }
  }

  /// Of white noise the variance, at each frequency from `fast` to below a half.
  [[nodiscard]] VectorXd fast_part() const {
    VectorXd result(std::ssize(powers_) - first());
    for (Index k = 0; k < result.size(); ++k) {
      // Of an exponential distribution, whose median is the mean times ln 2.
      result[k] = median(powers_[static_cast<std::size_t>(first() + k)]) / std::numbers::ln2;
    }
    return result;
  }
  /// In radians a sample.
  [[nodiscard]] double frequency(Index k) const {
    return 2.0 * std::numbers::pi * static_cast<double>(first() + k) / static_cast<double>(window_.size());
  }
  [[nodiscard]] double count() const { return count_; }

 private:
  [[nodiscard]] Index first() const {
    return static_cast<Index>(std::ceil(fast * static_cast<double>(window_.size())));
  }

  VectorXd window_;
  std::vector<std::vector<double>> powers_;  ///< by frequency, of each stretch
  double count_ = 0.0;
  Eigen::FFT<double> fft_{};
};

/// The variance of the likeliest noise.
double likeliest_variance(const Stretches& stretches) {
  const VectorXd power = stretches.fast_part();
  double best = -std::numeric_limits<double>::infinity();
  double variance = 0.0;
  for (int twentieth = 0; twentieth <= 18; ++twentieth) {
    const double pole = 0.05 * twentieth;
    for (double share = 1.0; share > 0.1; share -= 0.2) {
      VectorXd shape(power.size());
      for (Index k = 0; k < power.size(); ++k) {
        const double gain = std::norm(1.0 - std::polar(pole, -stretches.frequency(k)));
        shape[k] = 1.0 - share + share * (1.0 - pole * pole) / gain;
      }
      const double here = power.cwiseQuotient(shape).mean();
      const double likelihood =
          -worth * stretches.count() * (shape.array().log() + std::log(here)).sum() - (twentieth > 0 ? of_colour : 0.0);
      if (likelihood > best) {
        best = likelihood;
        variance = here;
      }
      if (twentieth == 0) {
        break;  // white, whatever its share
      }
    }
  }
  return variance;
}

}  // namespace

double noise_by_fast_part(const VectorXd& residuals, const std::vector<std::size_t>& samples) {
  const auto shortest = std::ranges::min_element(samples);
  if (shortest == samples.end()) {
    return 0.0;
  }
  const Index length = std::min(longest_stretch, static_cast<Index>(*shortest) / fewest_stretches / 2 * 2);
  if (length < shortest_stretch || !residuals.allFinite()) {
    return 0.0;
  }
  Stretches stretches(length);
  Index first = 0;
  for (const std::size_t count : samples) {
    stretches.add(residuals.segment(first, static_cast<Index>(count)));
    first += static_cast<Index>(count);
  }
  return std::sqrt(likeliest_variance(stretches));
}

}  // namespace hysteron::diagnosis
