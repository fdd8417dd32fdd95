// A block's step with three derivatives, by Dual<3> and by ceres::Jet<double, 3>, against the same step with double.
#include <benchmark/benchmark.h>
#include <ceres/jet.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "bench/reference_signal.hpp"
#include "blocks/scalar.hpp"
#include "tuning/dual.hpp"

namespace ceres {
/// The one word of the blocks' vocabulary that this step needs and a Jet has under another name.
inline Jet<double, 3> power(const Jet<double, 3>& base, const Jet<double, 3>& exponent) {
  return pow(base, exponent);
}
}  // namespace ceres

// The Jet's words stand above, so that the block finds them.
#include "blocks/hysteresis_ro.hpp"

namespace hysteron::bench {
namespace {

using Jet = ceres::Jet<double, 3>;
using Block = HysteresisRo;
constexpr std::size_t samples = 20'000;
constexpr std::array<double, 3> theta{0.05, 0.0013, 0.7};

double parameter(double value, int /*index*/, double /*tag*/) {
  return value;
}
Dual<3> parameter(double value, int index, Dual<3> /*tag*/) {
  return Dual<3>::variable(value, index);
}
Jet parameter(double value, int index, const Jet& /*tag*/) {
  return {value, index};
}

template <class S, class Take>
void run(const std::vector<double>& signal, Take take) {
  const Block::Params<S> params{.C1 = parameter(theta[0], 0, S{}),
                                .C2 = parameter(theta[1], 1, S{}),
                                .C3 = parameter(theta[2], 2, S{}),
                                .EPS = S(0.0),
                                .START = 0,
                                .U0 = S(0.0),
                                .Y0 = S(0.0)};
  auto state = Block::initial(params);
  const S ts(50e-6);
  for (const double sample : signal) {
    const Block::In<S> in{.XIN = S(40.0 * sample), .R1 = false};
    const auto out = Block::output(params, state, in, ts);
    Block::update(params, state, in, out, ts);
    take(out.XOUT);
  }
}

void hold_equal_derivatives(const std::vector<double>& signal) {
  std::vector<Jet> jets;
  run<Jet>(signal, [&](const Jet& y) { jets.push_back(y); });
  std::size_t k = 0;
  run<Dual<3>>(signal, [&](const Dual<3>& y) {
    const Jet& jet = jets[k++];
    for (int i = 0; i < 3; ++i) {
      // A Jet has no derivative by the exponent at base 0, a Dual has its limit.
      if (std::isfinite(jet.v[i]) && !(std::fabs(jet.v[i] - y.derivative(i)) <= 1e-9 * (1.0 + std::fabs(jet.v[i])))) {
        std::cerr << "sample " << k << ": derivative " << i << " is " << jet.v[i] << " and " << y.derivative(i) << '\n';
        std::exit(1);
      }
    }
  });
}

template <class S>
void dual(benchmark::State& state) {
  static const auto signal = reference_signal(samples);
  static const bool held = (hold_equal_derivatives(signal), true);
  benchmark::DoNotOptimize(held);
  for (auto _ : state) {
    run<S>(signal, [](const S& output) { benchmark::DoNotOptimize(output); });
  }
  state.counters["work"] = static_cast<double>(samples);
}

BENCHMARK(dual<double>)->Name("dual/double");
BENCHMARK(dual<Dual<3>>)->Name("dual/dual");
BENCHMARK(dual<Jet>)->Name("dual/jet");

}  // namespace
}  // namespace hysteron::bench
