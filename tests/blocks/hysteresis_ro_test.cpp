// The Ramberg-Osgood hysteresis in closed form and its inverse: the paper's Example 1, the paper's own formula as a
// second implementation, starts, dead band, and a million steps without drift.
#include "blocks/hysteresis_ro.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "blocks/hysteresis_ro_inverse.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

using RoParams = HysteresisRo::Params<double>;

/// Equations (2) and (3) as the paper prints them, in long double, with reversals found from the sign of the change.
class PrintedModel {
 public:
  PrintedModel(double y_star, double u_star, double alpha, double gamma)
      : y_star_(y_star), u_star_(u_star), alpha_(alpha), gamma_(gamma) {}
  long double operator()(long double u) {
    const int sign = u > u_ ? 1 : (u < u_ ? -1 : sign_);
    if (sign * sign_ < 0) {
      branching_ = true;
      u_i_ = u_;
      y_i_ = y_;
    }
    sign_ = sign;
    u_ = u;
    y_ = branching_ ? y_i_ + 2 * y_star_ * curve((u - u_i_) / (2 * u_star_)) : y_star_ * curve(u / u_star_);
    return y_;
  }

 private:
  [[nodiscard]] long double curve(long double x) const { return x * (1 + alpha_ * std::pow(std::fabs(x), gamma_ - 1)); }
  long double y_star_;
  long double u_star_;
  long double alpha_;
  long double gamma_;
  long double u_ = 0;
  long double y_ = 0;
  long double u_i_ = 0;
  long double y_i_ = 0;
  int sign_ = 0;
  bool branching_ = false;
};

RoParams from_ramberg_osgood(double y_star, double u_star, double alpha, double gamma) {
  auto params = presets<RoParams>();
  params.C1 = y_star / u_star;
  params.C2 = params.C1 * alpha * gamma / std::pow(2.0 * u_star, gamma - 1.0);
  params.C3 = gamma - 1.0;
  return params;
}

HysteresisRoInverse::Params<double> inverse_of(const RoParams& p) {
  return {.C1 = p.C1, .C2 = p.C2, .C3 = p.C3, .EPS = 0.0, .START = p.START, .U0 = p.U0, .Y0 = p.Y0};
}

/// A random path between −1 and 1: runs of random length and step, with plateaus and small loops inside large ones.
class RandomPath {
 public:
  explicit RandomPath(std::uint64_t seed) : random_(seed, 1.0) {}
  double operator()() {
    if (left_ == 0) {
      left_ = 1 + static_cast<int>(30.0 * random_.unit() * random_.unit());
      step_ = random_.unit() < 0.1 ? 0.0 : 0.2 * (2.0 * random_.unit() - 1.0);
    }
    --left_;
    x_ = std::clamp(x_ + step_ * random_.unit(), -1.0, 1.0);
    return x_;
  }

 private:
  RandomIo random_;
  double x_ = 0.0;
  double step_ = 0.0;
  int left_ = 0;
};

/// The input (4) of the paper's Example 1.
double example_1(double t) {
  const double sine = std::sin(2.0 * std::numbers::pi * t);
  return t <= 1.75 ? 250.0 * sine : 125.0 * sine - 125.0;
}

TEST(HysteresisRo, ExampleOneOfThePaper) {
  // α reconciled, 8.0e-9/(y*/u*): range ±1.6125 µm, and the loop crosses u = 0 at ±0.5 µm (Figs. 2 and 3).
  const double alpha = 8.0e-9 / (1.225e-6 / 500.0);
  Stepper<HysteresisRo> block(1e-3, from_ramberg_osgood(1.225e-6, 500.0, alpha, 2.0));
  std::vector<double> y;
  int reversals = 0;
  for (int k = 0; k <= 2500; ++k) {
    const auto out = block({.XIN = example_1(k * 1e-3), .R1 = false});
    y.push_back(out.XOUT);
    reversals += out.Q ? 1 : 0;
  }
  EXPECT_NEAR(y[250], 1.6125e-6, 1e-11);
  EXPECT_NEAR(y[750], -1.6125e-6, 1e-11);
  EXPECT_NEAR(y[500], 0.5e-6, 1e-11);
  EXPECT_NEAR(y[1000], -0.5e-6, 1e-11);
  EXPECT_EQ(reversals, 5);  // at 0.25, 0.75, 1.25, 1.75 and 2.25 s
}

TEST(HysteresisRo, ExampleOneAsPrintedIsAStraightLine) {
  Stepper<HysteresisRo> block(1e-3, from_ramberg_osgood(1.225e-6, 500.0, 8.0e-9, 2.0));
  for (int k = 0; k <= 2500; ++k) {
    const double u = example_1(k * 1e-3);
    EXPECT_NEAR(block({.XIN = u, .R1 = false}).XOUT, u * 1.225e-6 / 500.0, 1e-8 * 1.225e-6);
  }
}

TEST(HysteresisRo, IsThePrintedModelOnRandomPaths) {
  RandomIo random(5, 1.0);
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const double y_star = std::pow(10.0, 4.0 * random.unit() - 2.0);
    const double alpha = 5.0 * random.unit();
    const double gamma = 1.0 + 3.0 * random.unit();
    Stepper<HysteresisRo> block(1.0, from_ramberg_osgood(y_star, 1.0, alpha, gamma));
    PrintedModel printed(y_star, 1.0, alpha, gamma);
    const double range = 2.0 * y_star * (1.0 + alpha);
    RandomPath path(seed);
    for (int k = 0; k < 3000; ++k) {
      const double u = path();
      ASSERT_NEAR(block({.XIN = u, .R1 = false}).XOUT, static_cast<double>(printed(u)), 1e-12 * range) << "step " << k;
    }
  }
}

TEST(HysteresisRo, SlopeIsThatOfTheLoopAndOfTheMomentum) {
  auto params = presets<RoParams>();
  params.C1 = 0.3;
  params.C2 = 1.7;
  params.C3 = 1.4;
  const double h = 1e-6;
  Stepper<HysteresisRo> block(1.0, params);
  RandomPath path(8);
  double last = 0.0;
  for (int k = 0; k < 500; ++k) {
    const double u = path();
    const auto out = block({.XIN = u, .R1 = false});
    EXPECT_NEAR(out.SLOPE, 0.3 + 1.7 * std::pow(out.P, 1.4), 1e-12);
    if (u != last) {
      // A small step onwards from here, on a copy of the block.
      auto onwards = block;
      const double step = u > last ? h : -h;
      const double middle = onwards({.XIN = u + 0.5 * step, .R1 = false}).SLOPE;
      const double rise = onwards({.XIN = u + step, .R1 = false}).XOUT - out.XOUT;
      EXPECT_NEAR(rise / step, middle, 1e-7);
    }
    last = u;
  }
}

TEST(HysteresisRo, LoopsCloseAndAreSymmetric) {
  auto params = presets<RoParams>();
  params.C2 = 2.0;
  params.C3 = 0.6;
  Stepper<HysteresisRo> block(1.0, params);
  const double up = block({.XIN = 1.0, .R1 = false}).XOUT;
  const double down = block({.XIN = -1.0, .R1 = false}).XOUT;
  EXPECT_NEAR(down, -up, 1e-15) << "the branch from the tip of the skeleton meets the skeleton at the other tip";
  EXPECT_NEAR(block({.XIN = 1.0, .R1 = false}).XOUT, up, 1e-15);
  // Energy lost in a loop between ±a: ∮ y du = 2·∫ (mean of the branches) … = C2·(2a)^(C3+2)·C3/((C3+1)(C3+2))
  const int samples = 200000;
  double loss = 0.0;
  double last_u = 1.0;
  double last_y = up;
  for (int k = 1; k <= 2 * samples; ++k) {
    const double u = k <= samples ? 1.0 - 2.0 * k / samples : -3.0 + 2.0 * k / samples;
    const double y = block({.XIN = u, .R1 = false}).XOUT;
    loss += 0.5 * (u + last_u) * (y - last_y);
    last_u = u;
    last_y = y;
  }
  const double expected = 2.0 * std::pow(2.0, 2.6) * 0.6 / (1.6 * 2.6);
  EXPECT_NEAR(std::fabs(loss), expected, 1e-8);
}

TEST(HysteresisRo, WithoutGrowthIsALine) {
  auto params = presets<RoParams>();
  params.C1 = 3.0;
  Stepper<HysteresisRo> block(1.0, params);
  Stepper<HysteresisRoInverse> inverse(1.0, inverse_of(params));
  RandomPath path(2);
  for (int k = 0; k < 1000; ++k) {
    const double u = path();
    EXPECT_NEAR(block({.XIN = u, .R1 = false}).XOUT, 3.0 * u, 1e-13);
    EXPECT_NEAR(inverse({.XIN = 3.0 * u, .R1 = false}).XOUT, u, 1e-13);
  }
}

TEST(HysteresisRo, IsContinuousInTheExponentAtZero) {
  for (const double c3 : {0.0, 1e-13}) {
    auto params = presets<RoParams>();
    params.C2 = 2.0;
    params.C3 = c3;
    Stepper<HysteresisRo> block(1.0, params);
    RandomPath path(3);
    for (int k = 0; k < 300; ++k) {
      const double u = path();
      EXPECT_NEAR(block({.XIN = u, .R1 = false}).XOUT, 3.0 * u, 1e-11);
    }
  }
}

TEST(HysteresisRo, StartsInTheMiddleOfALoop) {
  auto params = presets<RoParams>();
  params.C2 = 1.5;
  params.C3 = 1.2;
  Stepper<HysteresisRo> whole(1.0, params);
  const double y_turn = whole({.XIN = 1.0, .R1 = false}).XOUT;
  whole({.XIN = 0.9, .R1 = false});

  params.START = -1;
  params.U0 = 1.0;
  params.Y0 = y_turn;
  Stepper<HysteresisRo> middle(1.0, params);
  Stepper<HysteresisRoInverse> inverse(1.0, inverse_of(params));
  for (const double u : {0.4, 0.0, 0.3, 0.2, -0.7, -0.2}) {
    const auto expected = whole({.XIN = u, .R1 = false});
    const auto out = middle({.XIN = u, .R1 = false});
    EXPECT_EQ(out.XOUT, expected.XOUT);
    EXPECT_EQ(out.P, expected.P);
    EXPECT_EQ(out.Q, expected.Q);
    EXPECT_NEAR(inverse({.XIN = out.XOUT, .R1 = false}).XOUT, u, 1e-15);
  }
}

TEST(HysteresisRo, AStartBranchLeftBackwardsIsAReversalAtItsOrigin) {
  auto params = presets<RoParams>();
  params.C2 = 1.0;
  params.START = 1;
  params.U0 = 2.0;
  params.Y0 = 5.0;
  Stepper<HysteresisRo> block(1.0, params);
  const auto out = block({.XIN = 1.0, .R1 = false});
  EXPECT_TRUE(out.Q);
  EXPECT_EQ(out.XOUT, 5.0 - (1.0 + 0.5));
}

TEST(HysteresisRo, AResetBeginsAgain) {
  auto params = presets<RoParams>();
  params.C2 = 1.0;
  Stepper<HysteresisRo> used(1.0, params);
  Stepper<HysteresisRoInverse> used_inverse(1.0, inverse_of(params));
  RandomPath path(4);
  for (int k = 0; k < 100; ++k) {
    const double u = path();
    used({.XIN = u, .R1 = false});
    used_inverse({.XIN = u, .R1 = false});
  }
  Stepper<HysteresisRo> fresh(1.0, params);
  Stepper<HysteresisRoInverse> fresh_inverse(1.0, inverse_of(params));
  for (int k = 0; k < 100; ++k) {
    const double u = path();
    EXPECT_EQ(used({.XIN = u, .R1 = k == 0}).XOUT, fresh({.XIN = u, .R1 = false}).XOUT);
    EXPECT_EQ(used_inverse({.XIN = u, .R1 = k == 0}).XOUT, fresh_inverse({.XIN = u, .R1 = false}).XOUT);
  }
}

TEST(HysteresisRo, DeadBandKeepsADwellOnItsBranch) {
  auto params = presets<RoParams>();
  params.C2 = 2.0;
  params.EPS = 1e-3;
  Stepper<HysteresisRo> block(1.0, params);
  block({.XIN = 1.0, .R1 = false});
  block({.XIN = 0.0, .R1 = false});
  const double held = block({.XIN = 0.5, .R1 = false}).XOUT;
  for (int k = 0; k < 100; ++k) {
    const auto out = block({.XIN = 0.5 - 0.9e-3 * (k % 2), .R1 = false});
    EXPECT_FALSE(out.Q);
    EXPECT_NEAR(out.XOUT, held, 2.0 * 0.9e-3);
    EXPECT_NEAR(out.P, 0.5, 1e-3);
  }
  const auto before = block({.XIN = 0.5 - 0.999e-3, .R1 = false});
  const auto out = block({.XIN = 0.5 - 1.001e-3, .R1 = false});
  EXPECT_TRUE(out.Q);
  EXPECT_LT(std::fabs(out.XOUT - before.XOUT), 1.001e-3 * before.SLOPE) << "the jump is less than EPS*SLOPE";
  EXPECT_GT(std::fabs(out.XOUT - before.XOUT), 0.0);
  EXPECT_NEAR(out.P, 1.001e-3, 1e-12);
}

TEST(HysteresisRoInverse, IsTheIdentityAfterTheHysteresis) {
  RandomIo random(6, 1.0);
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    auto params = presets<RoParams>();
    params.C1 = std::pow(10.0, 8.0 * random.unit() - 9.0);
    params.C2 = params.C1 * std::pow(10.0, 3.0 * random.unit() - 2.0);
    params.C3 = seed % 5 == 0 ? 0.5 * static_cast<double>(seed % 4) : 3.0 * random.unit();
    Stepper<HysteresisRo> block(1.0, params);
    Stepper<HysteresisRoInverse> inverse(1.0, inverse_of(params));
    RandomPath path(seed);
    for (int k = 0; k < 2000; ++k) {
      const double u = path();
      const auto forward = block({.XIN = u, .R1 = false});
      const auto back = inverse({.XIN = forward.XOUT, .R1 = false});
      ASSERT_NEAR(back.XOUT, u, 2.0 * 1e-12) << "step " << k << ", C3 " << params.C3;
      ASSERT_EQ(back.Q, forward.Q);
      ASSERT_NEAR(back.SLOPE, forward.SLOPE, 1e-9 * forward.SLOPE + 1e-3 * params.C2 * std::pow(1e-12, params.C3));
    }
  }
}

TEST(HysteresisRoInverse, TheHysteresisFollowsItsReference) {
  auto params = presets<RoParams>();
  params.C1 = 2.45e-9;
  params.C2 = 1.6e-11;
  Stepper<HysteresisRoInverse> feedforward(1e-3, inverse_of(params));
  Stepper<HysteresisRo> actuator(1e-3, params);
  for (int k = 0; k < 5000; ++k) {
    const double t = k * 1e-3;
    const double reference = 0.8e-6 * std::sin(7.0 * t) + 0.8e-6 * std::sin(19.0 * t);
    const double u = feedforward({.XIN = reference, .R1 = false}).XOUT;
    ASSERT_NEAR(actuator({.XIN = u, .R1 = false}).XOUT, reference, 1e-12 * 3.2e-6);
  }
}

TEST(HysteresisRoInverse, AMillionStepsDoNotDrift) {
  auto params = presets<RoParams>();
  params.C1 = 0.3;
  params.C2 = 1.1;
  params.C3 = 0.7;
  Stepper<HysteresisRo> block(1.0, params);
  Stepper<HysteresisRoInverse> inverse(1.0, inverse_of(params));
  RandomPath path(9);
  double worst = 0.0;
  for (int k = 0; k < 1'000'000; ++k) {
    const double u = path();
    worst = std::max(worst, std::fabs(inverse({.XIN = block({.XIN = u, .R1 = false}).XOUT, .R1 = false}).XOUT - u));
  }
  EXPECT_LT(worst, 2.0 * 1e-12);
}

TEST(LoopInverse, ReachesTheLastDigitsOverAllRanges) {
  // Against the same equation in long double, solved by bisection.
  RandomIo random(7, 1.0);
  for (int k = 0; k < 20000; ++k) {
    const double c3 = k % 7 == 0 ? 10.0 : (k % 7 == 1 ? 0.0 : 10.0 * random.unit());
    const double c1 = std::pow(10.0, 12.0 * random.unit() - 9.0);
    const double p = std::pow(10.0, 6.0 * random.unit() - 3.0);
    // The two terms of Y from far apart to equal.
    const double c2 = c1 / std::pow(p, c3) * std::pow(10.0, 8.0 * random.unit() - 4.0);
    const auto curve = [&](long double x) {
      return x * (c1 + c2 * std::pow(x, static_cast<long double>(c3)) / (c3 + 1.0L));
    };
    const auto q = static_cast<double>(curve(p));
    long double low = 0.9L * p;
    long double high = 1.1L * p;
    for (int i = 0; i < 60; ++i) {
      const long double middle = (low + high) / 2;
      (curve(middle) < q ? low : high) = middle;
    }
    const auto found = loop_inverse<double>({.c1 = c1, .c2 = c2, .c3 = c3}, q);
    ASSERT_NEAR(found, static_cast<double>(low), 5e-16 * p) << "C3 " << c3;
  }
}

TEST(LoopInverse, OfNothingIsNothing) {
  for (const double c2 : {0.0, 1.0}) {
    for (const double c3 : {0.0, 0.3, 0.5, 1.0, 4.0}) {
      EXPECT_EQ((loop_inverse<double>({.c1 = 2.0, .c2 = c2, .c3 = c3}, 0.0)), 0.0);
      EXPECT_EQ((loop_inverse<float>({.c1 = 2.0F, .c2 = static_cast<float>(c2), .c3 = static_cast<float>(c3)}, 0.0F)),
                0.0F);
    }
  }
  EXPECT_EQ((loop_inverse<double>({.c1 = 2.0, .c2 = 0.0, .c3 = 1.7}, 3.0)), 1.5);
}

}  // namespace
}  // namespace hysteron::testing
