#include "diagnosis/verdict/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>

#include "tuning/covariance.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr Index blocks = 24;
/// Where the floor may be higher than what is left: more would be no share.
constexpr double most_closed = 1.05;

Index rows_of_output(const Task& task) {
  Index rows = 0;
  for (const records::Record& record : task.records) {
    rows += std::ssize(record.time());
  }
  return rows;
}

Index block_of(Index row, Index rows) {
  return std::min(blocks - 1, row * blocks / rows);
}

double mean_square(const HeldOut& one) {
  const double count = std::accumulate(one.counts.begin(), one.counts.end(), 0.0);
  return count > 0.0 ? std::accumulate(one.squares.begin(), one.squares.end(), 0.0) / count : 0.0;
}

/// A noise whose ratio to the likely one is log-normal to each side, with 2.5 % of the draws at either end of its
/// range: no noise is larger than what is left.
double drawn(const NoiseRange& noise, std::mt19937_64& random) {
  constexpr double deviations = 1.96;
  const auto uniform = [&] { return (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53; };
  const double size = std::sqrt(-2.0 * std::log(uniform()));
  const double normal = size * std::cos(2.0 * std::numbers::pi * uniform());
  const double bound = normal < 0.0 ? noise.low : noise.high;
  if (!(noise.likely > 0.0)) {
    return bound;  // of residuals that are 0
  }
  const double ratio = std::pow(bound / noise.likely, std::abs(normal) / deviations);
  return std::clamp(noise.likely * ratio, noise.low, noise.high);
}

}  // namespace

VectorXd held_out(const Task& task, const Explanation& explanation) {
  const Index rows = rows_of_output(task);
  Model model(task, *explanation.variant.program, explanation.variant.further);
  VectorXd unseen = explanation.fit.residuals;
  for (Index parity = 0; parity < 2; ++parity) {
    VectorXd weights(model.rows());
    for (Index row = 0; row < model.rows(); ++row) {
      weights[row] = block_of(row % rows, rows) % 2 == parity ? 0.0 : 1.0;
    }
    const Fit trained = fit(model, explanation.fit.x, {.iterations = 6, .weights = &weights});
    if (std::isfinite(trained.cost)) {
      unseen = weights.array().select(unseen, trained.residuals);
    }
  }
  return unseen;
}

std::vector<HeldOut> by_blocks(const Task& task, const VectorXd& residuals) {
  const Index rows = rows_of_output(task);
  const auto count = static_cast<std::size_t>(blocks);
  std::vector<HeldOut> result(task.outputs.size(),
                              {.squares = std::vector<double>(count, 0.0), .counts = std::vector<double>(count, 0.0)});
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    for (Index k = 0; k < rows; ++k) {
      const auto block = static_cast<std::size_t>(block_of(k, rows));
      const double r = residuals[static_cast<Index>(output) * rows + k];
      result[output].squares[block] += r * r;
      result[output].counts[block] += 1.0;
    }
  }
  return result;
}

Closure closure(const HeldOut& before, const HeldOut& after, double fitted, const NoiseRange& noise,
                std::uint64_t seed) {
  const auto share = [](double first, double second, double deviation) {
    const double variance = deviation * deviation;
    const double gap = first - variance;
    return gap > 0.0 ? std::clamp(1.0 - (second - variance) / gap, -1.0, most_closed) : 0.0;
  };
  Closure result{.closed = std::min(1.0, share(mean_square(before), mean_square(after), noise.floor))};
  constexpr int draws = 2000;
  std::mt19937_64 random(seed);
  std::vector<double> shares;
  const std::size_t count = before.squares.size();
  for (int draw = 0; draw < draws; ++draw) {
    HeldOut first{.squares = {0.0}, .counts = {0.0}};
    HeldOut second = first;
    for (std::size_t k = 0; k < count; ++k) {
      const auto block = static_cast<std::size_t>(random() % count);
      first.squares[0] += before.squares[block];
      first.counts[0] += before.counts[block];
      second.squares[0] += after.squares[block];
      second.counts[0] += after.counts[block];
    }
    shares.push_back(share(mean_square(first), mean_square(second), drawn(noise, random)));
  }
  std::ranges::sort(shares);
  result.low = std::min(result.closed, shares[static_cast<std::size_t>(0.025 * draws)]);
  result.high = std::max(
      {result.closed, shares[static_cast<std::size_t>(0.975 * draws)], share(mean_square(before), fitted, noise.high)});
  return result;
}

double gain_bound(const HeldOut& before, const HeldOut& after) {
  std::vector<double> gains;
  double size = 0.0;
  for (std::size_t k = 0; k < before.squares.size(); ++k) {
    if (before.counts[k] > 0.0) {
      gains.push_back((before.squares[k] - after.squares[k]) / before.counts[k]);
      size += before.squares[k] / before.counts[k];
    }
  }
  const auto count = static_cast<double>(gains.size());
  if (gains.size() < 4 || !(size > 0.0)) {
    return 0.0;
  }
  const double mean = std::accumulate(gains.begin(), gains.end(), 0.0) / count;
  double variance = 0.0;
  for (const double gain : gains) {
    variance += (gain - mean) * (gain - mean) / (count - 1.0);
  }
  return (mean - 1.71 * std::sqrt(variance / count)) * count / size;
}

double gain_score(const VectorXd& before, const VectorXd& after) {
  const double gain = before.squaredNorm() - after.squaredNorm();
  const double deviation = after.norm() / std::sqrt(static_cast<double>(std::max<Index>(1, after.size())));
  const double chance = 2.0 * deviation * std::sqrt(std::max(1.0, correlation_time(after))) * (before - after).norm();
  return chance > 0.0 ? gain / chance : (gain > 0.0 ? std::numeric_limits<double>::infinity() : 0.0);
}

}  // namespace hysteron::diagnosis
