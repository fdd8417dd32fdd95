// The fit that every candidate gets, against closed forms.
#include "diagnosis/model/least_squares.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <string>

#include "support/numbers.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// Y = K·U + BIAS: linear in both.
const std::string line =
    "FUNCTION_BLOCK LINE (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : HY_GAIN; B "
    ": HY_OFFSET; END_VAR G(XIN := U); B(XIN := G.XOUT); Y := B.XOUT; END_FUNCTION_BLOCK";

constexpr Index samples = 60;

/// A fit is as exact as the square root of its tolerance, and of what a double can tell of a cost: the former asks for
/// more than the latter can give.
constexpr double exact = 1e-20;
constexpr double told_by_a_cost = 1e-8;

Task line_task() {
  Task task;
  test::Noise noise(5);
  records::Record record = test::record_of("U", noise.white(samples, 1.0));
  record.add({.name = "Y", .values = noise.white(samples, 2.0)});
  task.records = {record};
  task.outputs = {"Y"};
  task.known = {{.path = "G.K", .start = 1.0, .lower = -infinity, .upper = infinity},
                {.path = "B.BIAS", .start = 0.0, .lower = -infinity, .upper = infinity}};
  task.scales = {1.0};
  return task;
}

struct Line {
  MatrixXd a{};
  VectorXd y{};
};

Line line_of(const Task& task) {
  Line result{.a = MatrixXd::Ones(samples, 2), .y = VectorXd(samples)};
  for (Index k = 0; k < samples; ++k) {
    result.a(k, 0) = task.records[0].column("U").values[static_cast<std::size_t>(k)];
    result.y[k] = task.records[0].column("Y").values[static_cast<std::size_t>(k)];
  }
  return result;
}

void expect_near(const VectorXd& found, const VectorXd& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (Index j = 0; j < found.size(); ++j) {
    EXPECT_NEAR(found[j], expected[j], tolerance);
  }
}

TEST(LeastSquares, LinearProblemIsThatOfTheNormalEquations) {
  const Task task = line_task();
  Model model(task, compile_text(line));
  const Fit found = fit(model, model.start(), {.tolerance = exact});
  const auto [a, y] = line_of(task);
  const VectorXd expected = (a.transpose() * a).ldlt().solve(a.transpose() * y);
  expect_near(found.x, expected, told_by_a_cost);
  EXPECT_NEAR(found.cost, 0.5 * (a * expected - y).squaredNorm(), 1e-9);
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.residuals.size(), samples);
  EXPECT_LT((found.jacobian - a).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LeastSquares, ScalesDivideTheResiduals) {
  Task task = line_task();
  task.scales = {4.0};
  Model model(task, compile_text(line));
  VectorXd residuals;
  ASSERT_TRUE(model.residuals(model.start(), residuals));
  const auto [a, y] = line_of(task);
  expect_near(residuals, (a.col(0) - y) / 4.0, 1e-14);
}

TEST(LeastSquares, PriorIsRidgeAboutTheStart) {
  Task task = line_task();
  task.known[0].deviation = 0.05;  // ½((K − 1)/0.05)²
  Model model(task, compile_text(line));
  const Fit found = fit(model, VectorXd::Constant(2, 3.0), {.tolerance = exact});
  const auto [a, y] = line_of(task);
  MatrixXd normal = a.transpose() * a;
  VectorXd right = a.transpose() * y;
  normal(0, 0) += 400.0;
  right[0] += 400.0 * 1.0;
  expect_near(found.x, normal.ldlt().solve(right), told_by_a_cost);
}

TEST(LeastSquares, WeightsOfZeroTakeRowsOut) {
  const Task task = line_task();
  Model model(task, compile_text(line));
  VectorXd weights = VectorXd::Ones(samples);
  weights.tail(samples / 2).setZero();
  weights[3] = 7.0;
  const Fit found = fit(model, model.start(), {.tolerance = exact, .weights = &weights});
  const auto [a, y] = line_of(task);
  const MatrixXd normal = a.transpose() * weights.asDiagonal() * a;
  const VectorXd right = a.transpose() * weights.asDiagonal() * y;
  expect_near(found.x, normal.ldlt().solve(right), told_by_a_cost);
  EXPECT_EQ(found.residuals.size(), samples);  // of all rows, for those held out
}

TEST(LeastSquares, ToldToStopItStandsWhereItIs) {
  const Task task = line_task();
  Model model(task, compile_text(line));
  const VectorXd start = VectorXd::Constant(2, 3.0);
  const Fit at_once = fit(model, start, {.stop = [] { return true; }});
  EXPECT_EQ(at_once.x, start);
  EXPECT_EQ(at_once.residuals.size(), samples);
  EXPECT_FALSE(at_once.converged);
  int asked = 0;
  const Fit after_one = fit(model, start, {.stop = [&] { return ++asked > 1; }});
  EXPECT_EQ(asked, 2);
  EXPECT_LT(after_one.cost, at_once.cost);
  EXPECT_EQ(after_one.cost, cost_of(model, after_one.x, after_one.residuals, nullptr));
}

TEST(LeastSquares, ABoundHoldsAndTheOthersMeetTheRest) {
  Task task = line_task();
  task.known[0].start = -4.0;
  task.known[0].upper = -3.0;
  Model model(task, compile_text(line));
  const Fit found = fit(model, model.start(), {.tolerance = exact});
  const auto [a, y] = line_of(task);
  EXPECT_EQ(found.x[0], -3.0);
  EXPECT_NEAR(found.x[1], (y + 3.0 * a.col(0)).mean(), 1e-9);
}

TEST(LeastSquares, AStartOutOfBoundsIsBroughtWithin) {
  Task task = line_task();
  task.known[1].lower = 0.0;
  task.known[1].upper = 2.0;
  Model model(task, compile_text(line));
  VectorXd start(2);
  start << 1.0, 50.0;
  const Fit found = fit(model, start);
  EXPECT_GE(found.x[1], 0.0);
  EXPECT_LE(found.x[1], 2.0);
}

/// C1, C2 and C3 of C1 + C2·p^C3 lie along a curved valley: from far away, and back to the truth.
TEST(LeastSquares, FollowsTheCurvedValleyOfAPower) {
  const records::Record record =
      test::measured(test::program_of(test::stack()), test::record_of("U", test::rich_voltage(1000)), 0.0);
  Task task;
  task.records = {record};
  task.outputs = {"Y"};
  task.scales = {0.01};
  for (const auto& [path, start] : {std::pair("HYST.C1", 9.0), {"HYST.C2", 0.4}, {"HYST.C3", 2.5}}) {
    task.known.push_back({.path = path, .start = start, .lower = 1e-6, .upper = 10.0, .typical = start});
  }
  Model model(task, compile_text(test::stack()));
  const Fit found = fit(model, model.start(), {.iterations = 60, .tolerance = 1e-10});
  EXPECT_NEAR(found.x[0], 5.0, 1e-4);
  EXPECT_NEAR(found.x[1], 4.0, 1e-4);
  EXPECT_NEAR(found.x[2], 0.8, 1e-4);
}

TEST(LeastSquares, AStartWithoutAValueHasNoCost) {
  const std::string root =
      "FUNCTION_BLOCK ROOT (* @ts 5ms *) VAR_INPUT U : LREAL; K : LREAL := 1.0; (* @param *) END_VAR VAR_OUTPUT Y : "
      "LREAL; END_VAR Y := SQRT(K + 0.0 * U); END_FUNCTION_BLOCK";
  Task task = line_task();
  task.known = {{.path = "K", .start = 1.0, .lower = -infinity, .upper = infinity}};
  Model model(task, compile_text(root));
  EXPECT_EQ(fit(model, VectorXd::Constant(1, -1.0)).cost, infinity);
  EXPECT_LT(fit(model, VectorXd::Constant(1, 1.0)).cost, infinity);
}

}  // namespace
}  // namespace hysteron::diagnosis
