// Points of a static map, M(p) = 0.05 + 1.3·p^1.7 with noise of 1 % of its range: what both fits are given.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "tuning/static_map.hpp"

namespace hysteron::bench {

struct StaticMapData {
  std::vector<double> p;
  std::vector<double> M;
};

/// The same numbers on every machine: the noise is a sum of twelve uniform numbers, not a library's normal
/// distribution.
inline StaticMapData static_map_data(std::size_t points) {
  const StaticMap truth{.C1 = 0.05, .C2 = 1.3, .C3 = 1.7};
  std::mt19937_64 engine(1);
  StaticMapData data{.p = std::vector<double>(points), .M = std::vector<double>(points)};
  for (std::size_t i = 0; i < points; ++i) {
    double noise = -6.0;
    for (int k = 0; k < 12; ++k) {
      noise += static_cast<double>(engine() >> 11U) * 0x1p-53;
    }
    data.p[i] = static_cast<double>(i + 1) / static_cast<double>(points);
    data.M[i] = truth(data.p[i]) + 0.013 * noise;
  }
  return data;
}

}  // namespace hysteron::bench
