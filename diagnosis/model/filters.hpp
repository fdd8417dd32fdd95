// Simple memories of a signal, for regressions that look for one.
#pragma once

#include <algorithm>
#include <cstddef>

#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {

/// A first-order lag: y(k) = y(k−1) + (x(k) − y(k−1)) / samples, from y(−1) = x(0). `samples` is at least 1.
[[nodiscard]] inline Signal lagged(const Signal& x, double samples) {
  Signal result(x.size());
  double state = x.empty() ? 0.0 : x.front();
  for (std::size_t k = 0; k < x.size(); ++k) {
    state += (x[k] - state) / samples;
    result[k] = state;
  }
  return result;
}

/// Play: y follows x at a distance of at most `width`, from y(−1) = x(0).
[[nodiscard]] inline Signal play(const Signal& x, double width) {
  Signal result(x.size());
  double state = x.empty() ? 0.0 : x.front();
  for (std::size_t k = 0; k < x.size(); ++k) {
    state = std::clamp(state, x[k] - width, x[k] + width);
    result[k] = state;
  }
  return result;
}

}  // namespace hysteron::diagnosis
