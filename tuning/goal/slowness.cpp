#include "tuning/goal/slowness.hpp"

#include <algorithm>
#include <cmath>

namespace hysteron {
namespace {

using Eigen::Index;

/// As a share: what an envelope of two peaks may be off.
constexpr double reserve = 0.005;
/// Of the largest |h|: below this, rounding makes the peaks.
constexpr double of_rounding = 1e-9;

}  // namespace

Margin slowness(const LoopResponse& response, std::size_t watched) {
  const Signal& h = response.impulse;
  const auto size = [](double value) { return std::fabs(value); };
  const auto quarter = std::ssize(h) / 4;
  Margin far{.value = -1.0, .by = Eigen::VectorXd::Zero(response.impulse_by.cols())};
  if (h.size() < watched / 8 || quarter == 0) {
    return far;
  }
  const auto peak = [&](std::ptrdiff_t from) {
    return std::ranges::max_element(h.begin() + from, h.begin() + from + quarter, {}, size) - h.begin();
  };
  const auto first = peak(quarter);
  const auto second = peak(2 * quarter);
  const double largest = std::fabs(*std::ranges::max_element(h, {}, size));
  const double early = std::fabs(h[static_cast<std::size_t>(first)]);
  const double late = std::fabs(h[static_cast<std::size_t>(second)]);
  if (!(late > of_rounding * largest)) {
    return far;
  }
  const double ahead =
      (0.75 * static_cast<double>(watched) - static_cast<double>(second)) / static_cast<double>(second - first);
  const double at_end = std::log(late) - ahead * (std::log(early) - std::log(late));
  const double unit = -std::log(died_away);
  const double excess = (at_end - std::log(died_away * largest)) / unit + reserve;
  if (excess < -1.0) {
    return far;
  }
  Margin result{.value = excess};
  if (response.impulse_by.cols() > 0) {
    const auto log_slope = [&](std::ptrdiff_t k) -> Eigen::VectorXd {
      return response.impulse_by.row(static_cast<Index>(k)).transpose() / h[static_cast<std::size_t>(k)];
    };
    result.by = ((1.0 + ahead) * log_slope(second) - ahead * log_slope(first)) / unit;
  }
  return result;
}

}  // namespace hysteron
