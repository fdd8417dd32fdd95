// One step of the feedforward: generated, written by hand, interpreted. All three give the same bits.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <cstring>
#include <iostream>

#include "bench/hand_written.hpp"
#include "bench/reference_signal.hpp"
#include "codegen/interpreter/machine.hpp"
#include "feedforward.hpp"

namespace hysteron::bench {
namespace {

constexpr std::size_t samples = 20'000;

const std::vector<double>& signal() {
  static const auto samples_of_signal = reference_signal(samples);
  return samples_of_signal;
}

const Program& program() {
  static const Program compiled = [] {
    Diagnostics warnings;
    return compile_file(HYSTERON_SOURCE_DIR "/bench/feedforward.st", {}, warnings);
  }();
  return compiled;
}

/// Resets, runs over the whole signal and hands every output to `take`.
struct Generated {
  feedforward::Params params{};
  feedforward::State state{};
  feedforward::In in{};

  template <class Take>
  void run(Take take) {
    feedforward::reset(params, state);
    for (const double reference : signal()) {
      in.y_ref = reference;
      take(feedforward::step(params, state, in).u);
    }
  }
};

struct HandWritten {
  hand_written::Params params;
  hand_written::State state;
  bool reset = false;

  template <class Take>
  void run(Take take) {
    state = {};
    for (const double reference : signal()) {
      take(hand_written::step(params, state, reference, reset));
    }
  }
};

struct Interpreted {
  Machine<double> machine{program()};

  template <class Take>
  void run(Take take) {
    machine.reset();
    for (const double reference : signal()) {
      machine.set_input(0, reference);
      machine.step();
      take(machine.output(0));
    }
  }
};

template <class Kind>
std::vector<double> outputs() {
  Kind kind;
  std::vector<double> result;
  kind.run([&](double output) { result.push_back(output); });
  return result;
}

void hold_equal_bits() {
  static const bool equal = [] {
    const auto generated = outputs<Generated>();
    const auto same = [&](const std::vector<double>& other) {
      return std::memcmp(generated.data(), other.data(), samples * sizeof(double)) == 0;
    };
    return same(outputs<HandWritten>()) && same(outputs<Interpreted>());
  }();
  if (!equal) {
    std::cerr << "the steps differ in their bits: nothing to compare\n";
    std::exit(1);
  }
}

template <class Kind>
void step(benchmark::State& state) {
  hold_equal_bits();
  Kind kind;
  benchmark::DoNotOptimize(&kind);
  for (auto _ : state) {
    kind.run([](double output) { benchmark::DoNotOptimize(output); });
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}

BENCHMARK(step<Generated>)->Name("step/generated");
BENCHMARK(step<HandWritten>)->Name("step/hand_written");
BENCHMARK(step<Interpreted>)->Name("step/interpreted");

}  // namespace
}  // namespace hysteron::bench
