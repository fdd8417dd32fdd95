// Rollouts whose states are set anew in the middle of a record: multiple shooting.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "tests/tuning/measured_machines.hpp"
#include "tuning/rollout.hpp"

namespace hysteron {
namespace {

using namespace measured_machines;
using records::Record;
using ::testing::HasSubstr;

/// A cart: force over mass, speed and place, which is measured.
constexpr std::string_view cart =
    "FUNCTION_BLOCK CART (* @ts 10ms *) VAR_INPUT F : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
    "VAR G : HY_GAIN := (K := 2.0); VEL : HY_INTEGRAL_FORWARD; POS : HY_INTEGRAL_FORWARD; END_VAR "
    "G(XIN := F); POS(XIN := VEL.XOUT); VEL(XIN := G.XOUT); Y := POS.XOUT; END_FUNCTION_BLOCK";

OutputErrorProblem cart_in_stretches(const Record& record) {
  OutputErrorProblem problem =
      problem_of(cart, "[fit.G]\nK = {}\n[tune]\ninitial_states = [\"VEL.SUM\", \"POS.SUM\"]\n", {record});
  problem.experiments.front().restarts = {100, 250};
  return problem;
}

Record cart_record() {
  return measured(program_of(cart), inputs("f", 0.01, 400, [](double t) { return std::sin(3.0 * t); }));
}

TEST(Restarts, StandWhereTheModelIsByItself) {
  const OutputErrorProblem problem = cart_in_stretches(cart_record());
  detail::Rollout rollout(problem);
  ASSERT_EQ(rollout.unknowns(), 1 + 2 * 3);
  Eigen::VectorXd x(7);
  x[0] = 2.0;
  const std::vector<double> own = rollout.own_states(x.head(1));
  ASSERT_EQ(own.size(), 6U);
  std::ranges::copy(own, x.data() + 1);
  Eigen::VectorXd residuals(rollout.residual_count());
  ASSERT_TRUE(rollout.residuals(x, residuals, nullptr));
  EXPECT_LT(residuals.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(rollout.outputs(x, 0).front().size(), 400U);
}

TEST(Restarts, HaveColumnsOfTheirOwn) {
  const OutputErrorProblem problem = cart_in_stretches(cart_record());
  detail::Rollout rollout(problem);
  Eigen::VectorXd x(7);
  x << 1.9, 0.1, -0.2, 0.3, 1.0, -0.4, 2.0;
  const Eigen::MatrixXd jacobian = checked_jacobian(rollout, x);
  // Before its stretch and behind it a state has no influence.
  EXPECT_EQ(jacobian.col(3).head(100).norm(), 0.0);
  EXPECT_GT(jacobian.col(3).segment(101, 149).norm(), 0.0);
  EXPECT_EQ(jacobian.col(3).tail(150).norm(), 0.0);
}

/// Somebody moved the cart at the 100th row: over the whole record the gain pays for it, in stretches it does not.
TEST(Restarts, KeepWhatHappenedInOneStretchOutOfTheOthers) {
  Record moved = Record::even(0.0, 0.01, 400);
  const Record record = cart_record();
  for (records::Column column : record.columns()) {
    if (column.name == "Y") {
      for (std::size_t k = 100; k < 400; ++k) {
        column.values[k] += 0.5 + 0.02 * static_cast<double>(k - 100);
      }
    }
    moved.add(std::move(column));
  }
  const OutputErrorFit fit = fit_output_error(cart_in_stretches(moved));
  EXPECT_NEAR(fit.solution.x[0], 2.0, 1e-6);
  EXPECT_THAT(fit.names[3], HasSubstr("VEL.SUM at t = 1 s"));
  OutputErrorProblem whole = cart_in_stretches(moved);
  whole.experiments.front().restarts.clear();
  EXPECT_GT(std::fabs(fit_output_error(whole).solution.x[0] - 2.0), 0.05);
}

}  // namespace
}  // namespace hysteron
