// Checking a diagram and generating its step, by the number of its instances.
#include <benchmark/benchmark.h>

#include "bench/many_instances.hpp"
#include "codegen/backends/cpp.hpp"

namespace hysteron::bench {
namespace {

void check_and_generate(benchmark::State& state) {
  const std::string text = many_instances(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    const Program program = compile_text(text);
    benchmark::DoNotOptimize(generate_cpp_header(program));
  }
}

void check_alone(benchmark::State& state) {
  const std::string text = many_instances(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    benchmark::DoNotOptimize(compile_text(text));
  }
}

BENCHMARK(check_and_generate)->Arg(1'000)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(check_alone)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hysteron::bench
