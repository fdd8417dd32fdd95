// A fixed piece of work, to be run under callgrind: `counted WORK`. What is prepared stands outside counted_region, so
// that only the work is counted.
#include <cstddef>
#include <cstdio>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/machine_record.hpp"
#include "bench/many_instances.hpp"
#include "bench/reference_signal.hpp"
#include "bench/static_map_data.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "diagnosis/diagnose.hpp"
#include "feedforward.hpp"
#include "records/record.hpp"
#include "support/text_file.hpp"
#include "tuning/output_error.hpp"
#include "tuning/rollout.hpp"

namespace {

constexpr std::size_t steps = 10'000;
constexpr int instances = 10'000;
constexpr int fewer_instances = 1'000;
constexpr std::size_t points = 200;
constexpr std::size_t short_record = 1'000;
constexpr std::size_t diagnosed = 500;
constexpr int iterations = 4;

}  // namespace

/// The function that callgrind counts in.
extern "C" [[gnu::noinline]] double counted_region(const std::function<double()>& work) {
  return work();
}

namespace {

double generated_step() {
  const auto signal = hysteron::bench::reference_signal(steps);
  const feedforward::Params params;
  feedforward::State state;
  feedforward::In in;
  feedforward::reset(params, state);
  return counted_region([&] {
    double last = 0.0;
    for (const double reference : signal) {
      in.y_ref = reference;
      last = feedforward::step(params, state, in).u;
    }
    return last;
  });
}

double interpreted_step() {
  const auto signal = hysteron::bench::reference_signal(steps);
  hysteron::Diagnostics warnings;
  hysteron::Machine<double> machine(hysteron::compile_file(HYSTERON_SOURCE_DIR "/bench/feedforward.st", {}, warnings));
  return counted_region([&] {
    for (const double reference : signal) {
      machine.set_input(0, reference);
      machine.step();
    }
    return machine.output(0);
  });
}

double check(int count) {
  const std::string text = hysteron::bench::many_instances(count);
  hysteron::compile_text(hysteron::bench::many_instances(5));  // traces the blocks, once in a process
  return counted_region([&] { return static_cast<double>(hysteron::compile_text(text).graph.nodes.size()); });
}

double generate(int count) {
  const auto program = hysteron::compile_text(hysteron::bench::many_instances(count));
  return counted_region([&] { return static_cast<double>(hysteron::generate_cpp_header(program).text.size()); });
}

/// A rollout of a gear with play, a resonance and a creep, as a diagnosis runs thousands of: plain, or with the
/// derivatives by six parameters.
double rollout(bool derivatives) {
  hysteron::Diagnostics warnings;
  const auto program = hysteron::compile_file(HYSTERON_SOURCE_DIR "/bench/diagnosis/machine.st", {}, warnings);
  const auto file =
      hysteron::parameters::parse_parameter_file("counted.toml",
                                                 "[fit.AMPLIFIER]\nT1 = {}\n[fit.GEAR]\nWIDTH = {}\n[fit.STAGE]\nK = "
                                                 "{}\nT = {}\n[fit.CREEP]\nGAIN = {}\nT_ONSET = {}\n");
  auto record = hysteron::records::Record::even(0.0, 1e-3, steps);
  record.add({.name = "U", .values = hysteron::bench::reference_signal(steps)});
  record.add({.name = "Y", .values = std::vector<double>(steps)});
  const auto problem = hysteron::output_error_problem(program, file, std::vector{record});
  hysteron::detail::Rollout rollout(problem);
  Eigen::VectorXd x(rollout.unknowns());
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    x[static_cast<Eigen::Index>(j)] = problem.parameters[j].start;
  }
  Eigen::VectorXd residuals(rollout.residual_count());
  Eigen::MatrixXd jacobian(rollout.residual_count(), rollout.unknowns());
  return counted_region([&] {
    rollout.residuals(x, residuals, derivatives ? &jacobian : nullptr);
    return residuals.norm();
  });
}

/// The first iterations of the fit of six parameters to a record of the same machine.
double output_error() {
  auto numbers = hysteron::bench::machine_record(short_record);
  auto record = hysteron::records::Record::even(0.0, hysteron::bench::machine_period, short_record);
  record.add({.name = "U", .values = std::move(numbers.u)});
  record.add({.name = "Y", .values = std::move(numbers.y)});
  const auto problem = hysteron::output_error_problem(
      hysteron::bench::machine_program(),
      hysteron::parameters::parse_parameter_file("counted.toml", hysteron::bench::machine_parameters),
      std::vector{record});
  return counted_region(
      [&] { return hysteron::fit_output_error(problem, {.max_iterations = iterations}).solution.iterations; });
}

/// The diagnosis of a record of that machine by the model of bench/diagnosis, which lacks its play and its creep:
/// two effects at each edge, one at a time.
double diagnosis() {
  auto numbers = hysteron::bench::machine_record(diagnosed);
  hysteron::diagnosis::DiagnosisInput input;
  input.text = hysteron::read_text_file(HYSTERON_SOURCE_DIR "/bench/diagnosis/axis.st");
  input.program = hysteron::compile_text(input.text);
  input.file = hysteron::parameters::read_parameter_file(HYSTERON_SOURCE_DIR "/bench/diagnosis/params.toml");
  input.records.push_back(hysteron::records::Record::even(0.0, hysteron::bench::machine_period, diagnosed));
  input.records.front().add({.name = "U", .values = std::move(numbers.u)});
  input.records.front().add({.name = "Y", .values = std::move(numbers.y)});
  return counted_region([&] {
    const auto found = hysteron::diagnosis::diagnose(
        input, {.effects = {"backlash", "creep"}, .most_effects = 1, .effort = 0.02, .threads = 1});
    return static_cast<double>(found.work);
  });
}

double static_fit() {
  const auto data = hysteron::bench::static_map_data(points);
  return counted_region([&] { return hysteron::fit_static_map({.p = data.p, .M = data.M}).map.C3; });
}

}  // namespace

int main(int count, char** arguments) {
  const std::string_view work = count == 2 ? arguments[1] : "";
  double result = 0.0;
  if (work == "generated_step") {
    result = generated_step();
  } else if (work == "interpreted_step") {
    result = interpreted_step();
  } else if (work == "check") {
    result = check(instances);
  } else if (work == "check_fewer") {
    result = check(fewer_instances);
  } else if (work == "generate") {
    result = generate(instances);
  } else if (work == "generate_fewer") {
    result = generate(fewer_instances);
  } else if (work == "rollout") {
    result = rollout(false);
  } else if (work == "derivatives") {
    result = rollout(true);
  } else if (work == "output_error") {
    result = output_error();
  } else if (work == "diagnosis") {
    result = diagnosis();
  } else if (work == "static_fit") {
    result = static_fit();
  } else {
    std::fputs(
        "usage: counted generated_step | interpreted_step | check | check_fewer | generate | generate_fewer | "
        "rollout | derivatives | output_error | diagnosis | static_fit\n",
        stderr);
    return 2;
  }
  std::printf("%.17g\n", result);
  return 0;
}
