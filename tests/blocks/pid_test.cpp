// The PID controller: closed forms of its step and ramp responses, a closed loop, windup, and transfers without a bump.
#include "blocks/pid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

using PidParams = Pid::Params<double>;
using PidIn = Pid::In<double>;

PidParams pi(double kp, double tr) {
  auto params = presets<PidParams>();
  params.KP = kp;
  params.TR = tr;
  return params;
}

PidIn automatic(double pv, double sp) {
  return {.AUTO = true, .PV = pv, .SP = sp, .X0 = 0.0};
}

TEST(Pid, ProportionalAloneIsAGain) {
  Stepper<Pid> controller(0.1, pi(2.5, infinity));
  for (const double sp : {1.0, -3.0, 0.5}) {
    EXPECT_EQ(controller(automatic(0.25, sp)).XOUT, 2.5 * (sp - 0.25));
  }
}

TEST(Pid, StepOfTheErrorGivesTheStepAndTheRampOfAPi) {
  const double ts = 0.01;
  Stepper<Pid> controller(ts, pi(2.0, 0.5));
  for (int k = 0; k < 1000; ++k) {
    // Backward Euler: after step k the integral has seen k + 1 samples.
    EXPECT_NEAR(controller(automatic(0.0, 3.0)).XOUT, 2.0 * 3.0 * (1.0 + (k + 1) * ts / 0.5), 1e-11);
  }
}

TEST(Pid, RampOfTheMeasurementGivesTheFilteredDerivative) {
  const double ts = 0.01;
  auto params = pi(2.0, infinity);
  params.TD = 0.5;
  params.N = 5.0;
  Stepper<Pid> controller(ts, params);
  const double slope = 1.5;
  const double pole = 0.1 / (0.1 + ts);  // filter time TD/N = 0.1
  for (int k = 0; k < 200; ++k) {
    const double pv = slope * k * ts;
    const double rate = slope * (1.0 - std::pow(pole, k));
    EXPECT_NEAR(controller(automatic(pv, 0.0)).XOUT, -2.0 * pv - 2.0 * 0.5 * rate, 1e-12) << k;
  }
}

TEST(Pid, JumpOfTheSetPointDoesNotKickTheDerivative) {
  auto params = pi(1.0, infinity);
  params.TD = 10.0;
  Stepper<Pid> controller(0.01, params);
  controller(automatic(1.0, 1.0));
  EXPECT_EQ(controller(automatic(1.0, 2.0)).XOUT, 1.0);
}

TEST(Pid, ClosedLoopOnALagFollowsItsCharacteristicEquation) {
  // Plant y(k+1) = a·y(k) + (1 − a)·u(k) under u(k) = KP·(e(k) + i·Σe), i = ts/TR: taking differences, the error obeys
  // e(k+2) = (1 + a − b·(1 + i))·e(k+1) + (b − a)·e(k) with b = KP·(1 − a).
  const double ts = 0.02;
  const double a = std::exp(-ts / 0.7);
  const double kp = 3.0;
  const double share = ts / 0.4;
  const double b = kp * (1.0 - a);
  Stepper<Pid> controller(ts, pi(kp, 0.4));
  double y = 0.0;
  double e_last = 0.0;
  double e_before = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const auto out = controller(automatic(y, 1.0));
    if (k >= 2) {
      EXPECT_NEAR(out.E, (1.0 + a - b * (1.0 + share)) * e_last + (b - a) * e_before, 1e-13) << k;
    }
    e_before = e_last;
    e_last = out.E;
    y = a * y + (1.0 - a) * out.XOUT;
  }
  EXPECT_NEAR(e_last, 0.0, 1e-12) << "no error remains";
}

TEST(Pid, OutputKeepsItsBoundsAndSaysWhich) {
  auto params = pi(1.0, 0.1);
  params.MN = -2.0;
  params.MX = 5.0;
  Stepper<Pid> controller(0.01, params);
  for (int k = 0; k < 500; ++k) {
    const auto out = controller(automatic(0.0, 1.0));
    EXPECT_LE(out.XOUT, 5.0);
    EXPECT_EQ(out.QHIGH, out.XOUT >= 5.0);
    EXPECT_FALSE(out.QLOW);
  }
  for (int k = 0; k < 500; ++k) {
    EXPECT_GE(controller(automatic(0.0, -1.0)).XOUT, -2.0);
  }
  EXPECT_TRUE(controller(automatic(0.0, -1.0)).QLOW);
}

TEST(Pid, LeavesTheBoundInTheStepInWhichTheErrorTurns) {
  for (const double kp : {2.0, -2.0}) {
    auto params = pi(kp, 0.1);
    params.MN = -1.0;
    params.MX = 1.0;
    Stepper<Pid> controller(0.01, params);
    for (int k = 0; k < 100000; ++k) {
      controller(automatic(0.0, 1.0));  // saturated for a thousand seconds, ten thousand reset times
    }
    const double bound = kp > 0.0 ? 1.0 : -1.0;
    EXPECT_EQ(controller(automatic(0.0, 1.0)).XOUT, bound);
    const double first = controller(automatic(0.0, -0.01)).XOUT;
    EXPECT_LT(first * bound, 1.0);
  }
}

TEST(Pid, OvershootAfterALongSaturationIsThatOfAShortOne) {
  // A lag whose actuator saturates: how long the set point was out of reach must not matter for what follows.
  const double ts = 0.01;
  const auto overshoot = [&](int steps_out_of_reach) {
    auto params = pi(5.0, 0.3);
    params.MN = -1.0;
    params.MX = 1.0;
    Stepper<Pid> controller(ts, params);
    double y = 0.0;
    for (int k = 0; k < steps_out_of_reach; ++k) {
      y += ts / 0.5 * (controller(automatic(y, 2.0)).XOUT - y);
    }
    double lowest = y;
    for (int k = 0; k < 1000; ++k) {
      y += ts / 0.5 * (controller(automatic(y, 0.5)).XOUT - y);
      lowest = std::min(lowest, y);
    }
    EXPECT_NEAR(y, 0.5, 1e-9);
    return 0.5 - lowest;
  };
  EXPECT_NEAR(overshoot(1000), overshoot(100000), 1e-6);
}

TEST(Pid, ManualOutputIsX0WithinTheBounds) {
  auto params = pi(3.0, 1.0);
  params.MX = 10.0;
  Stepper<Pid> controller(0.1, params);
  EXPECT_EQ(controller({.AUTO = false, .PV = 5.0, .SP = 1.0, .X0 = 4.0}).XOUT, 4.0);
  EXPECT_EQ(controller({.AUTO = false, .PV = 5.0, .SP = 1.0, .X0 = 40.0}).XOUT, 10.0);
}

TEST(Pid, TransferToAutomaticDoesNotBump) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> value(-10.0, 10.0);
  for (int round = 0; round < 100; ++round) {
    auto params = pi(value(random), 0.2);
    params.TD = 0.3;
    Stepper<Pid> controller(0.01, params);
    double manual = 0.0;
    for (int k = 0; k < 20; ++k) {
      manual = value(random);
      controller({.AUTO = false, .PV = value(random), .SP = value(random), .X0 = manual});
    }
    // Set point, measurement and manual value may all jump in the step of the transfer: the output stays.
    const auto out = controller({.AUTO = true, .PV = value(random), .SP = value(random), .X0 = value(random)});
    EXPECT_NEAR(out.XOUT, manual, 1e-10 * std::abs(params.KP) + 1e-12);
  }
}

TEST(Pid, TransferAtRestIsBumplessToTheLastDigitsAndThenIntegrates) {
  Stepper<Pid> controller(0.01, pi(2.0, 0.5));
  controller({.AUTO = false, .PV = 1.0, .SP = 1.5, .X0 = 7.0});
  for (int k = 0; k < 100; ++k) {
    EXPECT_NEAR(controller(automatic(1.0, 1.5)).XOUT, 7.0 + k * 2.0 * 0.5 * 0.01 / 0.5, 1e-12);
  }
}

TEST(Pid, TransferToManualAndBackDoesNotBumpWhenX0FollowsTheOutput) {
  Stepper<Pid> controller(0.01, pi(2.0, 0.5));
  double out = 0.0;
  for (int k = 0; k < 50; ++k) {
    out = controller({.AUTO = true, .PV = 0.2, .SP = 1.0, .X0 = out}).XOUT;
  }
  const double held = controller({.AUTO = false, .PV = 0.2, .SP = 1.0, .X0 = out}).XOUT;
  EXPECT_EQ(held, out);
  EXPECT_NEAR(controller(automatic(0.7, 0.1)).XOUT, out, 1e-12);
}

TEST(Pid, ChangeOfParametersDoesNotBump) {
  Stepper<Pid> controller(0.01, pi(2.0, 0.5));
  double out = 0.0;
  for (int k = 0; k < 50; ++k) {
    out = controller(automatic(0.2, 1.0)).XOUT;
  }
  controller.params.KP = 9.0;
  controller.params.TR = 4.0;
  controller.params.TD = 1.0;
  controller.params.N = 3.0;
  for (int k = 1; k <= 50; ++k) {
    EXPECT_NEAR(controller(automatic(0.2, 1.0)).XOUT, out + k * 9.0 * 0.8 * 0.01 / 4.0, 1e-12) << "only the new slope";
  }
}

TEST(Pid, ChangeOfTheDerivativeTimeDoesNotBumpOnARamp) {
  const double ts = 0.01;
  auto params = pi(2.0, infinity);
  params.TD = 0.5;
  Stepper<Pid> controller(ts, params);
  double out = 0.0;
  double pv = 0.0;
  for (int k = 0; k < 3000; ++k) {
    pv = 0.3 * k * ts;
    out = controller(automatic(pv, 0.0)).XOUT;
  }
  controller.params.TD = 1.5;
  // The rate has settled at 0.3, so only the proportional part moves on, by −KP·0.3·ts.
  EXPECT_NEAR(controller(automatic(pv + 0.3 * ts, 0.0)).XOUT, out - 2.0 * 0.3 * ts, 1e-12);
}

TEST(Pid, StartsFromX0) {
  Stepper<Pid> controller(0.01, pi(2.0, infinity));
  EXPECT_EQ(controller({.AUTO = true, .PV = 1.0, .SP = 1.5, .X0 = 3.0}).XOUT, 4.0);
}

}  // namespace
}  // namespace hysteron::testing
