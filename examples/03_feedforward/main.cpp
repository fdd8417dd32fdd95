// Example 3: reference (20) on a simulated actuator, by feedforward of several kinds, and once with feedback.
#include <fmt/format.h>

#include "examples/03_feedforward/feedforward.hpp"
#include "support/atomic_file.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

void print_row(const char* name, const FollowingError& error) {
  fmt::print("{:<44}  {:8.2g}  {:8.2g}\n", name, error.rms, error.worst);
}

void run_feedforwards(const std::filesystem::path& folder) {
  struct Kind {
    const char* name;
    const char* diagram;
  };
  constexpr Kind kinds[] = {{"linear spring", "linear_spring"},
                            {"ODE form, forward Euler", "ode_form"},
                            {"ODE form, Heun", "heun_form"},
                            {"closed form", "closed_form"}};
  const std::vector<double> sample_times{4e-3, 2e-3, 1e-3, 0.5e-3, 0.25e-3};
  std::vector<records::Column> errors;
  for (const Kind& kind : kinds) {
    errors.push_back({.name = kind.diagram});
    for (const double sample_time : sample_times) {
      const auto run = feed_forward(fmt::format("03_feedforward/{}.st", kind.diagram), sample_time);
      const FollowingError error = error_of(run);
      errors.back().values.push_back(error.rms);
      if (sample_time == 1e-3) {
        print_row(kind.name, error);
        records::write_csv(folder / fmt::format("{}.csv", kind.diagram), run);
      } else if (sample_time == 0.5e-3) {
        print_row("  at half the sample time", error);
      }
    }
  }
  std::string table = "sample_time";  // not a record: its first column is no even time
  for (const records::Column& column : errors) {
    table += "," + column.name;
  }
  for (std::size_t i = 0; i < sample_times.size(); ++i) {
    table += fmt::format("\n{}", sample_times[i]);
    for (const records::Column& column : errors) {
      table += fmt::format(",{}", column.values[i]);
    }
  }
  write_file_atomically(folder / "order.csv", table + "\n");
}

void run_feedback(const std::filesystem::path& folder) {
  const records::Record open = control(0.0);
  const records::Record closed = control(2e10);
  print_row("closed form, disturbed, K = 0", error_of(open, 1.0));
  print_row("closed form, disturbed, K = 2e10 V/(m s)", error_of(closed, 1.0));
  print_row("  half a second later", error_of(closed, 1.5));
  records::write_csv(folder / "servo_open.csv", open);
  records::write_csv(folder / "servo_closed.csv", closed);
}

void example(const std::filesystem::path& folder) {
  fmt::print("Error over the range of the reference, at 1 kHz          RMS     worst\n");
  run_feedforwards(folder);
  run_feedback(folder);
  draw("03_feedforward/plot.gp", folder);
}

}  // namespace

int main(int argc, char** argv) {
  return run_example(argc, argv, example);
}
