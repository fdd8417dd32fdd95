// The size of a line from the line alone, whatever else is missing.
#include "diagnosis/search/line_start.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double frequency = 23.0;

/// An axis whose drive is disturbed and then limited; its mass is a fifth lighter than tuned.
const std::string machine = R"(FUNCTION_BLOCK AXIS  (* @ts 5ms *)
  VAR_INPUT FORCE : LREAL;  (* @unit N *) END_VAR
  VAR_OUTPUT V : LREAL;  (* @unit m/s *) END_VAR
  VAR
    HUM : HY_PERIODIC_DISTURBANCE := (SINE := 0.9, COSINE := -0.4, FREQUENCY := 23.0);
    DRIVE : HY_LIMIT := (MN := -2.0);
    MASS : HY_GAIN := (K := 0.6);
    SPEED : HY_INTEGRAL;
  END_VAR
  HUM(XIN := FORCE);
  DRIVE(XIN := HUM.XOUT);
  MASS(XIN := DRIVE.XOUT);
  SPEED(XIN := MASS.XOUT);
  V := SPEED.XOUT;
END_FUNCTION_BLOCK
)";

class LineStart : public testing::Test {
 protected:
  /// Screened where a fit of all of the residual has put it: twenty times too large, and the wrong way.
  Screened screened(const std::string& effect, bool measured) const {
    const Variant base{.text = input_.text, .program = std::make_shared<const Program>(input_.program)};
    Screened one{.candidate = candidates_of(base, "AXIS", {.effects = {effect}}).front(),
                 .starts = {{.values = VectorXd(3), .gain = 1.0, .measured = measured}}};
    one.starts.front().values << -18.0, 30.0, frequency;
    for (const std::string& path : one.candidate.own().paths) {
      one.unknowns.push_back({.path = path,
                              .start = 1.0,
                              .lower = -100.0,
                              .upper = 100.0,
                              .deviation = std::numeric_limits<double>::infinity()});
    }
    return one;
  }

  DiagnosisInput input_ =
      test::input_of(test::axis(), test::axis_parameters,
                     {test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), 0.0005)});
  Task task_ = task_of(input_);
};

TEST_F(LineStart, HasTheSizeThatTheSpectrumShows) {
  Explanation from{.variant = {.text = input_.text, .program = std::make_shared<const Program>(input_.program)}};
  Model model(task_, *from.variant.program);
  from.fit.x = model.start();
  const Screened one = screened("periodic_disturbance", true);
  ASSERT_TRUE(is_line(one));
  const Explanation found = with_line(task_, one, from);
  ASSERT_TRUE(std::isfinite(found.fit.cost));
  ASSERT_EQ(found.variant.further.size(), 3U);
  EXPECT_NEAR(found.fit.x[model.first_further() + 0], 0.6 / 0.5 * 0.9, 0.3);
  EXPECT_NEAR(found.fit.x[model.first_further() + 1], 0.6 / 0.5 * -0.4, 0.3);
  EXPECT_EQ(found.fit.x[model.first_further() + 2], frequency);
  // Half a turn over the record, so that a fit cannot bend it towards what is no line.
  EXPECT_NEAR(found.variant.further[2].upper - found.variant.further[2].lower, 1.0 / (2000.0 * 0.005), 1e-9);
}

TEST_F(LineStart, IsThatOfALineWhichTheSpectrumShows) {
  EXPECT_FALSE(is_line(screened("periodic_disturbance", false)));
  EXPECT_FALSE(is_line(screened("load", true)));  // three parameters, and none is a frequency
}

}  // namespace
}  // namespace hysteron::diagnosis
