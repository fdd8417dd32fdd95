#include "diagnosis/noise/discrepancy.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "diagnosis/model/filters.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr Index blocks = 20;

/// The features of one record, appended as columns of equal length.
class Features {
 public:
  explicit Features(std::size_t steps) : steps_(steps) {}

  void add_signal(const Signal& raw) {
    Signal x = normalised(raw);
    if (x.empty()) {
      return;
    }
    Signal rate(steps_, 0.0);
    for (std::size_t k = 1; k < steps_; ++k) {
      rate[k] = x[k] - x[k - 1];
    }
    const Signal smooth_rate = normalised(lagged(rate, 4.0));
    Signal direction(steps_, 0.0);
    for (std::size_t k = 0; k < steps_; ++k) {
      direction[k] = smooth_rate.empty() ? 0.0 : std::tanh(5.0 * smooth_rate[k]);
    }
    add(x, [](double v) { return v; });
    add(x, [](double v) { return v * v; });
    add(x, [](double v) { return v * v * v; });
    add(x, [](double v) { return std::abs(v); });
    if (!smooth_rate.empty()) {
      add(smooth_rate, [](double v) { return v; });
      add(smooth_rate, [](double v) { return std::abs(v); });
      add(smooth_rate, [](double v) { return std::log1p(std::abs(v)); });
      columns_.push_back(direction);
      add_product(direction, x);
      add_product(direction, smooth_rate);
    }
    for (double time = 2.0; time < 0.25 * static_cast<double>(steps_); time *= 5.0) {
      const Signal slow = lagged(x, time);
      columns_.push_back(slow);
      Signal square(steps_);
      std::ranges::transform(slow, square.begin(), [](double v) { return v * v; });
      columns_.push_back(square);
    }
    for (const double width : {0.1, 0.3, 0.8, 1.6}) {
      columns_.push_back(play(x, width));
    }
  }

  [[nodiscard]] const std::vector<Signal>& columns() const { return columns_; }

 private:
  /// Mean 0 and standard deviation 1; nothing where it does not move.
  [[nodiscard]] Signal normalised(const Signal& raw) const {
    if (raw.size() != steps_) {
      return {};
    }
    double mean = 0.0;
    for (const double v : raw) {
      mean += v / static_cast<double>(steps_);
    }
    double variance = 0.0;
    for (const double v : raw) {
      variance += (v - mean) * (v - mean) / static_cast<double>(steps_);
    }
    if (!(variance > 0.0)) {
      return {};
    }
    Signal result(steps_);
    std::ranges::transform(raw, result.begin(), [&](double v) { return (v - mean) / std::sqrt(variance); });
    return result;
  }
  template <class Function>
  void add(const Signal& x, const Function& function) {
    Signal column(steps_);
    std::ranges::transform(x, column.begin(), function);
    columns_.push_back(std::move(column));
  }
  void add_product(const Signal& a, const Signal& b) {
    Signal column(steps_);
    std::ranges::transform(a, b, column.begin(), [](double v, double w) { return v * w; });
    columns_.push_back(std::move(column));
  }

  std::size_t steps_;
  std::vector<Signal> columns_{};
};

}  // namespace

Discrepancy discrepancy(const std::vector<Experiment>& experiments, const VectorXd& residuals) {
  std::vector<std::vector<Signal>> columns;
  std::size_t count = 0;
  for (const Experiment& experiment : experiments) {
    Features features(experiment.drive.steps);
    for (const Signal& input : experiment.drive.inputs) {
      features.add_signal(input);
    }
    for (const Signal& output : experiment.measured) {
      features.add_signal(output);
    }
    count = columns.empty() ? features.columns().size() : std::min(count, features.columns().size());
    columns.push_back(features.columns());
  }
  const Index rows = residuals.size();
  if (count == 0 || rows < 200) {
    return {};
  }
  const Index stride = std::max<Index>(1, rows / 6000);
  const Index used = rows / stride;
  MatrixXd matrix(used, static_cast<Index>(count) + 1);
  VectorXd target(used);
  std::vector<std::pair<std::size_t, std::size_t>> steps;
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    for (std::size_t k = 0; k < experiments[e].drive.steps; ++k) {
      steps.emplace_back(e, k);
    }
  }
  for (Index i = 0; i < used; ++i) {
    const auto [e, k] = steps[static_cast<std::size_t>(i * stride)];
    for (std::size_t j = 0; j < count; ++j) {
      matrix(i, static_cast<Index>(j)) = columns[e][j][k];
    }
    matrix(i, static_cast<Index>(count)) = 1.0;
    target[i] = residuals[i * stride];
  }
  const MatrixXd whole = matrix.transpose() * matrix;
  const VectorXd product = matrix.transpose() * target;
  std::vector<double> gains;
  double squares = 0.0;
  double left = 0.0;
  for (Index block = 0; block < blocks; ++block) {
    const Index first = block * used / blocks;
    const Index last = (block + 1) * used / blocks;
    const auto rows_out = matrix.middleRows(first, last - first);
    const auto target_out = target.segment(first, last - first);
    MatrixXd normal = whole - rows_out.transpose() * rows_out;
    normal.diagonal().array() += 1e-3 * normal.diagonal().mean();
    const VectorXd weights = normal.ldlt().solve(product - rows_out.transpose() * target_out);
    const double before = target_out.squaredNorm();
    const double after = (target_out - rows_out * weights).squaredNorm();
    squares += before;
    left += after;
    gains.push_back(before - after);
  }
  Discrepancy result;
  if (!(squares > 0.0)) {
    return result;
  }
  double mean = 0.0;
  for (const double gain : gains) {
    mean += gain / static_cast<double>(blocks);
  }
  double variance = 0.0;
  for (const double gain : gains) {
    variance += (gain - mean) * (gain - mean) / static_cast<double>(blocks - 1);
  }
  result.share = std::max(0.0, 1.0 - left / squares);
  const double bound = static_cast<double>(blocks) * (mean - 1.73 * std::sqrt(variance / static_cast<double>(blocks)));
  result.share_low = std::clamp(bound / squares, 0.0, 1.0);
  result.rms = std::sqrt(result.share * squares / static_cast<double>(used));
  return result;
}

}  // namespace hysteron::diagnosis
