#include "diagnosis/verdict/run_votes.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t rows_of_output = 240;

Task recorded(std::vector<std::string> outputs) {
  Task task;
  task.records.push_back(records::Record::even(0.0, 0.01, rows_of_output));
  task.outputs = std::move(outputs);
  return task;
}

/// A run that leaves noise of a size at each output.
RunSet leaving(const std::vector<double>& sizes, std::vector<std::string> families, std::size_t effects,
               std::uint64_t seed = 1) {
  test::Noise noise(seed);
  RunSet result{.residuals = VectorXd(static_cast<Index>(rows_of_output * sizes.size())),
                .families = std::move(families),
                .effects = effects};
  for (Index row = 0; row < result.residuals.size(); ++row) {
    result.residuals[row] = sizes[static_cast<std::size_t>(row) / rows_of_output] * noise();
  }
  return result;
}

std::vector<double> votes(const Task& task, const std::vector<RunSet>& sets, const Prior& prior = {}) {
  return votes_of_runs(task, sets, 1, prior, {});
}

TEST(RunVotes, TheRunThatLeavesLeastIsTheMostProbable) {
  const std::vector<double> found =
      votes(recorded({"Y"}), {leaving({1.0}, {"creep"}, 1), leaving({0.5}, {"play"}, 1), leaving({0.9}, {"lag"}, 1)});
  EXPECT_NEAR(std::accumulate(found.begin(), found.end(), 0.0), 1.0, 1e-12);
  EXPECT_GT(found[1], 0.99);
}

TEST(RunVotes, OfRunsAlikeTheSimplerIsLikelierAndTheOtherIsNotRuledOut) {
  const std::vector<double> found =
      votes(recorded({"Y"}), {leaving({1.0}, {"lag"}, 1), leaving({1.0}, {"creep", "lag"}, 2)});
  EXPECT_GT(found[0], found[1]);
  EXPECT_GT(found[1], 0.1);
}

TEST(RunVotes, OfOneFormulaTwiceTheErrorIsTheSame) {
  const std::vector<double> found =
      votes(recorded({"Y"}), {leaving({1.0}, {"lag"}, 1), leaving({1.001}, {"lag"}, 1), leaving({3.0}, {"play"}, 1)});
  EXPECT_EQ(found[0], 1.0);  // nearer in every draw, if by a thousandth
}

/// Each output by its own scale: a tenth less of a small one counts as a tenth less of a large one.
TEST(RunVotes, OutputsCountAlike) {
  const std::vector<double> found =
      votes(recorded({"Y", "Z"}), {leaving({100.0, 0.2}, {"lag"}, 1), leaving({90.0, 1.0}, {"play"}, 1)});
  EXPECT_GT(found[0], 0.99);
}

TEST(RunVotes, SiblingsMakeTheirFamiliesMoreProbable) {
  const std::vector<RunSet> sets{leaving({1.0}, {"lag"}, 1, 1), leaving({1.0}, {"play"}, 1, 2)};
  const Prior prior({{{"play", 1.0}}, {{"play", 1.0}}, {{"play", 1.0}}});
  EXPECT_GT(votes(recorded({"Y"}), sets, prior)[1], votes(recorded({"Y"}), sets)[1] + 0.1);
}

/// A converter between two parts of a machine has to leave half of what another effect leaves, in size.
TEST(RunVotes, AConverterInsideMustBeTwiceAsGood) {
  const auto displaced = [](RunSet set) {
    set.displaced = 1;
    return set;
  };
  const RunSet friction = leaving({1.0}, {"dry_friction"}, 1);
  const Task task = recorded({"Y"});
  EXPECT_GT(votes(task, {friction, leaving({0.6}, {"logging"}, 1)})[1], 0.99);
  EXPECT_LT(votes(task, {friction, displaced(leaving({0.6}, {"logging"}, 1))})[1], 0.1);
  EXPECT_GT(votes(task, {friction, displaced(leaving({0.3}, {"logging"}, 1))})[1], 0.99);
}

/// What a search chose by its run has to leave half of what another leaves, in size; of two such it counts no more.
TEST(RunVotes, WhatWasChosenByItsRunMustBeTwiceAsGood) {
  const auto of_search = [](RunSet set) {
    set.is_own_choice = true;
    return set;
  };
  const RunSet told = leaving({1.0}, {"dry_friction"}, 1);
  const auto against_told = [&](double size) {
    return votes(recorded({"Y"}), {told, of_search(leaving({size}, {"static_curve"}, 1, 2))})[1];
  };
  EXPECT_LT(against_told(0.7), 0.05);
  EXPECT_NEAR(against_told(0.5), 0.5, 0.2);
  EXPECT_GT(against_told(0.35), 0.95);
  const std::vector<double> alone = votes(
      recorded({"Y"}), {of_search(leaving({1.0}, {"play"}, 1)), of_search(leaving({0.7}, {"static_curve"}, 1, 2))});
  EXPECT_GT(alone[1], 0.95);
  const std::vector<RunSet> both{told, of_search(leaving({0.7}, {"play"}, 1, 2))};
  EXPECT_GT(votes_of_runs(recorded({"Y"}), both, 1, {}, Rules({"own choice"}))[1], 0.9);  // without the rule
}

TEST(RunVotes, NoSetHasNoVotes) {
  EXPECT_TRUE(votes(recorded({"Y"}), {}).empty());
}

}  // namespace
}  // namespace hysteron::diagnosis
