// Example 5: the records of the simulated machine, for where no measured ones are at hand.
#include <fmt/format.h>

#include <array>

#include "examples/05_simulated_actuator/figures.hpp"
#include "examples/05_simulated_actuator/simulator.hpp"
#include "examples/example.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

/// Records of the simulated machine have plain column names, as those of the measured one.
records::Record record_of(const std::vector<double>& u, const std::vector<double>& y, double sample_time) {
  records::Record record = records::Record::even(0.0, sample_time, u.size());
  record.add({.name = "u", .unit = "", .values = u});
  record.add({.name = "y", .unit = "", .values = y});
  return record;
}

void write_period_means(const std::filesystem::path& path, const std::vector<double>& y, std::size_t period) {
  std::array<records::Column, 2> columns{{{.name = "t"}, {.name = "mean"}}};
  for (std::size_t i = 0; (i + 1) * period <= y.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = i * period; k < (i + 1) * period; ++k) {
      sum += y[k];
    }
    columns[0].values.push_back(static_cast<double>(i) + 0.5);
    columns[1].values.push_back(sum / static_cast<double>(period));
  }
  write_table(path, columns);
}

void example(const std::filesystem::path& folder) {
  const simulated::Settings settings;
  const std::vector<double> u = simulated::identification_voltage(settings.sample_time);
  const std::vector<double> y = simulated::play(u, settings);
  const simulated::LoopFigures figures = simulated::figures_of(u, y, 200);
  fmt::print("Simulated, not measured: 40 periods of 1 Hz, 0 to 3.6 V, 200 samples a second\n");
  fmt::print("  range                        {:6.2f} um\n", figures.range);
  fmt::print("  width of the loop            {:6.1f} % of the range\n", figures.width * 100.0);
  fmt::print("  a straight line leaves       {:6.2f} % of the range, RMS\n", figures.line_rms * 100.0);
  fmt::print("  creep of the mean            {:6.2f} um a decade of time\n", figures.creep);
  fmt::print("  noise                        {:6.3f} um, standard deviation\n", figures.noise);

  std::vector<double> test_u;
  for (const double wanted : simulated::test_reference(settings.sample_time)) {
    test_u.push_back(simulated::voltage_without_model(wanted));
  }
  records::write_csv(folder / "simulated_identify.csv", record_of(u, y, settings.sample_time));
  records::write_csv(folder / "simulated_test.csv",
                     record_of(test_u, simulated::play(test_u, settings), settings.sample_time));
  write_period_means(folder / "simulated_creep.csv", y, 200);
  draw("05_simulated_actuator/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
