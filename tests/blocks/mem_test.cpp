// The general MEM element: the memristor and the MEM damper of the paper's Examples 2 and 3, and Theorem 6.
#include "blocks/mem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "blocks/m_table.hpp"
#include "blocks/mem_inverse.hpp"
#include "blocks/momentum.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

/// A memristor whose resistance grows with the charge: R(q) = 100 Ω + 2e4 Ω/C·q.
constexpr Mem::Params<double> memristor{.C1 = 100.0, .C2 = 2e4, .C3 = 1.0, .G = 1};
constexpr double amplitude = 1e-2;  // A

TEST(Mem, MemristorUnderASineIsTheClosedForm) {
  const double ts = 1e-4;
  const double w = 2.0 * std::numbers::pi * 10.0;
  Stepper<Mem> block(ts, memristor);
  for (int k = 0; k < 5000; ++k) {
    const double current = amplitude * std::sin(w * k * ts);
    const auto out = block({.XIN = current, .R1 = false, .P0 = 0.0});
    // Forward Euler sums to (Lagrange) TS·A·sin((k−1)φ/2)·sin(kφ/2)/sin(φ/2), φ = ωTS …
    const double half = w * ts / 2;
    const double charge = ts * amplitude * std::sin((k - 1) * half) * std::sin(k * half) / std::sin(half);
    EXPECT_NEAR(out.P, charge, 1e-15);
    EXPECT_NEAR(out.XOUT, (100.0 + 2e4 * charge) * current, 1e-12);
    // … which lies within TS·A of the continuous charge A/ω·(1 − cos ωt).
    EXPECT_NEAR(out.P, amplitude / w * (1.0 - std::cos(w * k * ts)), ts * amplitude);
  }
}

/// The signed area of one lobe of the voltage-current loop, over the first half period.
double lobe_area(double frequency) {
  const int samples = 20000;
  const double ts = 0.5 / frequency / samples;
  Stepper<Mem> block(ts, memristor);
  double area = 0.0;
  double last_voltage = 0.0;
  double last_current = 0.0;
  for (int k = 0; k <= samples; ++k) {
    const double current = amplitude * std::sin(std::numbers::pi * k / samples);
    const double voltage = block({.XIN = current, .R1 = false, .P0 = 0.0}).XOUT;
    area += 0.5 * (voltage + last_voltage) * (current - last_current);
    last_voltage = voltage;
    last_current = current;
  }
  return area;
}

TEST(Mem, LobesOfTheMemristorAreTheClosedFormAndShrinkWithFrequency) {
  // ∮ v di over half a period = −2/3·C2·A³/ω
  for (const double frequency : {1.0, 10.0, 100.0}) {
    const double w = 2.0 * std::numbers::pi * frequency;
    const double expected = -2.0 / 3.0 * 2e4 * std::pow(amplitude, 3) / w;
    EXPECT_NEAR(lobe_area(frequency), expected, 1e-3 * std::fabs(expected));
  }
}

TEST(Mem, TheLoopIsPinched) {
  RandomIo random(1, 1e-3);
  for (const std::int32_t g : {0, 1}) {
    Stepper<Mem> block(1e-3, {.C1 = 1.0, .C2 = 5.0, .C3 = 1.3, .G = g});
    for (int k = 0; k < 1000; ++k) {
      const double u = k % 3 == 0 ? 0.0 : random.unit() - 0.5;
      const auto out = block({.XIN = u, .R1 = false, .P0 = 0.0});
      EXPECT_EQ(out.XOUT == 0.0, u == 0.0) << "zero crossing: output 0 where the input is 0, whatever the momentum";
    }
  }
}

TEST(Mem, PositionOfAMemDamperIsAFunctionOfItsMomentum) {
  // Example 3 with a measured φ(P): v = φ(P)·F, so that x = ∫v dt = Φ(P) = ∫φ dP, whatever the force did in between.
  const double ts = 1e-5;
  SlopeTableParams<double> table{};
  table.P_TABLE = {0.0, 0.5, 1.0};
  table.M_TABLE = {3.0, 1.0, 0.8};
  table.COUNT = 3;
  const auto position_of = [](double p) {
    return p <= 0.5 ? 3.0 * p - 2.0 * p * p : 1.0 + (p - 0.5) - 0.2 * (p - 0.5) * (p - 0.5);
  };
  Stepper<Momentum> momentum(ts, {.G = 1});
  Stepper<SlopeMTable> damper(ts, table);
  double position = 0.0;
  double worst = 0.0;
  for (int k = 0; k < 200000; ++k) {
    const double t = k * ts;
    const double force = 1.4 * std::sin(3.0 * t) + 0.5 * std::sin(11.0 * t);
    const double p = momentum({.XIN = force, .R1 = false, .P0 = 0.0}).XOUT;
    worst = std::max(worst, std::fabs(position - position_of(p)));
    position += ts * damper({.XIN = force, .P = p, .R1 = false}).XOUT;
  }
  // A left Riemann sum: TS/2·∫|φ'|·F² dt at most.
  EXPECT_LT(worst, 0.5 * ts * 2.0 * 4.0 * 1.9 * 1.9);
  EXPECT_GT(position_of(momentum.state.SUM), 0.1) << "the damper moved";
}

TEST(MemInverse, UndoesTheElement) {
  for (const std::int32_t g : {0, 1}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      RandomIo random(seed, 1e-3);
      const double c1 = 2.0 + random.unit();
      const double c2 = 3.0 * random.unit();
      const double c3 = g == 0 ? 3.0 * random.unit() : 1.0;
      Stepper<Mem> element(1e-3, {.C1 = c1, .C2 = c2, .C3 = c3, .G = g});
      Stepper<MemInverse> feedforward(1e-3, {.C1 = c1, .C2 = c2, .C3 = c3, .G = g});
      for (int k = 0; k < 2000; ++k) {
        // Theorem 6: the element driven by the feedforward gives the wanted output.
        const double wanted = std::sin(0.01 * k) + 0.2 * random.unit();
        const bool reset = random.unit() < 0.01;
        const auto drive = feedforward({.XIN = wanted, .R1 = reset, .P0 = 0.0});
        ASSERT_FALSE(drive.ERROR);
        ASSERT_NEAR(element({.XIN = drive.XOUT, .R1 = reset, .P0 = 0.0}).XOUT, wanted, 1e-12);
      }
    }
  }
}

TEST(MemInverse, OfALinearDamperIsViscousFrictionFeedforward) {
  // Remark 7: M = φ constant gives F = v/φ.
  Stepper<MemInverse> block(1e-3, {.C1 = 4.0, .C2 = 0.0, .C3 = 1.0, .G = 1});
  for (const double v : {1.0, -2.0, 0.0, 8.0}) {
    EXPECT_EQ(block({.XIN = v, .R1 = false, .P0 = 0.0}).XOUT, v / 4.0);
  }
}

TEST(MemInverse, SaysWhereThereIsNone) {
  Stepper<MemInverse> block(1.0, {.C1 = 1.0, .C2 = -1.0, .C3 = 1.0, .G = 0});
  EXPECT_EQ(block({.XIN = 2.0, .R1 = false, .P0 = 0.0}).XOUT, 2.0);
  for (int k = 0; k < 3; ++k) {
    const auto out = block({.XIN = 2.0, .R1 = false, .P0 = 0.0});
    EXPECT_TRUE(out.ERROR);
    EXPECT_EQ(out.ERRORID, fault::slope_not_positive);
    EXPECT_EQ(out.XOUT, 0.0);
    EXPECT_EQ(out.P, 2.0) << "an element that gets no input keeps its momentum";
  }
  EXPECT_FALSE(block({.XIN = 2.0, .R1 = true, .P0 = 0.0}).ERROR);
}

}  // namespace
}  // namespace hysteron::testing
