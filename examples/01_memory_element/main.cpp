// Example 1: the loop of the paper's Figs. 2 to 6, with the constants as printed and reconciled.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "examples/01_memory_element/memory_element.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

void print_row(const char* name, const Material& material, const LoopFigures& figures) {
  const StaticMap map = material.map();
  fmt::print("{:<10}  {:<8.5g}  {:<9.3g}  {:<9.3g}  {:<3g}  {:8.4f} … {:6.4f}  {:9.2g} %\n", name, material.alpha,
             map.C1, map.C2, map.C3, figures.least * 1e6, figures.largest * 1e6, figures.opening * 100.0);
}

void write_gradients(const std::filesystem::path& path, const records::Record& loop) {
  std::array<records::Column, 3> columns{{{.name = "P"}, {.name = "GRADIENT"}, {.name = "BRANCH"}}};
  for (const Gradient& point : gradients_of(loop)) {
    columns[0].values.push_back(point.p);
    columns[1].values.push_back(point.gradient);
    columns[2].values.push_back(point.branch);
  }
  write_table(path, columns);
}

void example(const std::filesystem::path& folder) {
  const Material printed;
  const Material reconciled = printed.reconciled();
  const records::Record straight = run_memory_element(printed);
  const records::Record loop = run_memory_element(reconciled);
  const LoopFigures figures = figures_of(loop);

  fmt::print("            alpha     C1 [m/V]   C2 [m/V²]  C3   y [um]             loop opening\n");
  print_row("as printed", printed, figures_of(straight));
  print_row("reconciled", reconciled, figures);
  std::vector<double> crossings;
  for (const double y : figures.crossings) {
    crossings.push_back(y * 1e6);
  }
  fmt::print("\nBranching points at t = {} s\n", fmt::join(figures.branching_times, ", "));
  fmt::print("The loop passes u = 0 at y = {:.4f} um\n", fmt::join(crossings, ", "));
  fmt::print("MEM element between the rates, forward Euler at 1 ms: within {:.2g} % of the largest rate\n",
             figures.element_error * 100.0);

  records::write_csv(folder / "memory_element.csv", loop);
  records::write_csv(folder / "memory_element_as_printed.csv", straight);
  write_gradients(folder / "memory_element_gradient.csv", loop);
  draw("01_memory_element/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
