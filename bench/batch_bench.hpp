// 128 instances of the feedforward with an exponent each, over one reference: a batch at each width of registers. A
// file includes it with a name for its rows, and HYSTERON_BATCH_FAST or not.
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <vector>

#include "bench/reference_signal.hpp"
#include "feedforward_batch.hpp"

namespace hysteron::bench {
namespace {

constexpr std::size_t batch_packs = 16;
constexpr std::size_t batch_samples = 20'000;

void batch(benchmark::State& state) {
  namespace step = feedforward_batch;
  const std::vector<double> signal = reference_signal(batch_samples);
  std::vector<step::Params> params(batch_packs);
  std::vector<step::State> states(batch_packs);
  std::vector<step::In> in(batch_packs);
  std::vector<step::Out> out(batch_packs);
  for (std::size_t i = 0; i < batch_packs * step::width; ++i) {
    params[i / step::width].inv.c3.lane[i % step::width] = 0.6 + 0.002 * static_cast<double>(i);
  }
  for (auto _ : state) {
    step::reset(batch_packs, params.data(), states.data());
    for (const double reference : signal) {
      for (step::In& one : in) {
        for (double& lane : one.y_ref.lane) {
          lane = reference;
        }
      }
      step::step(batch_packs, params.data(), states.data(), in.data(), out.data(), static_cast<int>(state.range(0)));
      benchmark::DoNotOptimize(out.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(batch_samples * batch_packs * step::width));
}

/// The widths that this processor has.
void add_batch(const std::string& name) {
  for (int lanes = feedforward_batch::lanes_of_processor(); lanes >= 2; lanes /= 2) {
    benchmark::RegisterBenchmark(name.c_str(), batch)->Arg(lanes);
  }
}

}  // namespace
}  // namespace hysteron::bench
