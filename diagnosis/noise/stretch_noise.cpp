#include "diagnosis/noise/stretch_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>

#include "diagnosis/noise/spectrum.hpp"
#include "support/median.hpp"
#include "tuning/covariance.hpp"

namespace hysteron::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A stretch without its trend, and the orthonormal columns that the trend was made of. A Projection would leave 1e-9
/// of it, and an output may lie so many times its noise away from 0.
struct Detrended {
  records::RowRange rows{};
  VectorXd left{};
  MatrixXd trend{};

  [[nodiscard]] MatrixXd without_trend(const MatrixXd& columns) const {
    return columns - trend * (trend.transpose() * columns);
  }
};

MatrixXd trend_of(Index count, int order) {
  MatrixXd powers(count, order + 1);
  for (Index k = 0; k < count; ++k) {
    const double t = 2.0 * static_cast<double>(k) / static_cast<double>(count - 1) - 1.0;
    double power = 1.0;
    for (int j = 0; j <= order; ++j, power *= t) {
      powers(k, j) = power;
    }
  }
  return powers.householderQr().householderQ() * MatrixXd::Identity(count, order + 1);
}

/// A sine and a cosine that run on through the gaps between the stretches.
struct Line {
  double frequency = 0.0;          ///< cycles a sample
  double gain = 0.0;               ///< squares that it takes off
  std::vector<VectorXd> values{};  ///< by stretch
};

Line line_at(const std::vector<Detrended>& stretches, double frequency) {
  Line line{.frequency = frequency};
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  std::vector<MatrixXd> waves;
  for (const Detrended& one : stretches) {
    MatrixXd here(one.left.size(), 2);
    for (Index k = 0; k < one.left.size(); ++k) {
      const double phase =
          2.0 * std::numbers::pi * frequency * (static_cast<double>(one.rows.first) + static_cast<double>(k));
      here(k, 0) = std::sin(phase);
      here(k, 1) = std::cos(phase);
    }
    waves.push_back(one.without_trend(here));
    normal += waves.back().transpose() * waves.back();
    right += waves.back().transpose() * one.left;
  }
  const Eigen::Vector2d sizes = normal.completeOrthogonalDecomposition().solve(right);
  line.gain = sizes.dot(right);
  for (const MatrixXd& here : waves) {
    line.values.emplace_back(here * sizes);
  }
  return line;
}

double squares(const std::vector<Detrended>& stretches) {
  return std::accumulate(stretches.begin(), stretches.end(), 0.0,
                         [](double sum, const Detrended& one) { return sum + one.left.squaredNorm(); });
}

/// What noise gives a frequency, by those about it.
double gain_about(const std::vector<Detrended>& stretches, double frequency, std::size_t length) {
  std::vector<double> gains;
  for (int bin = 1; bin <= 6; ++bin) {
    for (const double side : {-1.0, 1.0}) {
      const double other = frequency + side * (bin + 0.5) / static_cast<double>(length);
      if (other > 0.0 && other < 0.5) {
        gains.push_back(line_at(stretches, other).gain);
      }
    }
  }
  return median(std::move(gains)) / std::numbers::ln2;  // of an exponential distribution, its mean
}

/// Whether a line was a good part of what is left, stood out from the frequencies about it, and so was taken off.
bool take_off_line(std::vector<Detrended>& stretches, std::size_t length) {
  constexpr double least = 0.2;
  constexpr double above = 15.0;  // of thousands of frequencies, chance makes one 8 times as high as the mean
  constexpr std::size_t candidates = 12;
  constexpr std::size_t refined = 3;
  constexpr int finer = 10;  // steps to either side of a peak of the spectrum
  VectorXd gated = VectorXd::Zero(static_cast<Index>(length));
  for (const Detrended& one : stretches) {
    gated.segment(static_cast<Index>(one.rows.first), one.left.size()) = one.left;
  }
  // The gaps between the stretches give each line neighbours that are nearly as high: all of them are tried.
  std::vector<std::pair<double, double>> peaks;  // gain, frequency
  for (const double frequency : Periodogram(gated, 1.0).strongest_lines(candidates)) {
    peaks.emplace_back(line_at(stretches, frequency).gain, frequency);
  }
  std::ranges::sort(peaks, std::greater{});
  peaks.resize(std::min(peaks.size(), refined));
  Line best;
  for (const auto& [gain, frequency] : peaks) {
    for (int step = -finer; step <= finer; ++step) {
      Line here = line_at(stretches, frequency + 0.5 * step / (finer * static_cast<double>(length)));
      if (here.gain > best.gain) {
        best = std::move(here);
      }
    }
  }
  if (best.values.empty() || best.gain < least * squares(stretches)) {
    return false;
  }
  std::vector<Detrended> without = stretches;
  for (std::size_t i = 0; i < without.size(); ++i) {
    without[i].left -= best.values[i];
  }
  if (best.gain < above * gain_about(without, best.frequency, length)) {
    return false;
  }
  stretches = std::move(without);
  return true;
}

}  // namespace

std::vector<StretchNoise> noise_of_stretches(const std::vector<double>& values,
                                             const std::vector<records::RowRange>& stretches, int order) {
  constexpr int most_lines = 6;  // a limit cycle has harmonics
  constexpr double far = 6.0;
  std::vector<Detrended> list;
  for (const records::RowRange& rows : stretches) {
    const auto count = static_cast<Index>(rows.size());
    if (count < order + 3) {
      continue;
    }
    Detrended one{.rows = rows, .trend = trend_of(count, order)};
    one.left = one.without_trend(Eigen::Map<const VectorXd>(values.data() + rows.first, count));
    list.push_back(std::move(one));
  }
  for (int line = 0; line < most_lines && !list.empty() && take_off_line(list, values.size()); ++line) {
  }
  std::vector<StretchNoise> result;
  for (Detrended& one : list) {
    const VectorXd sizes = one.left.cwiseAbs();
    const double bound = far * deviation_of_median * median({sizes.data(), sizes.data() + sizes.size()});
    if (bound > 0.0) {  // a glitch is no noise
      one.left = one.left.cwiseMax(-bound).cwiseMin(bound);
    }
    // A trend takes of slow noise as many samples as of fast noise, of fewer that it has.
    const auto samples = static_cast<double>(one.left.size());
    const double worth = samples / std::min(correlation_time(one.left), samples / (3.0 * (order + 1)));
    result.push_back({.variance = one.left.squaredNorm() / (samples * (1.0 - (order + 1) / worth)),
                      .samples = one.rows.size(),
                      .worth = worth});
  }
  return result;
}

double lower_deviation(std::vector<StretchNoise> stretches, std::size_t fewest) {
  constexpr double share = 0.3;
  constexpr double deviations = 0.524;    // of a normal distribution, from its mean down to that share
  constexpr std::size_t distributed = 4;  // fewer stretches have no quantile
  const std::size_t total = std::accumulate(stretches.begin(), stretches.end(), std::size_t{0},
                                            [](std::size_t sum, const StretchNoise& one) { return sum + one.samples; });
  if (total < fewest) {
    return 0.0;
  }
  std::ranges::stable_sort(stretches, {}, &StretchNoise::variance);
  std::size_t below = 0;
  for (const StretchNoise& one : stretches) {
    below += one.samples;
    if (static_cast<double>(below) >= share * static_cast<double>(total)) {
      // The variance of n normal samples scatters by √(2/n) of itself.
      const double chance = stretches.size() < distributed ? 0.0 : deviations * std::sqrt(2.0 / one.worth);
      return std::sqrt(one.variance / (1.0 - std::min(chance, 0.5)));
    }
  }
  return 0.0;
}

}  // namespace hysteron::diagnosis
