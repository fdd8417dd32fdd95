#include "examples/01_memory_element/memory_element.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace hysteron::examples {

records::Record run_memory_element(const Material& material) {
  const StaticMap map = material.map();
  const std::array settings{Setting{"HYST.C1", map.C1},    Setting{"HYST.C2", map.C2},
                            Setting{"HYST.C3", map.C3},    Setting{"ELEMENT.C1", map.C1},
                            Setting{"ELEMENT.C2", map.C2}, Setting{"ELEMENT.C3", map.C3}};
  return Diagram("01_memory_element/memory_element.st", settings).run(3001);
}

LoopFigures figures_of(const records::Record& loop) {
  const auto u = column(loop, "U");
  const auto y = column(loop, "Y");
  const auto rate = column(loop, "Y_RATE");
  const auto model = column(loop, "MODEL_RATE");
  const auto branch = column(loop, "BRANCH");
  LoopFigures figures;
  const auto [least, largest] = std::ranges::minmax(y);
  figures.least = least;
  figures.largest = largest;
  const double slope = (largest - least) / range(u);
  double largest_rate = 0.0;
  for (std::size_t k = 1; k < u.size(); ++k) {
    figures.opening = std::max(figures.opening, std::fabs(y[k] - slope * u[k]) / (largest - least));
    largest_rate = std::max(largest_rate, std::fabs(rate[k]));
    if (branch[k] != branch[k - 1]) {
      figures.branching_times.push_back(loop.time()[k - 1]);  // a reversal shows one sample after the extreme
    }
    if (branch[k] > 0.0) {
      figures.element_error = std::max(figures.element_error, std::fabs(model[k] - rate[k]));
      if (u[k] == 0.0 || u[k - 1] * u[k] < 0.0) {
        figures.crossings.push_back(y[k - 1] + (y[k] - y[k - 1]) * u[k - 1] / (u[k - 1] - u[k]));
      }
    }
  }
  figures.element_error /= largest_rate;
  return figures;
}

std::vector<Gradient> gradients_of(const records::Record& loop) {
  const auto u = column(loop, "U");
  const auto y = column(loop, "Y");
  const auto p = column(loop, "P");
  const auto branch = column(loop, "BRANCH");
  std::vector<Gradient> gradients;
  for (std::size_t k = 1; k < u.size(); ++k) {
    const double travel = std::fabs(u[k] - u[k - 1]) * (branch[k] > 0.0 ? 1.0 : 2.0);  // twice on the skeleton
    gradients.push_back({.p = p[k] - 0.5 * travel,
                         .gradient = (y[k] - y[k - 1]) / (u[k] - u[k - 1]),
                         .branch = static_cast<int>(branch[k])});
  }
  return gradients;
}

}  // namespace hysteron::examples
