#include "examples/02_procedure_1/procedure_1.hpp"

#include <random>

#include "examples/01_memory_element/memory_element.hpp"

namespace hysteron::examples {

StaticMap loop_map() {
  return Material{}.reconciled().map();
}

MapPoints points_from_loop(double noise) {
  const records::Record loop = run_memory_element(Material{}.reconciled());
  std::vector<double> y(column(loop, "Y").begin(), column(loop, "Y").end());
  HysteresisPointOptions options{.formula = RateFormula::TwoPoint, .rate_threshold = 250.0};
  if (noise > 0.0) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0.0, noise);
    for (double& value : y) {
      value += normal(random);
    }
    options.formula = RateFormula::LocalQuadratic;
  }
  HysteresisPoints points = hysteresis_points(column(loop, "U"), y, loop.sample_time(), options);
  return {.p = std::move(points.p), .M = std::move(points.M)};
}

MapPoints counterexample() {
  MapPoints points;
  for (int i = 0; i < 200; ++i) {
    points.p.push_back(0.001 + 0.999 * i / 199.0);
    points.M.push_back(counterexample_map(points.p.back()));
  }
  return points;
}

std::array<NamedFit, 4> four_fits(const MapPoints& points, const StaticMap& truth) {
  const double start = 0.95 * truth.C1;
  const auto fit = [&](const StaticMapOptions& options) { return fit_static_map(points.view(), options); };
  return {{{"Procedure 1 as printed",
            fit({.method = StaticMapMethod::Procedure1, .start_C1 = start, .max_iterations = 20})},
           {"Procedure 1 weighted", fit({.method = StaticMapMethod::Procedure1Weighted, .start_C1 = start})},
           {"variable projection", fit({.method = StaticMapMethod::VariableProjection})},
           {"Ipopt", fit({.method = StaticMapMethod::Ipopt})}}};
}

}  // namespace hysteron::examples
