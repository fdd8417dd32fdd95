// Rollouts: derivatives by any number of unknowns, and signals that are kept from one rollout to the next.
#include "tuning/rollout.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "tests/tuning/measured_machines.hpp"

namespace hysteron {
namespace {

using detail::Rollout;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace measured_machines;

/// A chain of lags, a loop around two of them, and an output before its end.
constexpr int lags = 9;
std::string chain() {
  std::string instances;
  std::string calls;
  std::string from = "U";
  for (int i = 1; i <= lags; ++i) {
    instances += fmt::format("    G{0} : HY_GAIN := (K := 1.0);\n    L{0} : HY_LAG := (T1 := 0.05);\n", i);
    const std::string back = i == 4 ? " - 0.2 * BACK.XOUT" : "";
    calls += fmt::format("  G{0}(XIN := {1}{2});\n  L{0}(XIN := G{0}.XOUT);\n", i, from, back);
    from = fmt::format("L{}.XOUT", i);
  }
  return "FUNCTION_BLOCK CHAIN (* @ts 10ms *)\n  VAR_INPUT U : LREAL; END_VAR\n"
         "  VAR_OUTPUT Y : LREAL; Z : LREAL; END_VAR\n  VAR\n    BACK : HY_DELAY;\n    PLAY : HY_BACKLASH;\n" +
         instances + "  END_VAR\n" + calls + "  BACK(XIN := L5.XOUT);\n  PLAY(XIN := " + from +
         ");\n  Y := PLAY.XOUT;\n  Z := L3.XOUT;\nEND_FUNCTION_BLOCK\n";
}

/// The parameters of the chain, from its input on; PLAY.WIDTH is the last.
std::vector<std::pair<std::string, std::string>> parameters_of_chain() {
  std::vector<std::pair<std::string, std::string>> list;
  for (int i = 1; i <= lags; ++i) {
    list.emplace_back(fmt::format("G{}", i), "K");
    list.emplace_back(fmt::format("L{}", i), "T1");
  }
  list.emplace_back("PLAY", "WIDTH");
  return list;
}

using Chosen = std::vector<std::pair<std::string, std::string>>;

OutputErrorProblem problem_of_chain(const Chosen& chosen, std::string_view more = {}) {
  std::string settings(more);
  for (const auto& [block, name] : chosen) {
    settings += fmt::format("[fit.{}]\n{} = {{}}\n", block, name);
  }
  std::vector<records::Record> records;
  for (const std::size_t rows : {120UL, 80UL}) {
    records::Record record =
        inputs("U", 0.01, rows, [](double t) { return std::sin(9.0 * t) + 0.3 * std::sin(41.0 * t); });
    record.add({.name = "Y", .values = std::vector<double>(rows, 0.1)});
    record.add({.name = "Z", .values = std::vector<double>(rows, -0.1)});
    records.push_back(std::move(record));
  }
  return problem_of(chain(), settings, std::move(records));
}

/// The unknowns of a problem somewhere about where they start.
VectorXd about_start(const OutputErrorProblem& problem, Index unknowns) {
  VectorXd x = VectorXd::Constant(unknowns, 0.02);
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    x[static_cast<Index>(j)] = problem.parameters[j].start * (1.0 + 0.03 * static_cast<double>(j)) + 0.01;
  }
  return x;
}

MatrixXd jacobian_of(const OutputErrorProblem& problem, const VectorXd& x) {
  Rollout rollout(problem);
  VectorXd residuals(rollout.residual_count());
  MatrixXd jacobian(rollout.residual_count(), rollout.unknowns());
  EXPECT_TRUE(rollout.residuals(x, residuals, &jacobian));
  return jacobian;
}

/// Bits, but for the sign of a zero, which depends on what stands beside it.
bool same(const MatrixXd& a, const MatrixXd& b) {
  return (a.array() == b.array()).all();
}

TEST(Rollout, AColumnDoesNotDependOnThoseBesideIt) {
  const Chosen all = parameters_of_chain();
  const OutputErrorProblem whole = problem_of_chain(all);
  const VectorXd x = about_start(whole, static_cast<Index>(all.size()));
  const MatrixXd jacobian = jacobian_of(whole, x);
  for (std::size_t count = 1; count <= all.size(); ++count) {
    // The first `count` are free, the others hold their values as constants.
    std::string values;
    for (std::size_t j = count; j < all.size(); ++j) {
      values += fmt::format("[parameters.{}]\n{} = {:.17g}\n", all[j].first, all[j].second, x[static_cast<Index>(j)]);
    }
    const OutputErrorProblem part =
        problem_of_chain(Chosen(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)), values);
    const auto columns = static_cast<Index>(count);
    EXPECT_TRUE(same(jacobian_of(part, x.head(columns)), jacobian.leftCols(columns))) << count;
  }
}

/// What a rollout gives that has run nothing before.
VectorXd fresh(const OutputErrorProblem& problem, const VectorXd& x) {
  Rollout rollout(problem);
  VectorXd residuals(rollout.residual_count());
  EXPECT_TRUE(rollout.residuals(x, residuals, nullptr));
  return residuals;
}

void expect_no_memory(const OutputErrorProblem& problem, bool with_jacobians) {
  Rollout rollout(problem);
  VectorXd x = about_start(problem, rollout.unknowns());
  std::mt19937_64 random(7);
  VectorXd residuals(rollout.residual_count());
  MatrixXd jacobian(rollout.residual_count(), rollout.unknowns());
  for (int point = 0; point < 40; ++point) {
    if (point % 10 != 9) {  // now and then the same point once more
      const Index first = static_cast<Index>(random() % static_cast<std::uint64_t>(x.size()));
      const Index count = 1 + static_cast<Index>(random() % 3);
      for (Index j = first; j < std::min(first + count, x.size()); ++j) {
        x[j] *= 1.0 + 0.01 * static_cast<double>(random() % 20);
      }
    }
    const bool derive = with_jacobians && point % 4 == 3;
    ASSERT_TRUE(rollout.residuals(x, residuals, derive ? &jacobian : nullptr));
    ASSERT_TRUE(same(residuals, fresh(problem, x))) << point;
    if (derive) {
      ASSERT_TRUE(same(jacobian, jacobian_of(problem, x))) << point;
    }
  }
}

TEST(Rollout, WhatItKeepsChangesNoBit) {
  const Chosen all = parameters_of_chain();
  for (const bool with_jacobians : {false, true}) {
    expect_no_memory(problem_of_chain(all), with_jacobians);
    expect_no_memory(problem_of_chain({all[4], all[9], all.back()}), with_jacobians);
    expect_no_memory(problem_of_chain({all[15], all.back()}, "[tune]\ninitial_states = [\"L6.RATE1\"]\n"),
                     with_jacobians);
  }
}

TEST(Rollout, KeepsWhatStandsBeforeARestartToo) {
  OutputErrorProblem problem =
      problem_of_chain({{"L8", "T1"}, {"PLAY", "WIDTH"}}, "[tune]\ninitial_states = [\"L7.RATE1\"]\n");
  problem.experiments[0].restarts = {30, 70};
  problem.experiments[1].restarts = {40};
  expect_no_memory(problem, false);
  expect_no_memory(problem, true);
}

/// Points that differ in some unknowns are run side by side, then others: bits are those of each by itself.
void expect_side_by_side(const OutputErrorProblem& problem) {
  Rollout rollout(problem);
  if (!rollout.can_run_side_by_side()) {
    GTEST_SKIP() << "this processor has no registers of 512 bits";
  }
  VectorXd base = about_start(problem, rollout.unknowns());
  std::mt19937_64 random(11);
  for (int batch = 0; batch < 30; ++batch) {
    const auto first = static_cast<Index>(random() % static_cast<std::uint64_t>(base.size()));
    const Index last = std::min<Index>(first + static_cast<Index>(random() % 3), base.size() - 1);
    std::vector<VectorXd> points(1 + random() % lane_count, base);
    for (VectorXd& x : points) {
      for (Index j = first; j <= last; ++j) {
        x[j] *= 1.0 + 0.01 * static_cast<double>(random() % 20);
      }
    }
    const auto lost = random() % (2 * points.size());
    if (lost < points.size()) {
      points[lost][first] = std::numeric_limits<double>::quiet_NaN();
    }
    const auto residuals = rollout.residuals_side_by_side(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      Rollout alone(problem);
      VectorXd expected(alone.residual_count());
      const bool has_value = alone.residuals(points[k], expected, nullptr);
      ASSERT_EQ(residuals[k].has_value(), has_value) << batch;
      ASSERT_TRUE(!has_value || same(*residuals[k], expected)) << batch;
    }
    if (batch % 3 == 2) {
      VectorXd plain(rollout.residual_count());
      base[first] *= 1.01;
      ASSERT_TRUE(rollout.residuals(base, plain, nullptr));
      ASSERT_TRUE(same(plain, fresh(problem, base))) << batch;
    }
  }
}

TEST(Rollout, SideBySideChangesNoBit) {
  const Chosen all = parameters_of_chain();
  expect_side_by_side(problem_of_chain(all));
  expect_side_by_side(problem_of_chain({all[15], all.back()}, "[tune]\ninitial_states = [\"L6.RATE1\"]\n"));
  OutputErrorProblem problem =
      problem_of_chain({{"L8", "T1"}, {"PLAY", "WIDTH"}}, "[tune]\ninitial_states = [\"L7.RATE1\"]\n");
  problem.experiments[0].restarts = {30, 70};
  problem.experiments[1].restarts = {40};
  expect_side_by_side(problem);
}

TEST(Rollout, WhatItForeseesChangesNoBit) {
  const OutputErrorProblem problem = problem_of_chain({{"L2", "T1"}, {"G6", "K"}, {"PLAY", "WIDTH"}});
  Rollout rollout(problem);
  const VectorXd base = about_start(problem, rollout.unknowns());
  VectorXd residuals(rollout.residual_count());
  MatrixXd jacobian(rollout.residual_count(), rollout.unknowns());
  for (Index j = 0; j < base.size(); ++j) {
    std::vector<VectorXd> points(11, base);
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k][j] *= 1.0 + 0.03 * static_cast<double>(k);
    }
    rollout.foresee(points);
    std::swap(points[3], points[9]);  // they are asked for in another order, and two not at all
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
      ASSERT_TRUE(rollout.residuals(points[k], residuals, nullptr));
      ASSERT_TRUE(same(residuals, fresh(problem, points[k]))) << j << " point " << k;
      if (k == 5) {
        ASSERT_TRUE(rollout.residuals(points[8], residuals, &jacobian));
        ASSERT_TRUE(same(jacobian, jacobian_of(problem, points[8]))) << j;
      }
    }
  }
}

TEST(Rollout, WhoAsksOnceMoreGetsTheSame) {
  const OutputErrorProblem problem = problem_of_chain({{"L2", "T1"}, {"G6", "K"}, {"PLAY", "WIDTH"}});
  Rollout rollout(problem);
  std::vector<VectorXd> points(40, about_start(problem, rollout.unknowns()));  // more than are kept
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k][0] *= 1.0 + 0.01 * static_cast<double>(k / 2);  // each point twice
  }
  VectorXd residuals(rollout.residual_count());
  rollout.foresee(points);
  for (const std::size_t k : {0, 1, 0, 20, 21, 39, 0, 2, 39}) {
    ASSERT_TRUE(rollout.residuals(points[k], residuals, nullptr));
    residuals.setZero();  // who was answered may change what it got
    ASSERT_TRUE(rollout.residuals(points[k], residuals, nullptr));
    ASSERT_TRUE(same(residuals, fresh(problem, points[k]))) << k;
  }
  rollout.foresee(points);  // once more, some of them known
  for (const VectorXd& x : points) {
    ASSERT_TRUE(rollout.residuals(x, residuals, nullptr));
    ASSERT_TRUE(same(residuals, fresh(problem, x)));
  }
}

TEST(Rollout, WideRegistersChangeNoDerivative) {
  if (!has_registers_of_eight()) {
    GTEST_SKIP() << "this processor has no registers of 512 bits";
  }
  const OutputErrorProblem problem = problem_of_chain(parameters_of_chain());
  const VectorXd x = about_start(problem, static_cast<Index>(problem.parameters.size()));
  Machine<Dual<7>> narrow(problem.program, 0.01);
  Machine<WideDual> wide(problem.program, 0.01);
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const double value = x[static_cast<Index>(j)];
    const int direction = static_cast<int>(j % 7);
    narrow.set_parameter(problem.parameters[j].parameter, Dual<7>::variable(value, direction));
    wide.set_parameter(problem.parameters[j].parameter, WideDual::variable(value, direction));
  }
  narrow.reset();
  wide.reset();
  for (int k = 0; k < 200; ++k) {
    const double u = std::sin(0.09 * k) + 0.3 * std::sin(0.41 * k);
    narrow.set_input(0, u);
    wide.set_input(0, u);
    narrow.step();
    wide.step();
    for (std::size_t output = 0; output < 2; ++output) {
      const Dual<7> expected = narrow.output(output);
      const WideDual got = wide.output(output);
      ASSERT_EQ(got.value(), expected.value()) << k;
      ASSERT_EQ(got.gradient(), expected.gradient()) << k;
    }
  }
}

TEST(Reach, IsWhatReadsOfAParameterDirectlyOrThroughOthers) {
  const OutputErrorProblem problem = problem_of_chain({{"L5", "T1"}, {"PLAY", "WIDTH"}});
  const detail::Reach reach(problem);
  const auto& nodes = problem.program.graph.nodes;
  const std::vector<bool> still = reach.unreached({0});
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const bool before = nodes[n].path == "G1" || nodes[n].path == "L1" || nodes[n].path == "G2" ||
                        nodes[n].path == "L2" || nodes[n].path == "G3" || nodes[n].path == "L3";
    EXPECT_EQ(still[n], before) << nodes[n].path << ": the loop goes round L4 and L5";
  }
  const detail::WithoutNodes rest = detail::without_nodes(problem.program, still);
  EXPECT_EQ(rest.given.size(), 1U) << "L3.XOUT, for the loop and for Z";
  EXPECT_LT(rest.program.schedule.actions.size(), problem.program.schedule.actions.size() - 5);
}

}  // namespace
}  // namespace hysteron
