// What an online change names, how long its step may take, and what a way back says.
#include "runtime/host/change_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "tests/runtime/host/running_plant.hpp"
#include "tests/runtime/task/integrators.hpp"

namespace hysteron::runtime {
namespace {

using test::integrators;
using test::Plant;
using test::refusal_by;
using test::value;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Y := 0, with a parameter P that has no part in it.
class HiddenParameter final : public StepProgram {
 public:
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override {}
  void step(std::span<const double> /*inputs*/, std::span<double> outputs) noexcept override { outputs[0] = 0.0; }
  void set_parameter(std::size_t /*parameter*/, double value) noexcept override { p_ = value; }
  [[nodiscard]] double parameter(std::size_t /*parameter*/) const noexcept override { return p_; }
  [[nodiscard]] std::size_t state_size() const noexcept override { return 0; }
  void save(std::span<std::byte> /*bytes*/) const noexcept override {}
  void restore(std::span<const std::byte> /*bytes*/) noexcept override {}

 private:
  ProgramShape shape_{.name = "HIDDEN",
                      .period = 1'000'000,
                      .inputs = {{.name = "X"}},
                      .outputs = {{.name = "Y"}},
                      .parameters = {{.name = "P"}},
                      .layout = "hidden"};
  double p_ = 0.0;
};

/// What only the version before has goes on as it was: it is not new.
TEST(ChangeChecks, OnTheWayBackNothingIsNew) {
  Plant plant(integrators({{"A", 0.001}, {"OLD", 0.002}}));
  plant.start();
  EXPECT_THAT(plant.change().change_to(integrators({{"A", 0.001}}), {}).left,
              ElementsAre("OLD.K (gone)", "OLD.Y (gone)"));
  const ChangeReport back = plant.change().change_back({});
  EXPECT_THAT(back.left, IsEmpty());
  EXPECT_THAT(back.as_before, ElementsAre("OLD.K", "OLD.Y"));
}

/// The language knows no case, and a vector is meant by its name.
TEST(ChangeChecks, NamesAreThoseOfTheLanguage) {
  const auto vectors = [] {
    auto program = integrators({{"A", 1.0}, {"B", 2.0}, {"C", 3.0}});
    program->mutable_shape().parameters[1].name = "B.K[1]";
    program->mutable_shape().parameters[2].name = "B.K[2]";
    return program;
  };
  const ChangeWish wish = as_named({.bumps = {{"y", 0.5}}, .as_given = {"b.k", "B.k[2]", "a.K"}}, vectors()->shape());
  EXPECT_THAT(wish.as_given, ElementsAre("B.K[1]", "B.K[2]", "A.K"));
  EXPECT_THAT(wish.bumps, ElementsAre(std::pair<const std::string, double>("Y", 0.5)));
  const auto refused = [&](const ChangeWish& asked) {
    return refusal_by([&] {
      (void)as_named(asked, vectors()->shape());
      return 0;
    });
  };
  EXPECT_EQ(refused({.bumps = {{"y", 0.5}, {"Y", 0.25}}}), "HY730: --bump limits Y twice.");
  EXPECT_EQ(refused({.as_given = {"B"}}), "HY730: The new version has no parameter B.");
  EXPECT_EQ(refused({.bumps = {{"A.K", 1.0}}}), "HY730: There is no output A.K whose jump could be limited.");
}

/// A limit that is off is no number, and comes back as it was.
TEST(ChangeChecks, AParameterThatIsNoNumberIsTakenAsGivenAndBack) {
  const double off = std::numeric_limits<double>::quiet_NaN();
  Plant plant(integrators({{"A", 0.0}, {"B", 0.5}}));
  plant.start();
  ASSERT_EQ(plant.write({{"X", 0.0}}), "");
  plant.run(2);
  auto next = integrators({{"A", 0.0}, {"B", off}});
  next->in_step = [] {};
  EXPECT_THAT(refusal_by([&] { return plant.change().change_to(std::move(next), {.as_given = {"B.K"}}); }),
              HasSubstr("HY851: The output Y would be no number."));
  // As a parameter that no output shows.
  const auto hidden = [](double b) {
    auto program = std::make_unique<HiddenParameter>();
    program->set_parameter(0, b);
    return program;
  };
  Plant other(hidden(0.5));
  other.start();
  (void)other.change().change_to(hidden(off), {.as_given = {"P"}});
  other.run(2);
  EXPECT_TRUE(std::isnan(value(other.door(), "P")));
  EXPECT_THAT(other.change().change_back({}).left, ElementsAre("P (nan is outside of its limits)"));
  other.run(2);
  EXPECT_EQ(value(other.door(), "P"), 0.5);
  (void)other.change().change_back({});
  other.run(2);
  EXPECT_TRUE(std::isnan(value(other.door(), "P")));
}

/// The mean of its steps against the period: refused beyond the limit, by whom it was set, and never waited for longer
/// than a rehearsal may take.
TEST(ChangeChecks, AStepThatTakesTooMuchOfThePeriodIsRefusedOrAllowed) {
  const auto busy = [](std::int64_t nanoseconds) {
    auto program = integrators({{"A", 0.001}, {"B", -0.001}});
    program->in_step = [nanoseconds] {
      for (const std::int64_t until = own_cpu_now() + nanoseconds; own_cpu_now() < until;) {
      }
    };
    return program;
  };
  Plant plant(integrators({{"A", 0.001}, {"B", -0.001}}), 1e300, 0.3);
  plant.start();
  EXPECT_THAT(
      refusal_by([&] { return plant.change().change_to(busy(500'000), {.only_check = true}); }),
      AllOf(HasSubstr("HY853: A step of the new version takes "), HasSubstr(" % of the period of 1ms; the limit is "
                                                                            "30 % (load under [online_change]")));
  EXPECT_THAT(refusal_by([&] { return plant.change().change_to(busy(500'000), {.only_check = true, .load = 0.4}); }),
              HasSubstr("the limit is 40 % (--load)"));
  const ChangeReport allowed = plant.change().change_to(busy(500'000), {.only_check = true, .load = 1.0});
  EXPECT_GE(allowed.load, 0.5);
  EXPECT_EQ(allowed.rehearsed, 1000U);
  EXPECT_EQ(allowed.most_load, 1.0);
  // A second a step: two of them, and not a thousand.
  std::atomic<int> steps{0};
  auto endless = integrators({{"A", 0.001}, {"B", -0.001}});
  endless->in_step = [&] {
    ++steps;
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
  };
  (void)refusal_by([&] { return plant.change().change_to(std::move(endless), {.only_check = true}); });
  EXPECT_LE(steps, 5) << "2 s of 700 ms each, and the one that is compared";
}

}  // namespace
}  // namespace hysteron::runtime
