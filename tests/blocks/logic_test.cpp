// Comparators, logic, edges and latches: whole truth tables, and the identities between them.
#include <gtest/gtest.h>

#include <array>

#include "blocks/equal.hpp"
#include "blocks/falling_edge.hpp"
#include "blocks/greater.hpp"
#include "blocks/greater_equal.hpp"
#include "blocks/less.hpp"
#include "blocks/less_equal.hpp"
#include "blocks/logic_and.hpp"
#include "blocks/logic_not.hpp"
#include "blocks/logic_or.hpp"
#include "blocks/logic_xor.hpp"
#include "blocks/not_equal.hpp"
#include "blocks/reset_dominant_latch.hpp"
#include "blocks/rising_edge.hpp"
#include "blocks/set_dominant_latch.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

template <class B>
bool compare(double a, double b) {
  Stepper<B> block(1.0);
  return block({.IN1 = a, .IN2 = b}).Q;
}

TEST(Comparators, ExactlyOneOfLessEqualGreaterHolds) {
  for (const double a : {-infinity, -1.0, -0.0, 0.0, 5e-324, 1.0, infinity}) {
    for (const double b : {-infinity, -1.0, -0.0, 0.0, 5e-324, 1.0, infinity}) {
      EXPECT_EQ(compare<Less>(a, b) + compare<Equal>(a, b) + compare<Greater>(a, b), 1);
      EXPECT_EQ(compare<LessEqual>(a, b), compare<Less>(a, b) || compare<Equal>(a, b));
      EXPECT_EQ(compare<GreaterEqual>(a, b), !compare<Less>(a, b));
      EXPECT_EQ(compare<NotEqual>(a, b), !compare<Equal>(a, b));
      EXPECT_EQ(compare<Greater>(a, b), compare<Less>(b, a));
    }
  }
  EXPECT_TRUE(compare<Greater>(2.0, 1.0));
  EXPECT_TRUE(compare<Equal>(0.0, -0.0));
}

TEST(Comparators, NotANumberIsUnequalToAllAndNothingElse) {
  for (const double x : {0.0, not_a_number, infinity}) {
    EXPECT_FALSE(compare<Less>(not_a_number, x));
    EXPECT_FALSE(compare<LessEqual>(x, not_a_number));
    EXPECT_FALSE(compare<Greater>(x, not_a_number));
    EXPECT_FALSE(compare<GreaterEqual>(not_a_number, x));
    EXPECT_FALSE(compare<Equal>(x, not_a_number));
    EXPECT_TRUE(compare<NotEqual>(x, not_a_number));
  }
}

TEST(Logic, WholeTruthTables) {
  Stepper<And> all(1.0);
  Stepper<Or> any(1.0);
  Stepper<Xor> one(1.0);
  Stepper<Not> inverse(1.0);
  for (int bits = 0; bits < 16; ++bits) {
    const bool a = (bits & 1) != 0;
    const bool b = (bits & 2) != 0;
    const bool c = (bits & 4) != 0;
    const bool d = (bits & 8) != 0;
    EXPECT_EQ(all({.IN1 = a, .IN2 = b, .IN3 = c, .IN4 = d}).Q, bits == 15);
    EXPECT_EQ(any({.IN1 = a, .IN2 = b, .IN3 = c, .IN4 = d}).Q, bits != 0);
    EXPECT_EQ(one({.IN1 = a, .IN2 = b}).Q, (bits & 3) == 1 || (bits & 3) == 2);
    EXPECT_EQ(inverse({.IN1 = a}).Q, (bits & 1) == 0);
  }
}

TEST(Logic, OperandsThatAreNotConnectedDecideNothing) {
  Stepper<And> all(1.0);
  Stepper<Or> any(1.0);
  auto both = presets<And::In<double>>();
  both.IN1 = both.IN2 = true;
  EXPECT_TRUE(all(both).Q);
  EXPECT_FALSE(any(presets<Or::In<double>>()).Q);
}

TEST(Edges, AreTrueForOneStepEach) {
  const std::array<bool, 8> clock{false, true, true, false, false, true, false, true};
  Stepper<RisingEdge> rise(1.0);
  Stepper<FallingEdge> fall(1.0);
  for (std::size_t k = 1; k < clock.size(); ++k) {
    if (k == 1) {
      rise({.CLK = clock[0]});
      fall({.CLK = clock[0]});
    }
    EXPECT_EQ(rise({.CLK = clock[k]}).Q, clock[k] && !clock[k - 1]) << k;
    EXPECT_EQ(fall({.CLK = clock[k]}).Q, !clock[k] && clock[k - 1]) << k;
  }
}

TEST(Edges, FirstStepIsAsInTheStandard) {
  EXPECT_TRUE(Stepper<RisingEdge>(1.0)({.CLK = true}).Q);
  EXPECT_FALSE(Stepper<RisingEdge>(1.0)({.CLK = false}).Q);
  EXPECT_TRUE(Stepper<FallingEdge>(1.0)({.CLK = false}).Q);
  EXPECT_FALSE(Stepper<FallingEdge>(1.0)({.CLK = true}).Q);
}

TEST(Latches, HoldWhatWasSetAndDifferOnlyWhereBothAreTrue) {
  for (const bool held : {false, true}) {
    for (int bits = 0; bits < 4; ++bits) {
      const bool set = (bits & 1) != 0;
      const bool reset = (bits & 2) != 0;
      Stepper<SetDominantLatch> sr(1.0);
      Stepper<ResetDominantLatch> rs(1.0);
      sr({.S1 = held, .R = false});
      rs({.S = held, .R1 = false});
      const bool undecided = set == reset ? held : set;
      EXPECT_EQ(sr({.S1 = set, .R = reset}).Q1, set && reset ? true : undecided);
      EXPECT_EQ(rs({.S = set, .R1 = reset}).Q1, set && reset ? false : undecided);
    }
  }
}

}  // namespace
}  // namespace hysteron::testing
