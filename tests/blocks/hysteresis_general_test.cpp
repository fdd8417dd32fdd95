// The hysteresis with the effects that the paper's lacks: its differential equation in fine steps, a bank of play
// operators for the return points, and the same from primitives.
#include "blocks/hysteresis_general.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "blocks/m_general.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

using GeneralParams = HysteresisGeneral::Params<double>;

GeneralParams loop_params() {
  auto params = presets<GeneralParams>();
  params.C1 = 1.0;
  params.C2 = 0.8;
  params.C3 = 0.7;
  return params;
}

/// A path through random targets between −1 and 1, in straight lines of about `step`.
std::vector<double> path_through_targets(std::uint64_t seed, int targets, double step) {
  RandomIo random(seed, 1.0);
  std::vector<double> path{0.0};
  for (int i = 0; i < targets; ++i) {
    const double from = path.back();
    const double to = 2.0 * random.unit() - 1.0;
    const int count = 1 + static_cast<int>(std::fabs(to - from) / step);
    for (int k = 1; k <= count; ++k) {
      path.push_back(from + (to - from) * k / count);
    }
  }
  return path;
}

/// dy/dx of the loop in `fine` midpoint steps a sample, with reversals found from the sign of the change.
class SteppedLoop {
 public:
  SteppedLoop(const GeneralParams& params, double ts) : p_(params), ts_(ts) {}
  double operator()(double x) {
    const double sign = x < x_ ? -1.0 : (x > x_ ? 1.0 : sign_);
    if (sign * sign_ < 0.0) {
      start_ = x_;
      skeleton_ = false;
    }
    sign_ = sign;
    const double decades = std::log10(1.0 + std::fabs(x - x_) / ts_ / p_.RATE_REFERENCE);
    const double faster = first_ ? 1.0 : 1.0 + p_.RATE * decades;
    const double h = (x - x_) / fine;
    for (int j = 0; j < fine; ++j) {
      y_ += h * slope(x_ + (j + 0.5) * h, sign, faster);
      const double beta = (1.0 - 0.5 * p_.BOUC_WEN_SKEW) / p_.BOUC_WEN_TRAVEL;
      const double gamma = 0.5 * p_.BOUC_WEN_SKEW / p_.BOUC_WEN_TRAVEL;
      const double half = z_ + 0.5 * (h - beta * std::fabs(h) * z_ - gamma * h * std::fabs(z_));
      const double change = h - beta * std::fabs(h) * half - gamma * h * std::fabs(half);
      z_ += change;
      y_ += p_.BOUC_WEN * p_.C1 * change;
    }
    x_ = x;
    first_ = false;
    return y_;
  }

 private:
  static constexpr int fine = 400;
  [[nodiscard]] double slope(double x, double sign, double faster) const {
    const double d = x - start_;
    const double p = std::fabs(d) * (skeleton_ ? 2.0 : 1.0);
    const double exponent = p_.C3 + sign * p_.ASYMMETRY_EXPONENT;
    const double growth = p_.C2 * (1.0 + sign * p_.ASYMMETRY) * faster * std::pow(p, exponent) /
                          std::pow(p_.ASYMMETRY_REFERENCE, sign * p_.ASYMMETRY_EXPONENT);
    const double z = p / p_.SHAPE_DEPTH;
    const double bend = p_.SHAPE * p_.C1 * -std::expm1(-z);
    const double bend_chord = z > 0.0 ? p_.SHAPE * p_.C1 * (1.0 + std::expm1(-z) / z) : 0.0;
    const double by_middle = p_.BIAS / p_.BIAS_REFERENCE;
    const double rise = d * (p_.C1 + growth / (exponent + 1.0) + bend_chord);
    const double plain = p_.C2 * std::pow(p, p_.C3);
    return (p_.C1 + growth + bend) * (1.0 + by_middle * (0.5 * (x + start_) - p_.U0)) + rise * by_middle / 2.0 +
           (x - p_.U0) *
               (p_.DUHEM / p_.DUHEM_REFERENCE * (p_.C1 + plain) + p_.HARDENING / p_.HARDENING_REFERENCE * plain);
  }
  GeneralParams p_;
  double ts_;
  double x_ = 0.0;
  double y_ = 0.0;
  double z_ = 0.0;
  double start_ = 0.0;
  double sign_ = 0.0;
  bool skeleton_ = true;
  bool first_ = true;
};

void expect_stepped(const GeneralParams& params, std::uint64_t seed) {
  const double ts = 0.01;
  Stepper<HysteresisGeneral> block(ts, params);
  SteppedLoop second(params, ts);
  double x_before = 0.0;
  auto before = block({.XIN = 0.0, .R1 = false});
  int on_branch = 0;
  for (const double x : path_through_targets(seed, 25, 0.03)) {
    const auto out = block({.XIN = x, .R1 = false});
    ASSERT_NEAR(out.XOUT, second(x), 2e-5) << "at " << x;
    on_branch = out.Q ? 0 : on_branch + 1;
    if (on_branch > 2) {
      EXPECT_NEAR(0.5 * (out.SLOPE + before.SLOPE), (out.XOUT - before.XOUT) / (x - x_before), 0.03);
    }
    x_before = x;
    before = out;
  }
}

TEST(HysteresisGeneral, EachEffectIsItsDifferentialEquation) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    auto params = loop_params();
    params.ASYMMETRY = 0.3;
    expect_stepped(params, seed);
    params = loop_params();
    params.ASYMMETRY_EXPONENT = 0.25;
    params.ASYMMETRY_REFERENCE = 0.6;
    expect_stepped(params, seed);
    params = loop_params();
    params.RATE = 0.2;
    params.RATE_REFERENCE = 0.5;
    expect_stepped(params, seed);
    params = loop_params();
    params.BIAS = 0.25;
    params.BIAS_REFERENCE = 0.8;
    expect_stepped(params, seed);
    params = loop_params();
    params.DUHEM = 0.3;
    params.DUHEM_REFERENCE = 0.7;
    expect_stepped(params, seed);
    params = loop_params();
    params.HARDENING = 0.4;
    params.HARDENING_REFERENCE = 0.7;
    expect_stepped(params, seed);
    params = loop_params();
    params.SHAPE = -0.3;
    params.SHAPE_DEPTH = 0.4;
    expect_stepped(params, seed);
    for (const double skew : {0.0, 0.6, 0.9}) {
      params = loop_params();
      params.BOUC_WEN = -0.4;
      params.BOUC_WEN_TRAVEL = 0.25;
      params.BOUC_WEN_SKEW = skew;
      expect_stepped(params, seed);
    }
  }
}

TEST(HysteresisGeneral, SoAreAllTogether) {
  for (std::uint64_t seed = 5; seed <= 10; ++seed) {
    auto params = loop_params();
    params.ASYMMETRY = -0.2;
    params.RATE = 0.1;
    params.RATE_REFERENCE = 2.0;
    params.BIAS = -0.3;
    params.DUHEM = 0.15;
    params.HARDENING = -0.2;
    params.ASYMMETRY_EXPONENT = -0.15;
    params.SHAPE = 0.4;
    params.SHAPE_DEPTH = 0.7;
    params.BOUC_WEN = 0.2;
    params.BOUC_WEN_TRAVEL = 0.5;
    expect_stepped(params, seed);
  }
}

TEST(HysteresisGeneral, ALoopClosesWithBiasAndWithShape) {
  auto params = loop_params();
  params.BIAS = 0.4;
  params.SHAPE = 0.4;
  params.START = 1;
  Stepper<HysteresisGeneral> block(1.0, params);
  double rise_low = 0.0;
  double rise_high = 0.0;
  for (const double middle : {-2.0, 2.0}) {
    block({.XIN = middle - 0.5, .R1 = false});
    double top = 0.0;
    double bottom = 0.0;
    for (int cycle = 0; cycle < 4; ++cycle) {
      const double top_now = block({.XIN = middle + 0.5, .R1 = false}).XOUT;
      const double bottom_now = block({.XIN = middle - 0.5, .R1 = false}).XOUT;
      if (cycle > 1) {
        EXPECT_NEAR(top_now, top, 1e-13);
        EXPECT_NEAR(bottom_now, bottom, 1e-13);
      }
      top = top_now;
      bottom = bottom_now;
    }
    (middle < 0.0 ? rise_low : rise_high) = top - bottom;
  }
  EXPECT_NEAR(rise_low / rise_high, (1.0 - 0.4 * 2.0) / (1.0 + 0.4 * 2.0), 1e-12) << "equal loops differ with bias";
}

TEST(HysteresisGeneral, WithDuhemsBiasALoopWandersByWhatItsTwoWaysDiffer) {
  // Up from a to b and down again: h times the difference of the integrals of M(p)·u, 2·h·C2·L^(C3+2)·(1/(C3+2) −
  // 1/(2·(C3+1))) where the middle is 0 and L = b − a.
  auto params = loop_params();
  params.DUHEM = 0.2;
  params.START = 1;
  params.U0 = 0.0;
  Stepper<HysteresisGeneral> block(1.0, params);
  double before = 0.0;
  for (int cycle = 0; cycle < 4; ++cycle) {
    block({.XIN = 0.5, .R1 = false});
    const double bottom = block({.XIN = -0.5, .R1 = false}).XOUT;
    if (cycle > 1) {
      const double wander = 2.0 * params.DUHEM * params.C2 * (1.0 / (params.C3 + 2.0) - 0.5 / (params.C3 + 1.0));
      EXPECT_NEAR(bottom - before, wander, 1e-13);
    }
    before = bottom;
  }
}

/// Return points as a bank of play operators: with C3 = 1 the loop C1·p + C2·p²/2 is C1·x and plays of all widths 2r,
/// of the density 2·C2.
class PlayBank {
 public:
  PlayBank(double c1, double c2) : c1_(c1), c2_(c2), plays_(count, 0.0) {}
  double operator()(double x) {
    double y = c1_ * x;
    for (int i = 0; i < count; ++i) {
      const double r = (i + 0.5) / count;
      double& play = plays_[static_cast<std::size_t>(i)];
      play = std::clamp(play, x - r, x + r);
      y += 2.0 * c2_ / count * play;
    }
    return y;
  }

 private:
  static constexpr int count = 4000;
  double c1_;
  double c2_;
  std::vector<double> plays_;
};

TEST(HysteresisGeneral, ReturnPointsAreABankOfPlays) {
  auto params = presets<GeneralParams>();
  params.C1 = 0.5;
  params.C2 = 1.5;
  params.RETURN_POINT = 1.0;
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    for (const double step : {0.05, 3.0}) {  // also from target to target in one sample
      Stepper<HysteresisGeneral> block(1.0, params);
      auto paper_params = params;
      paper_params.RETURN_POINT = 0.0;
      Stepper<HysteresisGeneral> paper(1.0, paper_params);
      PlayBank bank(params.C1, params.C2);
      for (const double x : path_through_targets(seed, 60, step)) {
        const double y = block({.XIN = x, .R1 = false}).XOUT;
        ASSERT_NEAR(y, bank(x), 1e-5) << "seed " << seed << " at " << x;
        most = std::max(most, std::fabs(paper({.XIN = x, .R1 = false}).XOUT - y));
      }
    }
  }
  EXPECT_GT(most, 0.1) << "the paper's memory differs";
}

TEST(HysteresisGeneral, NestedLoopsCloseFromTheInnermostToTheSkeleton) {
  auto params = presets<GeneralParams>();
  params.C2 = 1.0;
  params.RETURN_POINT = 1.0;
  Stepper<HysteresisGeneral> block(1.0, params);
  PlayBank bank(params.C1, params.C2);
  for (const double x :
       {0.9, -0.8, 0.7, -0.6, 0.5, -0.4, 0.3, -0.2, 0.25, 0.4, -0.5, 0.65, 0.85, -0.85, 0.8, -1.0, 1.0}) {
    EXPECT_NEAR(block({.XIN = x, .R1 = false}).XOUT, bank(x), 1e-5) << "at " << x;
  }
}

TEST(HysteresisGeneral, TheNinthNestingForgetsTheInnermostLoopOnly) {
  auto params = presets<GeneralParams>();
  params.C2 = 1.0;
  params.RETURN_POINT = 1.0;
  Stepper<HysteresisGeneral> block(1.0, params);
  PlayBank bank(params.C1, params.C2);
  double size = 1.0;
  for (int i = 0; i < 15; ++i) {
    block({.XIN = size, .R1 = false});
    bank(size);
    size *= -0.8;
  }
  EXPECT_LE(block.state.STARTS, 8);
  for (const double x : {0.66, -0.7, 0.85, -0.9, 1.0}) {
    EXPECT_NEAR(block({.XIN = x, .R1 = false}).XOUT, bank(x), 1e-5) << "the large loops are remembered, at " << x;
  }
}

TEST(HysteresisGeneral, BetweenTheTwoMemoriesTheOutputIsABlend) {
  auto params = loop_params();
  std::vector<std::vector<double>> outputs;
  for (const double blend : {0.0, 0.3, 1.0}) {
    params.RETURN_POINT = blend;
    Stepper<HysteresisGeneral> block(1.0, params);
    auto& y = outputs.emplace_back();
    for (const double x : path_through_targets(2, 40, 0.1)) {
      y.push_back(block({.XIN = x, .R1 = false}).XOUT);
    }
  }
  for (std::size_t i = 0; i < outputs[0].size(); ++i) {
    EXPECT_NEAR(outputs[1][i], 0.7 * outputs[0][i] + 0.3 * outputs[2][i], 1e-12);
  }
}

TEST(HysteresisGeneral, ResetBeginsAgainWithReturnPointsToo) {
  auto params = loop_params();
  params.RETURN_POINT = 1.0;
  params.RATE = 0.3;
  params.ASYMMETRY = 0.1;
  Stepper<HysteresisGeneral> used(1.0, params);
  for (const double x : path_through_targets(3, 20, 0.1)) {
    used({.XIN = x, .R1 = false});
  }
  Stepper<HysteresisGeneral> fresh(1.0, params);
  bool first = true;
  for (const double x : path_through_targets(4, 20, 0.1)) {
    EXPECT_EQ(used({.XIN = x, .R1 = first}).XOUT, fresh({.XIN = x, .R1 = false}).XOUT);
    first = false;
  }
}

TEST(SlopeMGeneral, FromPrimitivesItIsTheSameHysteresis) {
  // Rate, momentum and integral by Euler's rule in fine steps; the branch begins at 0 upwards.
  auto params = loop_params();
  params.START = 1;
  params.ASYMMETRY = 0.2;
  params.RATE = 0.1;
  params.RATE_REFERENCE = 0.3;
  params.BIAS = 0.3;
  params.DUHEM = -0.2;
  params.HARDENING = 0.15;
  params.ASYMMETRY_EXPONENT = 0.1;
  params.SHAPE = 0.3;
  params.SHAPE_DEPTH = 0.6;
  const double ts = 1e-5;
  Stepper<HysteresisGeneral> closed(ts, params);
  auto slope_params = presets<SlopeMGeneral::Params<double>>();
  slope_params.C1 = params.C1;
  slope_params.C2 = params.C2;
  slope_params.C3 = params.C3;
  slope_params.ASYMMETRY = params.ASYMMETRY;
  slope_params.RATE = params.RATE;
  slope_params.RATE_REFERENCE = params.RATE_REFERENCE;
  slope_params.BIAS = params.BIAS;
  slope_params.DUHEM = params.DUHEM;
  slope_params.HARDENING = params.HARDENING;
  slope_params.ASYMMETRY_EXPONENT = params.ASYMMETRY_EXPONENT;
  slope_params.SHAPE = params.SHAPE;
  slope_params.SHAPE_DEPTH = params.SHAPE_DEPTH;
  Stepper<SlopeMGeneral> slope(ts, slope_params);
  // Up to 1 and down to −0.5 at the rate 1, up to 0.5 at the rate 3.
  double x = 0.0;
  double y = 0.0;
  double p = 0.0;
  double last_rate = 1.0;
  closed({.XIN = 0.0, .R1 = false});
  for (int k = 0; k < 280'000; ++k) {
    const double rate = k < 100'000 ? 1.0 : (k < 250'000 ? -1.0 : 3.0);
    const bool turned = rate * last_rate < 0.0;
    last_rate = rate;
    y += ts * slope({.XIN = rate, .P = p, .R1 = turned}).XOUT;
    p = (turned ? 0.0 : p) + ts * std::fabs(rate);
    x += ts * rate;
    const double expected = closed({.XIN = x, .R1 = false}).XOUT;
    if (k % 1000 == 0) {
      ASSERT_NEAR(y, expected, 5e-5) << "at " << x;
    }
  }
}

}  // namespace
}  // namespace hysteron::testing
