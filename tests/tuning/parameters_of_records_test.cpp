// [fit.record]: parameters that have a value of their own in each record, beside those that all records share.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "tests/tuning/measured_machines.hpp"
#include "tests/tuning/output_error_diagrams.hpp"
#include "tuning/output_error.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using namespace output_error_diagrams;
using namespace measured_machines;
using records::Record;
using ::testing::HasSubstr;

constexpr std::string_view zeroed = R"(FUNCTION_BLOCK OVEN (* @ts 1s *)
  VAR_INPUT
    HEAT : LREAL;
    ZERO : LREAL := 0.0; (* @param *)
  END_VAR
  VAR_OUTPUT TEMP : LREAL; END_VAR
  VAR BODY : HY_LAG := (T1 := 20.0); END_VAR
  BODY(XIN := HEAT);
  TEMP := BODY.XOUT + ZERO;
END_FUNCTION_BLOCK
)";

/// Two days on which a sensor had two zeros, and the body one time constant.
std::vector<Record> two_days() {
  std::vector<Record> days;
  for (const double zero : {0.4, -1.6}) {
    const Program truth =
        program_of(zeroed, fmt::format("[parameters]\nZERO = {}\n[parameters.BODY]\nT1 = 35.0\n", zero));
    days.push_back(
        measured(truth, inputs("heat", 1.0, 200, [](double t) { return std::fmod(t, 90.0) < 40.0 ? 5.0 : 1.0; })));
  }
  return days;
}

TEST(ParametersOfRecords, HaveAValueForEachRecord) {
  const std::vector<Record> days = two_days();
  const std::string settings = "[fit.BODY]\nT1 = {}\n[fit.record]\nZERO = {min = -5.0}\n";
  const auto problem = problem_of(zeroed, settings, days);
  const auto fit = fit_output_error(problem);
  ASSERT_THAT(fit.names, ::testing::ElementsAre("BODY.T1", "ZERO of record 1", "ZERO of record 2"));
  EXPECT_NEAR(fit.solution.x[0], 35.0, 1e-6);
  EXPECT_NEAR(fit.solution.x[1], 0.4, 1e-6);
  EXPECT_NEAR(fit.solution.x[2], -1.6, 1e-6);
  const Index rows = fit.solution.jacobian.rows() / 2;
  EXPECT_TRUE(fit.solution.jacobian.col(1).tail(rows).isZero(0.0)) << "one day's zero does not act on the other";
  EXPECT_TRUE(fit.solution.jacobian.col(2).head(rows).isZero(0.0));

  const auto file = parameters::parse_parameter_file("p.toml", settings);
  const auto tuned = tuned_file(file, problem, fit);
  EXPECT_NEAR(std::get<double>(tuned.find("ZERO")->value), -0.6, 1e-6) << "the mean, for runs";
  EXPECT_THAT(tuned_heading(problem, fit),
              ::testing::AllOf(HasSubstr("ZERO of record 1: 0."), HasSubstr("ZERO of record 2: -1."),
                               ::testing::Not(HasSubstr("T1"))));
  const auto text = parameters::parameter_text(tuned, tuned_remarks(problem, fit));
  EXPECT_THAT(text, HasSubstr("[fit.record]\nZERO = {min = -5.0}"));

  const auto shared = fit_output_error(problem_of(zeroed, "[fit.BODY]\nT1 = {}\n[fit]\nZERO = {}\n", days));
  EXPECT_GT(shared.scores.front().train, 0.9) << "what one zero for both days leaves";
}

TEST(ParametersOfRecords, OfASingleRecordHaveOneValueEach) {
  const std::vector<Record> day{two_days().front()};
  const auto fit = fit_output_error(problem_of(zeroed, "[fit.record]\nZERO = {}\n[fit.record.BODY]\nT1 = {}\n", day));
  EXPECT_THAT(fit.names, ::testing::ElementsAre("ZERO", "BODY.T1"));
  EXPECT_NEAR(fit.solution.x[0], 0.4, 1e-6);
}

}  // namespace
}  // namespace hysteron
