// A hysteresis whose slope along a branch is another than C1 + C2·p^C3, integrated here in small steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double stack_noise = 0.02;
constexpr double stack_step = 0.005;
constexpr double c1 = 5.0;
constexpr double c2 = 4.0;
constexpr double c3 = 0.8;

/// By the travel since the last reversal and the rate.
using Slope = std::function<double(double, double)>;

/// The stack without its amplifier.
std::string loop() {
  return "FUNCTION_BLOCK STACK  (* @ts 5ms *)\n  VAR_INPUT U : LREAL;  (* @unit V *) END_VAR\n"
         "  VAR_OUTPUT Y : LREAL;  (* @unit um *) END_VAR\n"
         "  VAR HYST : HY_HYSTERESIS_RO := (START := 1); END_VAR\n"
         "  HYST(XIN := U);\n  Y := HYST.XOUT;\nEND_FUNCTION_BLOCK\n";
}

records::Record record_with(const Slope& slope) {
  constexpr int substeps = 200;
  const std::vector<double> voltage = test::rich_voltage();
  std::vector<double> position{0.0};
  double travel = 0.0;
  double direction = 1.0;
  for (std::size_t k = 1; k < voltage.size(); ++k) {
    const double change = voltage[k] - voltage[k - 1];
    if (change * direction < 0.0) {
      direction = -direction;
      travel = 0.0;
    }
    double rise = 0.0;
    const double part = std::abs(change) / substeps;
    for (int i = 0; i < substeps; ++i) {
      rise += part * slope(travel + 0.5 * part, std::abs(change) / stack_step);
      travel += part;
    }
    position.push_back(position.back() + std::copysign(rise, change));
  }
  records::Record record = test::record_of("U", voltage);
  const std::vector<double> off = test::Noise(4).white(position.size(), stack_noise);
  std::ranges::transform(position, off, position.begin(), std::plus<>());
  record.add({.name = "Y", .values = std::move(position)});
  return record;
}

/// It is that effect and nothing else, and what remains is noise.
void expect_alone(const std::string& effect, const Slope& slope) {
  const std::string tuned = fmt::format("[parameters.HYST]\nC1 = {}\nC2 = {}\nC3 = {}\n", c1, c2, c3);
  const Diagnosis found =
      diagnose(test::input_of(loop(), tuned, {record_with(slope)}),
               {.effects = {"curve_shape", "rate_dependence", "gain_error", "asymmetry", "bias_dependence"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects[0].id, effect);
  EXPECT_EQ(found.verdict, Verdict::Named) << found.summary;
  EXPECT_GT(found.gap.calibrated, 2.0 * stack_noise);
  EXPECT_LT(found.gap.improved, 1.1 * stack_noise);
}

TEST(LoopShapes, ASlopeThatFallsToNothingBesideItsGrowth) {
  expect_alone("curve_shape",
               [](double travel, double) { return c1 * std::exp(-travel / 0.5) + c2 * std::pow(travel, c3); });
}

TEST(LoopShapes, ASlopeThatDoubles) {
  expect_alone("curve_shape",
               [](double travel, double) { return c1 * (2.0 - std::exp(-travel / 0.5)) + c2 * std::pow(travel, c3); });
}

/// By decades of the rate on either side of the usual one.
TEST(LoopShapes, AGrowthWithTheLogarithmOfTheRate) {
  expect_alone("rate_dependence", [](double travel, double rate) {
    return c1 + c2 * std::pow(travel, c3) * (1.0 + 0.4 * std::log10(std::max(rate, 0.005) / 5.0));
  });
}

}  // namespace
}  // namespace hysteron::diagnosis
