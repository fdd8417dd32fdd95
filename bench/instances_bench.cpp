// Checking a diagram and generating its step, by the number of its instances.
#include <benchmark/benchmark.h>

#include "bench/many_instances.hpp"
#include "codegen/backends/cpp/cpp.hpp"

namespace hysteron::bench {
namespace {

void check_and_generate(benchmark::State& state, const Group& group) {
  const std::string text = many_instances(static_cast<int>(state.range(0)), group);
  for (auto _ : state) {
    const Program program = compile_text(text);
    benchmark::DoNotOptimize(generate_cpp_header(program));
  }
}

void of_plain_blocks(benchmark::State& state) {
  check_and_generate(state, plain);
}

void of_hystereses(benchmark::State& state) {
  check_and_generate(state, with_hysteresis);
}

// Real time: two threads print.
BENCHMARK(of_plain_blocks)->Arg(10'000)->Arg(100'000)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(of_hystereses)->Arg(10'000)->Arg(100'000)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hysteron::bench
