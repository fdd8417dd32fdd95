// What lies farther than half a step from values on coarse steps, against its closed form.
#include "diagnosis/verdict/hidden_by_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double quantum = 0.5;
constexpr double floor_of_sensor = 0.01;

const std::string plain =
    "FUNCTION_BLOCK P (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : HY_GAIN := (K "
    ":= "
    "1.0); END_VAR G(XIN := U); Y := G.XOUT; END_FUNCTION_BLOCK";
const std::string rounding =
    "FUNCTION_BLOCK P (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : HY_GAIN := (K "
    ":= "
    "1.0); Q : HY_QUANTIZER := (QUANTUM := 0.5); END_VAR G(XIN := U); Q(XIN := G.XOUT); Y := Q.XOUT; "
    "END_FUNCTION_BLOCK";

/// 10,000 values that lie anywhere within their steps, rounded by a sensor that is off by so much.
records::Record ramp(double off) {
  std::vector<double> values;
  for (int k = 0; k < 10000; ++k) {
    values.push_back(10.0 * std::abs(std::remainder(7e-4 * k, 2.0)));
  }
  records::Record record = test::record_of("U", values);
  for (double& value : values) {
    value = quantum * std::round((value + off) / quantum);
  }
  record.add({.name = "Y", .values = std::move(values)});
  return record;
}

Explanation of(const Task& task, const std::string& text, std::vector<Unknown> further) {
  Explanation one{.variant = {.text = text,
                              .program = std::make_shared<const Program>(test::program_of(text)),
                              .further = std::move(further)}};
  Model model(task, *one.variant.program, one.variant.further);
  one.fit.x = model.start();
  EXPECT_TRUE(model.residuals(one.fit.x, one.fit.residuals));
  return one;
}

TEST(HiddenBySteps, AnErrorAtAThresholdIsNoWholeStep) {
  const Unknown rounds{.path = "Q.QUANTUM", .start = quantum, .upper = 1.0, .rounds = true};
  for (const double off : {0.02, 0.1}) {
    Task task = task_of(test::input_of(plain, "[parameters.G]\nK = 1.0\n", {ramp(off)}));
    task.scales = {floor_of_sensor};
    const Explanation calibrated = of(task, plain, {});
    const Explanation chosen = of(task, rounding, {rounds});
    const auto found = hidden_by_steps(task, calibrated, chosen);
    ASSERT_TRUE(found) << off;
    // Of the values a share off/q is rounded another way, by a whole step; they are farther off by 0 … off.
    EXPECT_NEAR(rms_of(task, chosen.fit.residuals, 0), std::sqrt(off * quantum), 0.05 * std::sqrt(off * quantum));
    const double beyond = std::sqrt(std::pow(off, 3) / (3.0 * quantum));
    EXPECT_NEAR(rms_of(task, found->residuals, 0), beyond, 0.1 * beyond);
    EXPECT_FALSE(found->remark.empty());
    EXPECT_FALSE(hidden_by_steps(task, calibrated, calibrated)) << "it has no quantiser";
  }
}

TEST(HiddenBySteps, OfASmoothSensorNothingIs) {
  records::Record record = ramp(0.0);
  std::vector<double> values = record.column("U").values;
  for (double& value : values) {
    value += 0.1;
  }
  record.replace("Y", std::move(values));
  Task task = task_of(test::input_of(plain, "[parameters.G]\nK = 1.0\n", {record}));
  task.scales = {floor_of_sensor};
  const Explanation chosen =
      of(task, rounding, {{.path = "Q.QUANTUM", .start = quantum, .upper = 1.0, .rounds = true}});
  EXPECT_FALSE(hidden_by_steps(task, of(task, plain, {}), chosen));
}

}  // namespace
}  // namespace hysteron::diagnosis
