// From the text of a diagram to code, by the number of its instances: to the C++ header, and to the interpreter, ready
// to run.
#include <benchmark/benchmark.h>

#include "bench/many_instances.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/interpreter/machine.hpp"

namespace hysteron::bench {
namespace {

void check_and_generate(benchmark::State& state, const Group& group) {
  const std::string text = many_instances(static_cast<int>(state.range(0)), group);
  for (auto _ : state) {
    const Program program = compile_text(text);
    benchmark::DoNotOptimize(generate_cpp_header(program));
  }
  state.counters["work"] = static_cast<double>(state.range(0));
}

void to_interpreter(benchmark::State& state) {
  const std::string text = many_instances(static_cast<int>(state.range(0)), plain);
  for (auto _ : state) {
    Machine<double> machine(compile_text(text));
    machine.step();
    benchmark::DoNotOptimize(machine.output(0));
  }
  state.counters["work"] = static_cast<double>(state.range(0));
}

void of_plain_blocks(benchmark::State& state) {
  check_and_generate(state, plain);
}

void of_hystereses(benchmark::State& state) {
  check_and_generate(state, with_hysteresis);
}

/// Two threads print: the time of both counts.
void sizes(benchmark::internal::Benchmark* one) {
  one->RangeMultiplier(10)->Range(10, 1'000'000)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK(of_plain_blocks)->Name("text/header")->Apply(sizes);
BENCHMARK(of_hystereses)->Name("text/header_of_hystereses")->Apply(sizes);
BENCHMARK(to_interpreter)->Name("text/interpreter")->Apply(sizes);

}  // namespace
}  // namespace hysteron::bench
