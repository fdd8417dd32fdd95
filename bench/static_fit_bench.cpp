// The static fit by its default, variable projection, and by Ipopt with all three parameters at once. bench/fit.py
// times rivals on the same points, which `hysteron_bench --data FOLDER` writes.
#include <benchmark/benchmark.h>

#include "bench/static_map_data.hpp"
#include "tuning/static_map.hpp"

namespace hysteron::bench {
namespace {

void static_fit(benchmark::State& state, StaticMapMethod method) {
  const StaticMapData data = static_map_data(static_cast<std::size_t>(state.range(0)));
  StaticMapFit fit;
  for (auto _ : state) {
    fit = fit_static_map({.p = data.p, .M = data.M}, {.method = method});
    benchmark::DoNotOptimize(fit);
  }
  if (!fit.converged()) {
    state.SkipWithError(fit.message.c_str());
  }
  state.counters["p0"] = fit.map.C1;
  state.counters["p1"] = fit.map.C2;
  state.counters["p2"] = fit.map.C3;
}

void variable_projection(benchmark::State& state) {
  static_fit(state, StaticMapMethod::VariableProjection);
}

void by_ipopt(benchmark::State& state) {
  static_fit(state, StaticMapMethod::Ipopt);
}

BENCHMARK(variable_projection)
    ->Name("static_fit/ours")
    ->Arg(200)
    ->Arg(10'000)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(by_ipopt)
    ->Name("static_fit/ours_by_ipopt")
    ->Arg(200)
    ->Arg(10'000)
    ->Arg(1'000'000)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hysteron::bench
