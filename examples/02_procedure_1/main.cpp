// Example 2: four fits of the map M(p) to the same points, and the procedure that leaves the truth.
#include <fmt/format.h>

#include <cmath>

#include "examples/02_procedure_1/procedure_1.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

std::array<NamedFit, 4> run_fits(const char* title, const MapPoints& points, const StaticMap& truth) {
  fmt::print("{}, {} points\n", title, points.p.size());
  fmt::print("  {:<22}  {:<11}  {:<11}  {:<9}  {:<8}  rounds\n", "", "C1", "C2", "C3", "rms");
  fmt::print("  {:<22}  {:<11.5g}  {:<11.5g}  {:.6g}\n", "truth", truth.C1, truth.C2, truth.C3);
  auto fits = four_fits(points, truth);
  for (const auto& [name, fit] : fits) {
    fmt::print("  {:<22}  {:<11.5g}  {:<11.5g}  {:<9.6g}  {:<8.2g}  {}\n", name, fit.map.C1, fit.map.C2, fit.map.C3,
               fit.rms, fit.iterations);
  }
  return fits;
}

/// Figs. 7 and 8: the noisy points, and the map that was fitted.
void write_points(const std::filesystem::path& path, const MapPoints& points, const StaticMap& map) {
  std::array<records::Column, 5> columns{
      {{.name = "p"}, {.name = "M"}, {.name = "M_fitted"}, {.name = "p_to_C3"}, {.name = "C1"}}};
  for (std::size_t i = 0; i < points.p.size(); ++i) {
    columns[0].values.push_back(points.p[i]);
    columns[1].values.push_back(points.M[i]);
    columns[2].values.push_back(map(points.p[i]));
    columns[3].values.push_back(std::pow(points.p[i], map.C3));
    columns[4].values.push_back(map.C1);
  }
  write_table(path, columns);
}

void write_rounds(const std::filesystem::path& path, const StaticMapFit& fit) {
  std::array<records::Column, 2> columns{{{.name = "round"}, {.name = "C3"}}};
  for (const StaticMapRound& round : fit.history) {
    columns[0].values.push_back(static_cast<double>(columns[0].values.size() + 1));
    columns[1].values.push_back(round.map.C3);
  }
  write_table(path, columns);
}

void example(const std::filesystem::path& folder) {
  const MapPoints noisy = points_from_loop(1e-9);
  run_fits("Loop of Example 1, exact", points_from_loop(0.0), loop_map());
  fmt::print("\n");
  const auto fits = run_fits("Loop of Example 1, 1 nm of noise on y", noisy, loop_map());
  fmt::print("\n");
  const auto exact = run_fits("M = 0.05 + 1.3 p^1.7, exact", counterexample(), counterexample_map);
  write_points(folder / "map.csv", noisy, fits[2].fit.map);
  write_rounds(folder / "rounds_as_printed.csv", exact[0].fit);
  write_rounds(folder / "rounds_weighted.csv", exact[1].fit);
  draw("02_procedure_1/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
