#include "diagnosis/evidence/block_regression.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <limits>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

Task one_output(std::size_t samples) {
  Task task;
  task.records.push_back(records::Record::even(0.0, 0.01, samples));
  task.outputs = {"Y"};
  return task;
}

Law free_law(VectorXd response) {
  Law law{.effect = "offset"};
  law.terms.push_back({.strength = "BIAS",
                       .lowest = -std::numeric_limits<double>::infinity(),
                       .highest = std::numeric_limits<double>::infinity()});
  law.responses = std::move(response);
  return law;
}

VectorXd white_column(test::Noise& noise, std::size_t samples) {
  const std::vector<double> values = noise.white(samples, 1.0);
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(samples));
}

TEST(BlockRegression, TheHeldOutEnergyIsThatOfAFitWithoutTheBlock) {
  constexpr std::size_t samples = 90;
  const Task task = one_output(samples);
  const Blocks blocks(task, 1, 6, 1000);
  test::Noise noise(11);
  const auto column = [&] { return white_column(noise, samples); };
  const VectorXd residuals = column();
  const MatrixXd known = column();
  const Law law = free_law(column());
  const Law* const laws[] = {&law};
  const BlockRegression regression(blocks, residuals, known);
  const BlockRegression::Score score = regression.with(laws);
  ASSERT_TRUE(score.allowed);
  ASSERT_EQ(score.held_out.rows(), 6);
  MatrixXd both(samples, 2);
  both << known, law.responses;
  for (const Blocks::Run& run : blocks.runs()) {
    MatrixXd rest = both;
    VectorXd right = residuals;
    rest.middleRows(run.first, run.size).setZero();
    right.segment(run.first, run.size).setZero();
    const VectorXd c = -rest.colPivHouseholderQr().solve(right);
    const double left =
        (residuals.segment(run.first, run.size) + both.middleRows(run.first, run.size) * c).squaredNorm();
    EXPECT_NEAR(score.held_out(static_cast<Index>(run.block), 0), left, 1e-6 * left);
  }
}

/// Where a motion is imposed a friction may be turned round. Two of one family that act against each other make any
/// shape of their difference, with strengths that mean nothing.
TEST(BlockRegression, TwoOfAFamilyOnAnEdgeDoNotActAgainstEachOther) {
  constexpr std::size_t samples = 90;
  const Task task = one_output(samples);
  const Blocks blocks(task, 1, 6, 1000);
  test::Noise noise(12);
  const auto column = [&] { return white_column(noise, samples); };
  Law first = free_law(column());
  first.family = "dry_friction";
  first.edge = "DRIVE.XOUT";
  first.terms.front().lowest = 0.0;
  first.terms.front().either_way = true;
  Law second = first;
  second.responses = column();
  const VectorXd error = 0.1 * column();
  const auto is_allowed = [&](double a, double b) {
    const Law* const laws[] = {&first, &second};
    const VectorXd residuals = error - a * first.responses.col(0) - b * second.responses.col(0);
    return BlockRegression(blocks, residuals, MatrixXd(samples, 0)).with(laws).allowed;
  };
  EXPECT_TRUE(is_allowed(3.0, 2.5));
  EXPECT_TRUE(is_allowed(-3.0, -2.5));
  EXPECT_FALSE(is_allowed(3.0, -2.5));
  EXPECT_FALSE(is_allowed(-3.0, 2.5));
  second.edge = "LOAD.XOUT";
  EXPECT_TRUE(is_allowed(3.0, -2.5));
  second.edge = first.edge;
  second.family = "viscous_friction";
  EXPECT_TRUE(is_allowed(3.0, -2.5));
  first.terms.front().either_way = second.terms.front().either_way = false;
  EXPECT_TRUE(is_allowed(3.0, 2.5));
  EXPECT_FALSE(is_allowed(3.0, -2.5));
}

/// A force that is missing where a machine with dry friction of level 2 moves, and where it rests under a drive that
/// rises and falls between −2 and 2: what holds it there is no function of its speed.
struct SlidesAndRests {
  explicit SlidesAndRests(std::size_t samples)
      : task(one_output(samples)), blocks(task, 1, 6, 1000), missing(samples), jump(samples) {
    law = free_law(VectorXd::Zero(static_cast<Index>(samples)));
    law.terms.front().lowest = 0.0;
    law.slacks = MatrixXd::Zero(static_cast<Index>(samples), 1);
    for (Index k = 0; k < missing.size(); ++k) {
      const bool rests = k % 10 < 5;
      jump[k] = k % 20 < 10 ? 1.0 : -1.0;
      const double held = 1.9 * std::sin(0.7 * static_cast<double>(k));
      missing[k] = rests ? held : -2.0 * jump[k];
      law.responses(k, 0) = rests ? 0.0 : jump[k];
      law.slacks(k, 0) = rests ? 1.0 : 0.0;
    }
  }
  Task task;
  Blocks blocks;
  VectorXd missing;
  VectorXd jump;
  Law law{};
};

TEST(BlockRegression, WhatLiesWithinTheSlackOfALawIsNotLeft) {
  const SlidesAndRests machine(120);
  const BlockRegression regression(machine.blocks, machine.missing, MatrixXd(120, 0));
  const Law* const laws[] = {&machine.law};
  const BlockRegression::Score score = regression.with(laws);
  ASSERT_TRUE(score.allowed);
  EXPECT_NEAR(score.shares[0], 2.0, 1e-7);
  EXPECT_LT(score.held_out.sum(), 1e-12);
  Law sharp = machine.law;
  sharp.responses = machine.jump;
  sharp.slacks.resize(0, 0);
  const Law* const sharp_laws[] = {&sharp};
  EXPECT_GT(regression.with(sharp_laws).held_out.sum(), 0.5 * machine.missing.squaredNorm());
}

/// A friction whose speed has no sign anywhere could hold everything, and says nothing.
TEST(BlockRegression, ALawThatLeavesAllRowsOpenClosesNothing) {
  SlidesAndRests machine(120);
  machine.law.terms.front().lowest = -std::numeric_limits<double>::infinity();
  machine.law.responses.setZero();
  machine.law.slacks.setOnes();
  const BlockRegression regression(machine.blocks, machine.missing, MatrixXd(120, 0), {.is_held_to_tests = true});
  const Law* const laws[] = {&machine.law};
  const BlockRegression::Score score = regression.with(laws);
  ASSERT_TRUE(score.allowed);
  EXPECT_NEAR(score.held_out.sum(), regression.bare().held_out.sum(), 1e-9 * machine.missing.squaredNorm());
}

/// What it leaves where it can be tested is charged where it cannot.
TEST(BlockRegression, OpenRowsAreChargedAsTestedOnes) {
  SlidesAndRests machine(120);
  test::Noise noise(4);
  double tested = 0.0;
  double left = 0.0;
  double open = 0.0;
  for (Index k = 0; k < machine.missing.size(); ++k) {
    if (machine.law.slacks(k, 0) == 0.0) {
      const double error = 0.5 * noise();
      machine.missing[k] += error;
      tested += machine.missing[k] * machine.missing[k];
      left += error * error;
    } else {
      open += machine.missing[k] * machine.missing[k];
    }
  }
  const BlockRegression regression(machine.blocks, machine.missing, MatrixXd(120, 0), {.is_held_to_tests = true});
  const Law* const laws[] = {&machine.law};
  const BlockRegression::Score score = regression.with(laws);
  ASSERT_TRUE(score.allowed);
  EXPECT_NEAR(score.held_out.sum() / (left + left / tested * open), 1.0, 0.1);
}

/// Two nearly equal columns would cancel, and what is between them would be a cause.
TEST(BlockRegression, AKnownParameterMovesNoFurtherThanItsReach) {
  constexpr std::size_t samples = 60;
  const Task task = one_output(samples);
  const Blocks blocks(task, 1, 5, 1000);
  test::Noise noise(5);
  const VectorXd speed = white_column(noise, samples);
  const VectorXd error = 1e-3 * white_column(noise, samples);
  const Law law = free_law(speed + error);
  const Law* const laws[] = {&law};
  const auto is_allowed = [&](double reach) {
    return BlockRegression(blocks, 500.0 * error, speed, {.reach = VectorXd::Constant(1, reach)}).with(laws).allowed;
  };
  EXPECT_FALSE(is_allowed(10.0));
  EXPECT_TRUE(is_allowed(1000.0));
  EXPECT_TRUE(
      BlockRegression(blocks, 500.0 * error, speed, {.reach = VectorXd::Constant(1, 10.0)}).with(laws, false).allowed);
}

TEST(BlockRegression, WhatIsBeyondTheSlackCountsFromItsEdge) {
  SlidesAndRests machine(120);
  machine.missing[12] = 2.7;  // at rest
  const BlockRegression regression(machine.blocks, machine.missing, MatrixXd(120, 0));
  const Law* const laws[] = {&machine.law};
  const BlockRegression::Score score = regression.with(laws);
  ASSERT_TRUE(score.allowed);
  // The convex fit to all rows: 60 that slide, and one at rest that is 2.7 − α beyond its slack.
  EXPECT_NEAR(score.shares[0], (60.0 * 2.0 + 2.7) / 61.0, 1e-7);
  const double alone = 0.7 * 0.7;  // of a fit without its block: 2 all over
  EXPECT_NEAR(score.held_out.row(0).sum(), alone, 1e-6);
}

TEST(BlockRegression, LawsThatTakeEachOtherBackHaveNoSlackTogether) {
  SlidesAndRests machine(120);
  machine.law.terms.front().lowest = -std::numeric_limits<double>::infinity();
  Law other = machine.law;
  other.responses = -machine.law.responses;
  other.slacks = -machine.law.slacks;
  for (Index k = 0; k < machine.missing.size(); ++k) {
    machine.missing[k] *= k % 10 < 5 ? 10.0 : 1.0;  // far more at rest than what slides can hold
  }
  const BlockRegression regression(machine.blocks, machine.missing, MatrixXd(120, 0));
  const Law* const one[] = {&machine.law};
  const Law* const both[] = {&machine.law, &other};
  const double alone = regression.with(one).held_out.sum();
  EXPECT_GT(alone, 1.0);
  EXPECT_GT(regression.with(both, false).held_out.sum(), 0.9 * alone);
}

TEST(BlockRegression, ALawOfTheWrongSignIsNotAllowed) {
  const Task task = one_output(60);
  const Blocks blocks(task, 1, 5, 1000);
  const VectorXd ones = VectorXd::Ones(60);
  Law law = free_law(ones);
  law.terms.front().lowest = 0.0;
  const Law* const laws[] = {&law};
  EXPECT_TRUE(BlockRegression(blocks, -ones, MatrixXd(60, 0)).with(laws).allowed);
  EXPECT_FALSE(BlockRegression(blocks, ones, MatrixXd(60, 0)).with(laws).allowed);
  EXPECT_TRUE(BlockRegression(blocks, ones, MatrixXd(60, 0)).with(laws, false).allowed);
}

TEST(BlockRegression, OutputsCountByWhatTheyLeave) {
  Task task = one_output(60);
  task.outputs = {"Y", "Z"};
  const Blocks blocks(task, 2, 5, 1000);
  VectorXd residuals(120);
  residuals << VectorXd::Constant(60, 1e-3), VectorXd::Constant(60, 1e3);
  BlockRegression regression(blocks, residuals, MatrixXd(120, 0));
  const BlockRegression::Score score = regression.with({});
  EXPECT_NEAR(regression.log_square(score.held_out), 0.5 * (std::log(1e-6) + std::log(1e6)), 1e-9);
}

TEST(Blocks, EveryRecordHasAtLeastOneAndNoSampleIsInTwo) {
  Task task = one_output(100);
  task.records.push_back(records::Record::even(0.0, 0.01, 7));
  const Blocks blocks(task, 1, 10, 50);
  EXPECT_EQ(blocks.stride(), 3U);
  EXPECT_EQ(blocks.rows(), 33 + 2);
  Index next = 0;
  for (const Blocks::Run& run : blocks.runs()) {
    EXPECT_EQ(run.first, next);
    next += run.size;
  }
  EXPECT_EQ(next, blocks.rows());
  VectorXd rising(107);
  for (Index k = 0; k < 107; ++k) {
    rising[k] = static_cast<double>(k < 100 ? k : k - 100);
  }
  const MatrixXd thin = blocks.thinned(rising);
  EXPECT_DOUBLE_EQ(thin(0, 0), 1.0);
  EXPECT_DOUBLE_EQ(thin(33, 0), 1.0);
}

}  // namespace
}  // namespace hysteron::diagnosis
