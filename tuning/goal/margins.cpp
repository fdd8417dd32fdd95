#include "tuning/goal/margins.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/numbers.hpp"

namespace hysteron {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using std::numbers::pi;

constexpr std::size_t grid_points = 400;
constexpr double degrees = 180.0 / pi;
const double decibels = 20.0 / std::log(10.0);  // of a natural logarithm

/// z⁻ᵏ for k = 0, 1, …, without the rounding of many products.
class Rotation {
 public:
  explicit Rotation(double angle) : angle_(angle), turn_(std::polar(1.0, -angle)) {}
  Complex next() {
    constexpr std::size_t often = 64;
    value_ = k_ % often == 0 ? std::polar(1.0, -angle_ * static_cast<double>(k_)) : value_ * turn_;
    ++k_;
    return value_;
  }

 private:
  double angle_;
  Complex turn_;
  Complex value_{};
  std::size_t k_ = 0;
};

/// The angle of L from −180°, in (−π, π].
double angle_from_critical(Complex open_loop) {
  return std::arg(-open_loop);
}

}  // namespace

Sensitivity::Sensitivity(const Signal& impulse, const Eigen::MatrixXd& impulse_by, double sample_time)
    : impulse_(impulse), impulse_by_(impulse_by), sample_time_(sample_time) {
  const double highest = pi / sample_time;
  const double lowest = std::min(0.1 * highest, 0.1 * pi / (sample_time * static_cast<double>(impulse.size())));
  for (std::size_t i = 0; i < grid_points; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(grid_points - 1);
    const double frequency = i + 1 == grid_points ? highest : lowest * std::pow(highest / lowest, share);
    grid_.push_back({.frequency = frequency, .sensitivity = at(frequency)});
  }
}

Complex Sensitivity::at(double frequency) const {
  Rotation rotation(frequency * sample_time_);
  Complex sum{};
  for (const double h : impulse_) {
    sum += h * rotation.next();
  }
  return sum;
}

Sensitivity::Local Sensitivity::local_at(double frequency) const {
  Local local{.by = Eigen::VectorXcd::Zero(impulse_by_.cols())};
  Rotation rotation(frequency * sample_time_);
  for (std::size_t k = 0; k < impulse_.size(); ++k) {
    const Complex turned = rotation.next();
    local.value += impulse_[k] * turned;
    local.slope += Complex(0.0, -sample_time_ * static_cast<double>(k)) * impulse_[k] * turned;
    for (Index j = 0; j < impulse_by_.cols(); ++j) {
      local.by[j] += impulse_by_(static_cast<Index>(k), j) * turned;
    }
  }
  return local;
}

Margin Sensitivity::log_size(double frequency) const {
  const Local local = local_at(frequency);
  return {.value = std::log(std::abs(local.value)), .frequency = frequency, .by = (local.by / local.value).real()};
}

template <class Function>
double Sensitivity::root_between(double low, double high, Function function) const {
  const auto sign_at = [&](double frequency) {
    const Complex s = at(frequency);
    return function((1.0 - s) / s) > 0.0;
  };
  const bool at_low = sign_at(low);
  for (int k = 0; k < 60 && high - low > 1e-13 * high; ++k) {
    const double middle = 0.5 * (low + high);
    (sign_at(middle) == at_low ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// With ln L = ln(1 − S) − ln S, d ln L = −dS/(S·(1 − S)). Along |L| = 1 the frequency moves so that Re d ln L stays 0.
Margin Sensitivity::phase_at(double frequency) const {
  const Local local = local_at(frequency);
  const Complex open_loop = (1.0 - local.value) / local.value;
  const Complex factor = -1.0 / (local.value * (1.0 - local.value));
  const Complex along = factor * local.slope;
  const double angle = angle_from_critical(open_loop);
  Margin margin{.value = std::fabs(angle) * degrees, .frequency = frequency, .by = Eigen::VectorXd(local.by.size())};
  for (Index j = 0; j < local.by.size(); ++j) {
    const Complex direct = factor * local.by[j];
    const double moved = -direct.real() / along.real();
    margin.by[j] = std::copysign(degrees, angle) * (direct.imag() + along.imag() * moved);
  }
  return margin;
}

/// Along arg L = −180° the frequency moves so that Im d ln L stays 0; at the Nyquist frequency it stands.
Margin Sensitivity::gain_at(double frequency) const {
  const Local local = local_at(frequency);
  const double size = std::log(std::abs((1.0 - local.value) / local.value));
  const Complex factor = -1.0 / (local.value * (1.0 - local.value));
  const Complex along = factor * local.slope;
  const bool stands = frequency >= grid_.back().frequency;
  Margin margin{.value = std::fabs(size) * decibels, .frequency = frequency, .by = Eigen::VectorXd(local.by.size())};
  for (Index j = 0; j < local.by.size(); ++j) {
    const Complex direct = factor * local.by[j];
    const double moved = stands ? 0.0 : -direct.imag() / along.imag();
    margin.by[j] = std::copysign(decibels, size) * (direct.real() + along.real() * moved);
  }
  return margin;
}

double Sensitivity::peak_near(std::size_t point) const {
  double low = grid_[point - (point > 0 ? 1 : 0)].frequency;
  double high = grid_[std::min(point + 1, grid_.size() - 1)].frequency;
  constexpr double golden = 0.6180339887498949;
  for (int k = 0; k < 40; ++k) {
    const double left = high - golden * (high - low);
    const double right = low + golden * (high - low);
    const bool is_left = std::abs(at(left)) > std::abs(at(right));
    (is_left ? high : low) = is_left ? right : left;
  }
  const double inside = 0.5 * (low + high);
  return std::abs(at(inside)) >= std::abs(grid_[point].sensitivity) ? inside : grid_[point].frequency;
}

std::vector<double> Sensitivity::peaks_above(double level) const {
  std::vector<std::pair<double, double>> found;  // |S|, frequency
  for (std::size_t i = 0; i < grid_.size(); ++i) {
    const double here = std::abs(grid_[i].sensitivity);
    const bool is_peak = (i == 0 || here >= std::abs(grid_[i - 1].sensitivity)) &&
                         (i + 1 == grid_.size() || here > std::abs(grid_[i + 1].sensitivity));
    if (is_peak && here > level) {
      const double frequency = peak_near(i);
      found.emplace_back(std::abs(at(frequency)), frequency);
    }
  }
  std::ranges::sort(found, std::greater{});
  std::vector<double> frequencies;
  std::ranges::transform(found, std::back_inserter(frequencies), [](const auto& one) { return one.second; });
  return frequencies;
}

LoopMargins Sensitivity::margins() const {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(impulse_by_.cols());
  LoopMargins result{.gain = {infinity, 0.0, none}, .phase = {infinity, 0.0, none}};
  const auto smaller = [](Margin& so_far, Margin next) {
    if (next.value < so_far.value) {
      so_far = std::move(next);
    }
  };
  for (std::size_t i = 0; i + 1 < grid_.size(); ++i) {
    const Complex here = grid_[i].open_loop();
    const Complex next = grid_[i + 1].open_loop();
    const auto excess = [](Complex open_loop) { return std::abs(open_loop) - 1.0; };
    if ((excess(here) > 0.0) != (excess(next) > 0.0)) {
      const double frequency = root_between(grid_[i].frequency, grid_[i + 1].frequency, excess);
      smaller(result.phase, phase_at(frequency));
      result.crossover = frequency;
    }
    // Only where L passes −180°, and not +0°: there the angle jumps by a whole turn.
    const double a = angle_from_critical(here);
    const double b = angle_from_critical(next);
    if ((a > 0.0) != (b > 0.0) && std::fabs(a - b) < pi && i + 2 < grid_.size()) {
      smaller(result.gain, gain_at(root_between(grid_[i].frequency, grid_[i + 1].frequency, angle_from_critical)));
    }
  }
  if (grid_.back().open_loop().real() < 0.0) {  // L is real at the Nyquist frequency
    smaller(result.gain, gain_at(grid_.back().frequency));
  }
  const std::vector<double> peaks = peaks_above(0.0);
  const double frequency = peaks.empty() ? grid_.back().frequency : peaks.front();
  const Margin size = log_size(frequency);
  const double largest = std::exp(size.value);
  result.sensitivity = {.value = largest, .frequency = frequency, .by = largest * size.by};
  return result;
}

}  // namespace hysteron
