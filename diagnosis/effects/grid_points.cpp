#include "diagnosis/effects/grid_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hysteron::diagnosis {
namespace {

/// More settings of shapes than this are tried one shape at a time about the middle of each.
constexpr std::size_t most_shapes = 16;

bool is_searched_shape(const Applied& effect, const Grids& grids, std::size_t j) {
  return !effect.parameters[j].strength && !grids.parameters[j].values.empty();
}

}  // namespace

std::vector<VectorXd> shapes_of(const Applied& effect, const Grids& grids, const VectorXd& neutral) {
  std::vector<VectorXd> shapes{neutral};
  VectorXd middle = neutral;
  for (std::size_t j = 0; j < effect.parameters.size(); ++j) {
    if (!is_searched_shape(effect, grids, j)) {
      continue;
    }
    const std::vector<double>& values = grids.parameters[j].values;
    middle[static_cast<Index>(j)] = values[values.size() / 2];
    std::vector<VectorXd> more;
    for (const VectorXd& shape : shapes) {
      for (const double value : values) {
        more.push_back(shape);
        more.back()[static_cast<Index>(j)] = value;
      }
    }
    shapes = std::move(more);
  }
  if (shapes.size() <= most_shapes) {
    return shapes;
  }
  shapes.assign(1, middle);
  for (std::size_t j = 0; j < effect.parameters.size(); ++j) {
    if (!is_searched_shape(effect, grids, j)) {
      continue;
    }
    for (const double value : grids.parameters[j].values) {
      if (value != middle[static_cast<Index>(j)]) {
        shapes.push_back(middle);
        shapes.back()[static_cast<Index>(j)] = value;
      }
    }
  }
  return shapes;
}

bool is_near(const VectorXd& a, const VectorXd& b) {
  constexpr double near = 0.05;
  return ((a - b).array().abs() <= near * a.array().abs().max(b.array().abs())).all();
}

std::size_t nearest(const std::vector<double>& values, double value) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::abs(values[k] - value) < std::abs(values[best] - value)) {
      best = k;
    }
  }
  return best;
}

}  // namespace hysteron::diagnosis
