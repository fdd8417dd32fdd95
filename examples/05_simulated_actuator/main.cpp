// Example 5: from the log of a simulated machine to a feedforward in C++ that drives it, for where no measured records
// are at hand.
#include <fmt/format.h>

#include <array>

#include "examples/04_piezo_stack/piezo_stack.hpp"
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

constexpr std::size_t rows_at_first = 200;  ///< one second, in which the machine comes from rest to the middle

/// How far y strays from the reference of the row before, about its mean, um.
double spread(const std::vector<double>& ref, const std::vector<double>& y) {
  return difference({y.begin() + 1, y.end()}, ref, rows_at_first + 1);
}

/// Tunes the model of example 4 on the identification record, and drives the machine by its inverse as generated code.
void feed_forward(const std::filesystem::path& folder, const records::Record& identification) {
  const TunedDiagram plant = tune("plant", "one_sample", identification);
  fmt::print("\nThe paper's model, tuned on 20 of the periods, leaves\n");
  fmt::print("  of these                     {:6.2f} % of the range, RMS\n", 100.0 * plant.train_share());
  fmt::print("  of the rest                  {:6.2f} %\n", 100.0 * plant.test_share());

  simulated::Settings settings;
  settings.seed = 2;  // not the noise of the identification
  const std::vector<double> ref = simulated::test_reference(settings.sample_time);
  records::Record reference = records::Record::even(0.0, settings.sample_time, ref.size());
  reference.add({.name = "REF", .unit = "um", .values = ref});
  const Program feedforward = feedforward_of("feedforward", plant);
  const std::vector<double> u = run_generated(feedforward, reference, folder / "generated");
  const std::vector<double> y = simulated::play(u, settings);
  fmt::print(
      "\nIts inverse, generated to C++, compiled, and driven by loops inside loops that the log did not contain\n");
  fmt::print("  the interpreter's bits: {}\n", u == simulate(feedforward, reference).front() ? "equal" : "DIFFERENT");
  fmt::print("  error of a straight line     {:6.2f} um, RMS about its mean\n",
             spread(ref, simulated::play(simulated::voltage_without_model(ref), settings)));
  fmt::print("  error of the feedforward     {:6.2f} um\n", spread(ref, y));

  records::Record driven = record_of(u, y, settings.sample_time);
  driven.add({.name = "ref", .unit = "", .values = ref});
  records::write_csv(folder / "simulated_feedforward.csv", driven);
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

  const std::vector<double> test_u = simulated::voltage_without_model(simulated::test_reference(settings.sample_time));
  const records::Record identification = record_of(u, y, settings.sample_time);
  records::write_csv(folder / "simulated_identify.csv", identification);
  records::write_csv(folder / "simulated_test.csv",
                     record_of(test_u, simulated::play(test_u, settings), settings.sample_time));
  write_period_means(folder / "simulated_creep.csv", y, 200);
  feed_forward(folder, identification);
  draw("05_simulated_actuator/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
