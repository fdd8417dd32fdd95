// The branching detector, against a detector that keeps the whole record.
#include "blocks/branch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

/// The same definition, on the whole record since the last branching point instead of one held extreme.
class RecordingDetector {
 public:
  explicit RecordingDetector(double dead_band) : dead_band_(dead_band) {}
  bool operator()(double x) {
    record_.push_back(x);
    if (direction == 0) {
      if (std::fabs(x - record_.front()) > dead_band_) {
        direction = x > record_.front() ? 1 : -1;
        branching_point = record_.front();
        record_ = {x};
      }
      return false;
    }
    const auto extreme = direction > 0 ? std::ranges::max_element(record_) : std::ranges::min_element(record_);
    if (direction * (*extreme - x) <= dead_band_) {
      return false;
    }
    branching_point = *extreme;
    direction = -direction;
    record_ = {x};
    return true;
  }
  int direction = 0;
  double branching_point = 0.0;

 private:
  double dead_band_;
  std::vector<double> record_;
};

TEST(Branch, AgreesWithADetectorThatKeepsTheRecord) {
  for (const double dead_band : {0.0, 0.25, 1.0, 3.0}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      RandomIo random(seed, 1.0);
      Stepper<Branch> block(1.0, {.EPS = dead_band});
      RecordingDetector reference(dead_band);
      double x = 0.0;
      for (int k = 0; k < 500; ++k) {
        // Steps of −1, −¾ … 1: plateaus and returns that equal the dead band are common.
        x += std::round((2.0 * random.unit() - 1.0) * 4.0) / 4.0;
        const auto out = block({.XIN = x, .R1 = false});
        ASSERT_EQ(out.Q, reference(x)) << "step " << k;
        ASSERT_EQ(out.DIRECTION, reference.direction);
        if (out.DIRECTION != 0) {
          ASSERT_EQ(out.XB, reference.branching_point);
        }
        ASSERT_EQ(out.P, std::fabs(x - out.XB));
      }
    }
  }
}

TEST(Branch, FindsTheReversalsOfASine) {
  Stepper<Branch> block(1e-3);
  std::vector<double> points;
  for (int k = 0; k < 3000; ++k) {
    const auto out = block({.XIN = 250.0 * std::sin(2.0 * std::numbers::pi * k * 1e-3), .R1 = false});
    if (out.Q) {
      points.push_back(out.XB);
    }
  }
  ASSERT_EQ(points.size(), 6U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_DOUBLE_EQ(points[i], i % 2 == 0 ? 250.0 : -250.0);
  }
}

TEST(Branch, APlateauIsNoReversal) {
  Stepper<Branch> block(1.0);
  for (const double x : {0.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0}) {
    EXPECT_FALSE(block({.XIN = x, .R1 = false}).Q);
  }
  const auto out = block({.XIN = 2.5, .R1 = false});
  EXPECT_TRUE(out.Q);
  EXPECT_EQ(out.XB, 3.0);
  EXPECT_EQ(out.DIRECTION, -1);
}

TEST(Branch, JitterInADwellReversesOnlyWithoutDeadBand) {
  Stepper<Branch> exact(1.0, {.EPS = 0.0});
  Stepper<Branch> tolerant(1.0, {.EPS = 1e-12});
  int exact_reversals = 0;
  int tolerant_reversals = 0;
  for (int k = 0; k < 100; ++k) {
    const double x = k < 50 ? 0.02 * k : 1.0 + (k % 2 == 0 ? 1e-15 : -1e-15);
    exact_reversals += exact({.XIN = x, .R1 = false}).Q ? 1 : 0;
    tolerant_reversals += tolerant({.XIN = x, .R1 = false}).Q ? 1 : 0;
  }
  EXPECT_GT(exact_reversals, 40);
  EXPECT_EQ(tolerant_reversals, 0);
}

TEST(Branch, ASlowDriftIsFoundThroughTheDeadBand) {
  Stepper<Branch> block(1.0, {.EPS = 0.1});
  bool reversed = false;
  for (int k = 0; k < 10; ++k) {
    block({.XIN = 1.0 * k, .R1 = false});
  }
  for (int k = 0; k < 30; ++k) {
    const auto out = block({.XIN = 9.0 - 0.01 * k, .R1 = false});
    if (out.Q) {
      reversed = true;
      EXPECT_EQ(out.XB, 9.0) << "the extreme, not where the dead band ended";
      EXPECT_NEAR(out.P, 0.11, 1e-12);
    }
  }
  EXPECT_TRUE(reversed);
}

TEST(Branch, AResetStartsABranchHere) {
  Stepper<Branch> block(1.0);
  block({.XIN = 0.0, .R1 = false});
  block({.XIN = 5.0, .R1 = false});
  auto out = block({.XIN = 4.0, .R1 = true});
  EXPECT_FALSE(out.Q);
  EXPECT_EQ(out.XB, 4.0);
  EXPECT_EQ(out.DIRECTION, 0);
  EXPECT_EQ(out.P, 0.0);
  out = block({.XIN = 3.0, .R1 = false});
  EXPECT_FALSE(out.Q) << "the first motion is no reversal";
  EXPECT_EQ(out.DIRECTION, -1);
}

}  // namespace
}  // namespace hysteron::testing
