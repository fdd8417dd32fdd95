// How a search for effects ends before its time.
#include "diagnosis/search/search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "diagnosis/model/budget.hpp"
#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::SizeIs;

/// An axis with two effects, of which neither explains the other.
class SearchOfTwo : public testing::Test {
 protected:
  SearchOfTwo() { options_.candidates.effects = {"offset", "relaxation"}; }
  [[nodiscard]] Search search_all() const { return search_all(task_); }
  [[nodiscard]] Search search_all(const Task& task) const {
    const Variant bare{.text = input_.text, .program = std::make_shared<const Program>(input_.program)};
    return search(task, bare, "AXIS", 0.5 * 2000.0, options_);
  }

  static DiagnosisInput input_of_two() {
    std::string machine = test::axis({"HY_RELAXATION := (GAIN := 0.3, T1 := 0.4)", "MASS.XOUT"});
    machine.replace(machine.find("K := 0.5"), 8, "K := 0.5); B : HY_OFFSET := (BIAS := 0.2");
    machine.replace(machine.find("  MASS(XIN := FORCE"), 19, "  B(XIN := FORCE); MASS(XIN := B.XOUT");
    return test::input_of(
        test::axis(), test::axis_parameters,
        {test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), 0.001)});
  }
  [[nodiscard]] Task new_task() const {
    Task task = task_of(input_);
    task.scales = {0.001};
    return task;
  }
  DiagnosisInput input_ = input_of_two();
  Task task_ = new_task();
  SearchOptions options_{};
};

TEST_F(SearchOfTwo, FindsBoth) {
  EXPECT_THAT(search_all().explanations.front().names(), ElementsAre("offset", "relaxation"));
}

TEST_F(SearchOfTwo, EndsWithTheSinglesWhereTheRecordIsToBeMendedFirst) {
  int asked = 0;
  double best = 0.0;
  options_.ends_with_singles = [&](const std::vector<Explanation>& singles) {
    ++asked;
    best = singles.front().fit.cost;
    return true;
  };
  const Search found = search_all();
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(best, found.explanations.front().fit.cost);
  EXPECT_THAT(found.explanations, Each(Field(&Explanation::variant, Field(&Variant::effects, SizeIs(1)))));
}

TEST_F(SearchOfTwo, TriesEverySingleEffectWithNoWorkLeft) {
  options_.ends_with_singles = [](const std::vector<Explanation>& /*singles*/) { return true; };
  const std::size_t singles = search_all().tried;
  options_.ends_with_singles = nullptr;
  Budget none(task_.effort, 0.0);
  options_.budget = &none;
  const Search found = search_all();
  EXPECT_EQ(found.tried, singles);
  EXPECT_THAT(found.explanations, Each(Field(&Explanation::variant, Field(&Variant::effects, SizeIs(1)))));
}

/// Where the budget ends a search is counted in work: the sets it has found then, to the last bit of their fits.
TEST_F(SearchOfTwo, ACutSearchFindsTheSameWithAnyNumberOfThreads) {
  const auto found_with = [&](unsigned threads, double work) {
    const Task task = new_task();
    Budget budget(task.effort, work);
    options_.threads = threads;
    options_.budget = &budget;
    const Search found = search_all(task);
    std::vector<std::pair<std::vector<std::string>, double>> sets;
    for (const Explanation& one : found.explanations) {
      sets.emplace_back(one.places(), one.fit.cost);
    }
    return std::tuple(sets, task.effort->spent(), budget.has_cut_work());
  };
  const double whole = static_cast<double>(std::get<1>(found_with(2, infinity)));
  for (const double share : {0.3, 0.6, 0.9}) {
    const auto with_one = found_with(1, share * whole);
    EXPECT_TRUE(std::get<2>(with_one)) << share;
    EXPECT_EQ(found_with(2, share * whole), with_one) << share;
    EXPECT_EQ(found_with(7, share * whole), with_one) << share;
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
