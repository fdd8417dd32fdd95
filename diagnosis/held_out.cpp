#include "diagnosis/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace hysteron::diagnosis {
namespace {

constexpr Index blocks = 24;

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

void take(const Task& task, const VectorXd& residuals, Index parity, std::vector<HeldOut>& result) {
  const Index rows = rows_of_output(task);
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    for (Index k = 0; k < rows; ++k) {
      const Index block = block_of(k, rows);
      if (parity >= 0 && block % 2 != parity) {
        continue;
      }
      const double r = residuals[static_cast<Index>(output) * rows + k];
      result[output].squares[static_cast<std::size_t>(block)] += r * r;
      result[output].counts[static_cast<std::size_t>(block)] += 1.0;
    }
  }
}

std::vector<HeldOut> empty(const Task& task) {
  const auto count = static_cast<std::size_t>(blocks);
  return std::vector<HeldOut>(task.outputs.size(),
                              {.squares = std::vector<double>(count, 0.0), .counts = std::vector<double>(count, 0.0)});
}

double mean_square(const HeldOut& one) {
  const double count = std::accumulate(one.counts.begin(), one.counts.end(), 0.0);
  return count > 0.0 ? std::accumulate(one.squares.begin(), one.squares.end(), 0.0) / count : 0.0;
}

}  // namespace

std::vector<HeldOut> held_out(const Task& task, const Explanation& explanation) {
  std::vector<HeldOut> result = empty(task);
  const Index rows = rows_of_output(task);
  Model model(task, *explanation.variant.program, explanation.variant.further);
  for (Index parity = 0; parity < 2; ++parity) {
    VectorXd weights(model.rows());
    for (Index row = 0; row < model.rows(); ++row) {
      weights[row] = block_of(row % rows, rows) % 2 == parity ? 0.0 : 1.0;
    }
    const Fit trained = fit(model, explanation.fit.x, {.iterations = 6, .weights = &weights});
    take(task, std::isfinite(trained.cost) ? trained.residuals : explanation.fit.residuals, parity, result);
  }
  return result;
}

std::vector<HeldOut> by_blocks(const Task& task, const VectorXd& residuals) {
  std::vector<HeldOut> result = empty(task);
  take(task, residuals, -1, result);
  return result;
}

Closure closure(const HeldOut& before, const HeldOut& after, double floor, std::uint64_t seed) {
  const double noise = floor * floor;
  const auto share = [&](double first, double second) {
    const double gap = first - noise;
    return gap > 0.0 ? std::clamp(1.0 - (second - noise) / gap, -1.0, 1.0) : 0.0;
  };
  Closure result{.closed = share(mean_square(before), mean_square(after))};
  constexpr int draws = 600;
  std::mt19937_64 random(seed);
  std::vector<double> shares;
  const std::size_t count = before.squares.size();
  for (int draw = 0; draw < draws; ++draw) {
    HeldOut first{.squares = {0.0}, .counts = {0.0}};
    HeldOut second = first;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t block = static_cast<std::size_t>(random() % count);
      first.squares[0] += before.squares[block];
      first.counts[0] += before.counts[block];
      second.squares[0] += after.squares[block];
      second.counts[0] += after.counts[block];
    }
    shares.push_back(share(mean_square(first), mean_square(second)));
  }
  std::ranges::sort(shares);
  result.low = std::min(result.closed, shares[static_cast<std::size_t>(0.025 * draws)]);
  result.high = std::max(result.closed, shares[static_cast<std::size_t>(0.975 * draws)]);
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

}  // namespace hysteron::diagnosis
