// The static fit by its default, variable projection. Its rival, scipy's curve_fit, is timed by static_fit_scipy.py on
// the same points, which `hysteron_bench --write-static-map-data FOLDER` writes.
#include <benchmark/benchmark.h>

#include "bench/static_map_data.hpp"
#include "tuning/static_map.hpp"

namespace hysteron::bench {
namespace {

void static_fit(benchmark::State& state) {
  const StaticMapData data = static_map_data(static_cast<std::size_t>(state.range(0)));
  StaticMapFit fit;
  for (auto _ : state) {
    fit = fit_static_map({.p = data.p, .M = data.M});
    benchmark::DoNotOptimize(fit);
  }
  if (!fit.converged()) {
    state.SkipWithError(fit.message.c_str());
  }
  state.counters["C1"] = fit.map.C1;
  state.counters["C2"] = fit.map.C2;
  state.counters["C3"] = fit.map.C3;
}

BENCHMARK(static_fit)->Arg(200)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hysteron::bench
