// A fixed piece of work, to be run under callgrind: `counted WORK`. What is prepared stands outside counted_region, so
// that only the work is counted.
#include <cstddef>
#include <cstdio>
#include <functional>
#include <string_view>

#include "bench/many_instances.hpp"
#include "bench/reference_signal.hpp"
#include "bench/static_map_data.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/interpreter/machine.hpp"
#include "feedforward.hpp"

namespace {

constexpr std::size_t steps = 10'000;
constexpr int instances = 10'000;
constexpr int fewer_instances = 1'000;
constexpr std::size_t points = 200;

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
  } else if (work == "static_fit") {
    result = static_fit();
  } else {
    std::fputs(
        "usage: counted generated_step | interpreted_step | check | check_fewer | generate | generate_fewer | "
        "static_fit\n",
        stderr);
    return 2;
  }
  std::printf("%.17g\n", result);
  return 0;
}
