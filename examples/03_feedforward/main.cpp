// Example 3: reference (20) on a simulated actuator, by feedforward of several kinds, and once with feedback.
#include <fmt/format.h>

#include "examples/03_feedforward/feedforward.hpp"

using namespace hysteron;
using namespace hysteron::examples;

namespace {

void print_row(const char* name, const FollowingError& error) {
  fmt::print("{:<44}  {:8.1e}  {:8.1e}\n", name, error.rms, error.worst);
}

void run_feedforwards(const std::filesystem::path& folder) {
  const std::vector<double> sample_times{4e-3, 2e-3, 1e-3, 0.5e-3, 0.25e-3};
  std::vector<records::Column> table{{.name = "sample_time", .unit = "", .values = sample_times}};
  for (const Form& form : forms()) {
    table.push_back({.name = form.diagram});
    for (const double sample_time : sample_times) {
      const auto run = feed_forward(form, Start::BranchingPoint, sample_time);
      table.back().values.push_back(error_of(run).rms);
      if (sample_time == 1e-3) {
        print_row(form.name, error_of(run));
        records::write_csv(folder / fmt::format("{}.csv", form.diagram), run);
      } else if (sample_time == 0.5e-3) {
        print_row("  at half the sample time", error_of(run));
      }
    }
    print_row("  from rest, on the skeleton curve", error_of(feed_forward(form, Start::Rest, 1e-3), -0.25));
  }
  write_table(folder / "order.csv", table);
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
