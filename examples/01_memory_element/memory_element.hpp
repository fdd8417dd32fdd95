// Example 1 of the paper: a hysteresis loop, its branches, and the MEM element that is hidden between its rates.
#pragma once

#include <vector>

#include "examples/example.hpp"
#include "tuning/static_map.hpp"

namespace hysteron::examples {

/// The material constants of (2) and (3), as Example 1 prints them.
struct Material {
  double y_star = 1.225e-6;  ///< m
  double u_star = 500.0;     ///< V
  double alpha = 8.0e-9;
  double gamma = 2.0;

  /// C1, C2 and C3 of (17).
  [[nodiscard]] StaticMap map() const { return static_map_from_example(y_star, u_star, alpha, gamma); }
  /// The factor C1 = y*/u* taken out of α. It is this one that gives the loop of Figs. 2 and 3.
  [[nodiscard]] Material reconciled() const { return {y_star, u_star, alpha * u_star / y_star, gamma}; }
};

/// Three seconds of memory_element.st, sampled at 1 kHz.
records::Record run_memory_element(const Material& material);

struct LoopFigures {
  double least = 0.0;                     ///< of y, m
  double largest = 0.0;                   ///< m
  double opening = 0.0;                   ///< largest distance of the loop from a straight line, share of the range
  std::vector<double> branching_times{};  ///< t_i, s
  std::vector<double> crossings{};        ///< y where u passes 0, m, after the first branching point
  double element_error = 0.0;             ///< MEM element against dy/dt after t_1, share of the largest rate
};

LoopFigures figures_of(const records::Record& loop);

/// One point of Fig. 5 a sample: the gradient (dy/dt)/(du/dt) and the momentum in the middle of the same interval.
struct Gradient {
  double p = 0.0;
  double gradient = 0.0;
  int branch = 0;  ///< 0: skeleton
};

std::vector<Gradient> gradients_of(const records::Record& loop);

}  // namespace hysteron::examples
