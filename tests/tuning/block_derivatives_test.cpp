// Dual against differences: the derivative that a block gives with dual numbers is the slope of what it computes.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blocks/catalogue.hpp"
#include "tests/blocks/any_block.hpp"
#include "tests/blocks/random_io.hpp"
#include "tuning/dual.hpp"

namespace hysteron::testing {
namespace {

using D = Dual<1>;

/// Where the real numbers of a structure stand that are no elements of an array.
std::vector<std::size_t> real_places(std::span<const Field> fields) {
  std::vector<std::size_t> result;
  const auto at = places(fields);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].type == Type::Real && fields[i].length == 1) {
      result.push_back(at[i]);
    }
  }
  return result;
}

/// Parameters, and the inputs of some steps.
struct Given {
  std::vector<double> params;
  std::vector<std::vector<double>> inputs;
};

template <class S>
std::vector<S> in_scalar(const std::vector<double>& numbers) {
  return std::vector<S>(numbers.begin(), numbers.end());
}

/// The real outputs of some steps, with one real number of the parameters, then of the inputs, displaced.
template <class S, class Run>
std::vector<S> run(const AnyBlock& block, MakeRun<Run, S> make, const Given& given, double ts, std::size_t which,
                   const S& displacement) {
  const auto of_params = real_places(block.params);
  const auto of_inputs = real_places(block.in);
  const auto displace = [&](std::vector<S>& numbers, std::size_t place) {
    numbers[place] = numbers[place] + displacement;
  };
  auto params = in_scalar<S>(given.params);
  if (which < of_params.size()) {
    displace(params, of_params[which]);
  }
  const auto one = make(params, ts);
  std::vector<S> out(places(block.out).back());
  std::vector<S> results;
  for (const auto& input : given.inputs) {
    auto in = in_scalar<S>(input);
    if (which >= of_params.size()) {
      displace(in, of_inputs[which - of_params.size()]);
    }
    one->step(in, out);
    for (const std::size_t place : real_places(block.out)) {
      results.push_back(out[place]);
    }
  }
  return results;
}

struct Tally {
  int compared = 0;
  int kinks = 0;
};

// A difference quotient is compared where the function is smooth there: two quotients of different width agree.
void hold_dual_against_differences(const AnyBlock& block, MakeRun<AnyRun<D>, D> in_dual, double ts, std::uint64_t seed,
                                   bool neutral, Tally& tally) {
  RandomIo random(seed, ts);
  Given given{.params = random.numbers(block.params), .inputs = {}};
  if (neutral) {
    neutralise(block.params, given.params);
  }
  for (int k = 0; k < 12; ++k) {
    given.inputs.push_back(random.numbers(block.in));
  }
  const std::size_t numbers = real_places(block.params).size() + real_places(block.in).size();
  for (std::size_t which = 0; which < numbers; ++which) {
    const auto exact = run(block, in_dual, given, ts, which, D::variable(0.0, 0));
    const auto here = run(block, block.in_double, given, ts, which, 0.0);
    std::array<std::vector<double>, 4> at;
    constexpr std::array<double, 4> step{1e-6, -1e-6, 2e-6, -2e-6};
    for (std::size_t i = 0; i < 4; ++i) {
      at[i] = run(block, block.in_double, given, ts, which, step[i]);
    }
    for (std::size_t i = 0; i < here.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(exact[i].value()), std::bit_cast<std::uint64_t>(here[i]))
          << block.about->name << ": the value of a dual is the plain value";
      ASSERT_FALSE(std::isnan(exact[i].derivative(0))) << block.about->name << " member " << which << " seed " << seed;
      const double right = (at[0][i] - here[i]) / 1e-6;
      const double left = (here[i] - at[1][i]) / 1e-6;
      const double wide = (at[2][i] - at[3][i]) / 4e-6;
      const double narrow = (right + left) / 2.0;
      const double scale = 1.0 + std::fabs(narrow);
      const double rounding = 1e-9 * std::fabs(here[i]) + 1e-4 * scale;
      if (std::fabs(right - left) > 0.01 * scale || std::fabs(wide - narrow) > rounding) {
        ++tally.kinks;
        continue;
      }
      ++tally.compared;
      EXPECT_NEAR(exact[i].derivative(0), narrow, 1e-3 * scale + rounding)
          << block.about->name << " real member " << which << " seed " << seed << " result " << i
          << (neutral ? " neutral" : "");
    }
  }
}

TEST(Dual, EveryBlocksDerivativeIsTheSlopeOfItsOutputs) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Catalogue::for_each([&]<class B> {
      hold_dual_against_differences(AnyBlock::of<B>(), make_run<B, D, D>, 1e-2, seed, false, tally);
    });
  }
  EXPECT_GT(tally.compared, 20 * tally.kinks) << "nearly all points are smooth";
}

TEST(Dual, AlsoAtNeutralSettingsWhereEffectsBegin) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Catalogue::for_each([&]<class B> {
      if (!B::about.effect.empty()) {
        hold_dual_against_differences(AnyBlock::of<B>(), make_run<B, D, D>, 1e-2, seed, true, tally);
      }
    });
  }
  EXPECT_GT(tally.compared, tally.kinks);
}

}  // namespace
}  // namespace hysteron::testing
