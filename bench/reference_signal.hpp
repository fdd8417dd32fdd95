// A reference with many branching points: what the steps are run over.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace hysteron::bench {

/// Two sines of incommensurate periods, in micrometres.
inline std::vector<double> reference_signal(std::size_t samples) {
  std::vector<double> signal(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const auto t = static_cast<double>(k);
    signal[k] = 2.0 * std::sin(0.003 * t) + 0.7 * std::sin(0.0173 * t);
  }
  return signal;
}

}  // namespace hysteron::bench
