// How a search for effects ends before its time.
#include "diagnosis/search/search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

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
  SearchOfTwo() {
    task_.scales = {0.001};
    options_.candidates.effects = {"offset", "relaxation"};
  }
  [[nodiscard]] Search search_all() const {
    const Variant bare{.text = input_.text, .program = std::make_shared<const Program>(input_.program)};
    return search(task_, bare, "AXIS", 0.5 * 2000.0, options_);
  }

  static DiagnosisInput input_of_two() {
    std::string machine = test::axis({"HY_RELAXATION := (GAIN := 0.3, T1 := 0.4)", "MASS.XOUT"});
    machine.replace(machine.find("K := 0.5"), 8, "K := 0.5); B : HY_OFFSET := (BIAS := 0.2");
    machine.replace(machine.find("  MASS(XIN := FORCE"), 19, "  B(XIN := FORCE); MASS(XIN := B.XOUT");
    return test::input_of(
        test::axis(), test::axis_parameters,
        {test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), 0.001)});
  }
  DiagnosisInput input_ = input_of_two();
  Task task_ = task_of(input_);
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

TEST_F(SearchOfTwo, TriesEverySingleEffectWithNoTimeAtAll) {
  options_.ends_with_singles = [](const std::vector<Explanation>& /*singles*/) { return true; };
  const std::size_t singles = search_all().tried;
  options_.ends_with_singles = nullptr;
  options_.out_of_time = [] { return true; };
  const Search found = search_all();
  EXPECT_EQ(found.tried, singles);
  EXPECT_THAT(found.explanations, Each(Field(&Explanation::variant, Field(&Variant::effects, SizeIs(1)))));
}

}  // namespace
}  // namespace hysteron::diagnosis
