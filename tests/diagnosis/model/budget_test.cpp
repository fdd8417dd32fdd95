// When a search is over: by its work, which is the same everywhere, or by the clock, where that is asked for.
#include "diagnosis/model/budget.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <set>
#include <vector>

namespace hysteron::diagnosis {
namespace {

TEST(Budget, IsOverWhenItsWorkIsDone) {
  const auto effort = std::make_shared<Effort>();
  effort->add(1000);  // before it
  Budget budget(effort, 100.0);
  effort->add(99);
  EXPECT_FALSE(budget.is_over());
  EXPECT_FALSE(budget.has_cut_work());
  effort->add(1);
  EXPECT_TRUE(budget.is_over());
  EXPECT_TRUE(budget.has_cut_work());
  EXPECT_FALSE(budget.has_cut_time());
}

TEST(Budget, WhatBeginsAgainHasItsShare) {
  const auto effort = std::make_shared<Effort>();
  Budget budget(effort, 100.0);
  budget.at_least(0.25);
  effort->add(99);
  EXPECT_FALSE(budget.is_over()) << "no share takes away what is left";
  effort->add(51);
  EXPECT_TRUE(budget.is_over());
  budget.at_least(0.25);
  effort->add(24);
  EXPECT_FALSE(budget.is_over());
  effort->add(1);
  EXPECT_TRUE(budget.is_over());
}

TEST(Budget, TheClockEndsItOnlyWhereItIsAsked) {
  const auto effort = std::make_shared<Effort>();
  Budget of_work(effort, 1e300);
  EXPECT_FALSE(of_work.is_over());
  Budget of_time(effort, 1e300, 0.0);
  EXPECT_TRUE(of_time.is_over());
  EXPECT_TRUE(of_time.has_cut_time());
  EXPECT_FALSE(of_time.has_cut_work());
}

/// Each does 10 units; the budget ends within the second batch, which is done to its end.
TEST(Budget, ABatchIsDoneWholeWithAnyNumberOfThreads) {
  for (const unsigned threads : {1U, 2U, 16U}) {
    const auto effort = std::make_shared<Effort>();
    Budget budget(effort, 705.0);
    std::vector<std::atomic<int>> done(300);
    in_batches(done.size(), threads, &budget, [&](std::size_t i) {
      if (!budget.is_over()) {
        effort->add(10);
        ++done[i];
      }
    });
    for (std::size_t i = 0; i < done.size(); ++i) {
      EXPECT_EQ(done[i], i < 128 ? 1 : 0) << i << " of " << threads;
    }
    EXPECT_TRUE(budget.has_cut_work());
  }
}

TEST(Budget, WorkThatMayNotStopIsNotCut) {
  const auto effort = std::make_shared<Effort>();
  Budget budget(effort, 5.0);
  in_batches(200, 2, &budget, [&](std::size_t /*i*/) { effort->add(10); });
  EXPECT_EQ(effort->spent(), 2000U);
  EXPECT_FALSE(budget.has_cut_work());
}

}  // namespace
}  // namespace hysteron::diagnosis
