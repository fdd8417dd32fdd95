// The points of a static map, M(p) = c1 + c2·p^c3, and the straight line through them, where every fit starts.
#pragma once

#include <array>

#include "bench/rivals/repeated.hpp"

constexpr std::size_t static_map_sizes[] = {200, 10'000, 1'000'000};

inline TwoRows static_map_points(const std::string& folder, std::size_t points) {
  return read_rows(folder + "/static_map_" + std::to_string(points) + ".bin", points);
}

inline std::array<double, 3> straight_line(const TwoRows& points) {
  const auto count = static_cast<double>(points.first.size());
  double p = 0.0, m = 0.0, pp = 0.0, pm = 0.0;
  for (std::size_t i = 0; i < points.first.size(); ++i) {
    p += points.first[i];
    m += points.second[i];
    pp += points.first[i] * points.first[i];
    pm += points.first[i] * points.second[i];
  }
  const double slope = (count * pm - p * m) / (count * pp - p * p);
  return {(m - slope * p) / count, slope, 1.0};
}
