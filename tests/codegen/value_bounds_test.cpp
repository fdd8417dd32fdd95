// Bounds that are proved: no value ever lies outside of them, whatever the operation and the diagram; and where a
// diagram bounds its output, the bound is that one.
#include "codegen/backends/shared/value_bounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "codegen/backends/shared/interval.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/trace/evaluate.hpp"
#include "support/single.hpp"
#include "tests/codegen/random_program.hpp"

namespace hysteron::testing {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

std::vector<ValueBounds> bounds_of(const Program& program, bool float32 = false) {
  return output_bounds(program.graph, make_routine(program), float32);
}

ValueBounds bound_of(const std::string& variables, const std::string& statements, const std::string& range) {
  const std::string text = fmt::format(
      "FUNCTION_BLOCK B (* @ts 1ms *) VAR_INPUT X : LREAL; (* {} *) END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR {} "
      "END_VAR {} END_FUNCTION_BLOCK",
      range, variables, statements);
  return bounds_of(compile_text(text)).front();
}

// --- single operations ---

double real_within(const ValueBounds& bounds, std::mt19937_64& random) {
  switch (random() % 6) {
    case 0:
      return bounds.low;
    case 1:
      return bounds.high;
    case 2:
      return bounds.may_be_nan ? std::nan("") : bounds.low;
    default: {
      const double low = std::max(bounds.low, -1e300);
      const double high = std::min(bounds.high, 1e300);
      if (low > high) {  // an infinite number
        return bounds.low;
      }
      return std::clamp(low + (high - low) * std::uniform_real_distribution<double>()(random), low, high);
    }
  }
}

ValueBounds random_bounds(std::mt19937_64& random) {
  static const std::vector<double> ends{-infinite, -1e300, -3.5, -1.0, -1e-310, -0.0, 0.0,   1e-310,
                                        0.25,      0.5,    1.0,  2.0,  7.0,     1e20, 1e300, infinite};
  double a = ends[random() % ends.size()];
  double b = ends[random() % ends.size()];
  if (random() % 3 == 0) {
    a = std::normal_distribution<double>()(random);
    b = random() % 4 == 0 ? a : std::normal_distribution<double>()(random);
  }
  return {.low = std::min(a, b), .high = std::max(a, b), .may_be_nan = random() % 4 == 0};
}

TEST(ValueBounds, NoRealOperationLeavesThem) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 200'000; ++round) {
    const auto op = static_cast<Op>(static_cast<int>(Op::Add) + static_cast<int>(random() % 18));
    const interval::Operands operands{.a = random_bounds(random), .b = random_bounds(random)};
    const double a = real_within(operands.a, random);
    const double b = real_within(operands.b, random);
    const double value = real_operation(op, a, b);
    const ValueBounds bounds = interval::apply(op, operands, false);
    ASSERT_TRUE(bounds.contains(value)) << info(op).name << " of " << a << " and " << b << ": " << value << " in "
                                        << bounds.low << " … " << bounds.high;
  }
}

TEST(ValueBounds, NoOperationOfIntegersLeavesThem) {
  std::mt19937_64 random(2);
  const auto end = [&] {
    switch (random() % 4) {
      case 0:
        return std::numeric_limits<std::int32_t>::min();
      case 1:
        return std::numeric_limits<std::int32_t>::max();
      default:
        return static_cast<std::int32_t>(random() % 41) - 20;
    }
  };
  for (int round = 0; round < 200'000; ++round) {
    const auto op = static_cast<Op>(static_cast<int>(Op::IntAdd) + static_cast<int>(random() % 13));
    const auto drawn = [&] {
      const std::int32_t a = end();
      const std::int32_t b = end();
      return ValueBounds{.low = std::min(a, b) + 0.0, .high = std::max(a, b) + 0.0, .may_be_nan = false};
    };
    const interval::Operands operands{.a = drawn(), .b = drawn()};
    const auto within = [&](const ValueBounds& bounds) {
      return static_cast<std::int32_t>(std::floor(real_within(bounds, random)));
    };
    const std::int32_t a = within(operands.a);
    const std::int32_t b = within(operands.b);
    const std::int32_t value = int_operation(op, a, b);
    ASSERT_TRUE(interval::apply(op, operands, false).contains(value)) << info(op).name << " of " << a << " and " << b;
  }
}

TEST(ValueBounds, NoComparisonLeavesThem) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 50'000; ++round) {
    const auto op = static_cast<Op>(static_cast<int>(Op::Less) + static_cast<int>(random() % 4));
    const interval::Operands operands{.a = random_bounds(random), .b = random_bounds(random)};
    const double a = real_within(operands.a, random);
    const double b = real_within(operands.b, random);
    ASSERT_TRUE(interval::apply(op, operands, false).contains(comparison(op, a, b) ? 1.0 : 0.0))
        << info(op).name << " of " << a << " and " << b;
  }
}

// --- whole steps ---

/// Runs a diagram over inputs within their ranges. Returns how many outputs have two ends.
template <class Real>
std::size_t hold(std::uint64_t seed) {
  Program program = RandomDiagram(seed, "P", 1 + static_cast<int>(seed % 12),
                                  {.rates = true, .types = true, .functions = true, .vectors = true})
                        .program();
  std::mt19937_64 random(seed);
  for (Port& port : program.graph.inputs) {
    if (port.type == Type::Real) {
      port.minimum = -1.5;
      port.maximum = 2.5;
    } else if (port.type == Type::Int) {
      port.minimum = -2.0;
      port.maximum = 5.0;
    }
  }
  const std::vector<ValueBounds> bounds = bounds_of(program, std::is_same_v<Real, float>);
  Machine<Real> machine(program);
  for (int k = 0; k < 300; ++k) {
    for (std::size_t i = 0; i < program.graph.inputs.size(); ++i) {
      const Port& port = program.graph.inputs[i];
      double value = 0.0;
      switch (port.type) {
        case Type::Real:
          value = nearest_single(std::uniform_real_distribution<double>(-1.5, 2.5)(random));
          value = random() % 8 == 0 ? (random() % 2 == 0 ? -1.5 : 2.5) : value;
          break;
        case Type::Int:
          value = static_cast<double>(random() % 8) - 2.0;
          break;
        case Type::Bool:
          value = static_cast<double>(random() % 2);
          break;
        default:
          value = static_cast<double>(random() % 65536);
      }
      machine.set_input(i, static_cast<Real>(value));
    }
    machine.step();
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const auto value = static_cast<double>(machine.output(i));
      EXPECT_TRUE(bounds[i].contains(value))
          << "seed " << seed << ", step " << k << ", " << program.graph.outputs[i].name << " = " << value << " in "
          << bounds[i].low << " … " << bounds[i].high;
      if (!bounds[i].contains(value)) {
        return 0;
      }
    }
  }
  return static_cast<std::size_t>(std::ranges::count_if(bounds, &ValueBounds::is_finite));
}

TEST(ValueBounds, NoStepOfARandomDiagramLeavesThem) {
  std::size_t bounded = 0;
  for (std::uint64_t seed = 7000; seed < 7400; ++seed) {
    bounded += seed % 3 == 0 ? hold<float>(seed) : hold<double>(seed);
  }
  EXPECT_GT(bounded, 800U) << "outputs with two ends";
}

TEST(ValueBounds, AreThoseThatTheDiagramSets) {
  const ValueBounds limited =
      bound_of("L : HY_LIMIT := (MN := -2.0, MX := 5.0);", "L(XIN := X); Y := L.XOUT;", "@min -1e6 @max 1e6");
  EXPECT_EQ(limited, (ValueBounds{.low = -2.0, .high = 5.0, .may_be_nan = false}));
  const ValueBounds from_anything =
      bound_of("L : HY_LIMIT := (MN := -2.0, MX := 5.0);", "L(XIN := X); Y := L.XOUT;", "");
  EXPECT_EQ(from_anything.low, -2.0);
  EXPECT_TRUE(from_anything.may_be_nan) << "as HY_LIMIT is: what is no number stays none";
  const ValueBounds controlled = bound_of("C : HY_PID := (KP := 2.0, TR := 0.5, TD := 0.01, MN := 0.0, MX := 10.0);",
                                          "C(SP := X, PV := 1.0); Y := C.XOUT;", "@min -100.0 @max 100.0");
  EXPECT_EQ(controlled.low, 0.0);
  EXPECT_EQ(controlled.high, 10.0);
}

TEST(ValueBounds, AStateThatForgetsIsBoundedAndOneThatCountsIsNot) {
  const ValueBounds delayed = bound_of("D : HY_DELAY;", "Y := D.XOUT; D(XIN := X);", "@min -3.0 @max 4.0");
  EXPECT_EQ(delayed, (ValueBounds{.low = -3.0, .high = 4.0, .may_be_nan = false}));
  const ValueBounds forgetting =
      bound_of("D : HY_DELAY;", "Y := D.XOUT; D(XIN := 0.5 * D.XOUT + X);", "@min -1.0 @max 1.0");
  EXPECT_LE(forgetting.high, 2.0000001) << "1 + 1/2 + 1/4 + …";
  EXPECT_GE(forgetting.high, 2.0);
  EXPECT_EQ(forgetting.low, -forgetting.high);
  const ValueBounds summed = bound_of("I : HY_INTEGRAL;", "I(XIN := X); Y := I.XOUT;", "@min -1.0 @max 1.0");
  EXPECT_EQ(summed.high, infinite);
}

}  // namespace
}  // namespace hysteron::testing
