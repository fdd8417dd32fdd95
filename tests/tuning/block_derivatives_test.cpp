// Dual against differences: the derivative that a block gives with dual numbers is the slope of what it computes.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "blocks/catalogue.hpp"
#include "tests/blocks/random_io.hpp"
#include "tuning/dual.hpp"

namespace hysteron::testing {
namespace {

using D = Dual<1>;

/// The last real outputs of a block after some steps, with one real number of parameters or inputs displaced.
template <class B, class S>
std::vector<S> run(double ts, std::uint64_t seed, std::size_t which, const S& displacement, bool neutral) {
  RandomIo random(seed, ts);
  auto plain = random.make<typename B::template Params<double>>();
  if (neutral) {
    neutralise(plain);
  }
  auto params = convert<typename B::template Params<S>>(plain);
  std::size_t counter = 0;
  const auto displace = [&](auto& member) {
    if constexpr (std::is_same_v<std::remove_reference_t<decltype(member)>, S>) {
      if (counter++ == which) {
        member = member + displacement;
      }
    }
  };
  B::template Params<S>::fields().apply([&](const auto&... field) { (displace(params.*(field.member)), ...); });
  const std::size_t after_params = counter;
  typename B::template State<S> state{};
  if constexpr (HasMemory<B>) {
    state = B::initial(params);
  }
  std::vector<S> results;
  for (int k = 0; k < 12; ++k) {
    auto in = convert<typename B::template In<S>>(random.make<typename B::template In<double>>());
    counter = after_params;
    B::template In<S>::fields().apply([&](const auto&... field) { (displace(in.*(field.member)), ...); });
    const auto out = B::output(params, state, in, S(ts));
    if constexpr (HasMemory<B>) {
      B::update(params, state, in, out, S(ts));
    }
    const auto collect = [&](const auto& member) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(member)>, S>) {
        results.push_back(member);
      }
    };
    B::template Out<S>::fields().apply([&](const auto&... field) { (collect(out.*(field.member)), ...); });
  }
  return results;
}

template <class Struct>
std::size_t real_members() {
  std::size_t count = 0;
  Struct::fields().apply([&](const auto&... field) {
    ((count +=
      std::is_same_v<std::remove_cvref_t<decltype(std::declval<Struct&>().*(field.member))>, double> ? 1U : 0U),
     ...);
  });
  return count;
}

struct Tally {
  int compared = 0;
  int kinks = 0;
};

// A difference quotient is compared where the function is smooth there: two quotients of different width agree.
template <class B>
void hold_dual_against_differences(double ts, std::uint64_t seed, bool neutral, Tally& tally) {
  const std::size_t numbers =
      real_members<typename B::template Params<double>>() + real_members<typename B::template In<double>>();
  for (std::size_t which = 0; which < numbers; ++which) {
    const auto exact = run<B, D>(ts, seed, which, D::variable(0.0, 0), neutral);
    const auto here = run<B, double>(ts, seed, which, 0.0, neutral);
    std::array<std::vector<double>, 4> at;
    constexpr std::array<double, 4> step{1e-6, -1e-6, 2e-6, -2e-6};
    for (std::size_t i = 0; i < 4; ++i) {
      at[i] = run<B, double>(ts, seed, which, step[i], neutral);
    }
    for (std::size_t i = 0; i < here.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(exact[i].value()), std::bit_cast<std::uint64_t>(here[i]))
          << B::about.name << ": the value of a dual is the plain value";
      ASSERT_FALSE(std::isnan(exact[i].derivative(0))) << B::about.name << " member " << which << " seed " << seed;
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
          << B::about.name << " real member " << which << " seed " << seed << " result " << i
          << (neutral ? " neutral" : "");
    }
  }
}

TEST(Dual, EveryBlocksDerivativeIsTheSlopeOfItsOutputs) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Catalogue::for_each([&]<class B> { hold_dual_against_differences<B>(1e-2, seed, false, tally); });
  }
  EXPECT_GT(tally.compared, 20 * tally.kinks) << "nearly all points are smooth";
}

TEST(Dual, AlsoAtNeutralSettingsWhereEffectsBegin) {
  Tally tally;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Catalogue::for_each([&]<class B> {
      if constexpr (!B::about.effect.empty()) {
        hold_dual_against_differences<B>(1e-2, seed, true, tally);
      }
    });
  }
  EXPECT_GT(tally.compared, tally.kinks);
}

}  // namespace
}  // namespace hysteron::testing
