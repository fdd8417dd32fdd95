// A version that takes over between two steps: by the bits of a run that did the same by hand, and not at all where an
// output would jump.
#include "runtime/task/changeable_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/runtime/task/integrators.hpp"

namespace hysteron::runtime {
namespace {

using test::Integrator;
using test::integrators;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

std::vector<double> random_inputs(std::size_t steps, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> inputs(steps);
  for (double& one : inputs) {
    one = normal(random);
  }
  return inputs;
}

double one_step(StepProgram& program, double input) {
  std::vector<double> outputs(1);
  program.step(std::vector<double>{input}, outputs);
  return outputs[0];
}

std::vector<double> all_steps(StepProgram& program, std::span<const double> inputs) {
  std::vector<double> outputs;
  for (const double input : inputs) {
    outputs.push_back(one_step(program, input));
  }
  return outputs;
}

/// As the host plans one, without its refusals.
struct Change {
  std::unique_ptr<ProgramVersion> version;
  ProposedChange proposed{};
  std::vector<std::string> left{};

  Change(ChangeableProgram& program, std::unique_ptr<StepProgram> next, double most = 1e300) {
    version = std::make_unique<ProgramVersion>(std::move(next), program.shape(), program.parameters());
    plan(program, *version, most);
  }
  Change(ChangeableProgram& program, ProgramVersion& former, double most = 1e300) { plan(program, former, most); }

  void plan(ChangeableProgram& program, ProgramVersion& to, double most) {
    const StepProgram& running = program.version().program();
    StepProgram& next = to.program();
    const KeptLayout kept = read_description(describe(running.shape()), running.state_size());
    proposed.to = &to;
    proposed.parameters = parameters_of(running);
    CarriedValues carried = carry_parameters(kept, proposed.parameters, next.shape(), parameters_of(next));
    set_parameters(next, carried.parameters);
    left = carried.left;
    proposed.shared = shared_state(kept, next.shape(), left);
    proposed.from.resize(running.state_size());
    proposed.start = state_of(next);
    proposed.into = proposed.start;
    proposed.outputs.resize(1);
    proposed.limits = {{.most = most}};
    proposed.bumps.resize(1);
  }
};

/// The change is taken up in the second step from its proposal on.
void settle(ChangeableProgram& program, Change& change) {
  ASSERT_NE(program.taken(), nullptr);
  program.conclude();
  ASSERT_TRUE(program.is_decided());
  if (change.version != nullptr) {
    (void)program.keep(std::move(change.version));
  } else {
    program.keep_former();
  }
}

TEST(ChangeableProgram, AChangeToTheSameVersionChangesNoBit) {
  const auto inputs = random_inputs(400, 1);
  const std::vector<Integrator> parts{{"A", 0.3}, {"B", -1.7}};
  auto plain = integrators(parts);
  const auto expected = all_steps(*plain, inputs);
  for (const std::size_t at : {1U, 2U, 57U, 398U}) {
    ChangeableProgram program(integrators(parts));
    std::vector<double> outputs;
    std::optional<Change> change;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (k + 1 == at) {
        change.emplace(program, integrators(parts), 0.0);
        program.propose(change->proposed);
      }
      outputs.push_back(one_step(program, inputs[k]));
      if (k == at) {
        settle(program, *change);
        EXPECT_THAT(change->left, IsEmpty());
      }
    }
    EXPECT_EQ(outputs, expected) << at;
    EXPECT_EQ(program.version_number(), 2U);
  }
}

/// By hand: the old version up to step k, its state carried as a restart carries it, and the new one from there on.
TEST(ChangeableProgram, AChangeHasTheBitsOfARestartThatLostNothing) {
  const auto inputs = random_inputs(300, 2);
  for (const std::size_t at : {1U, 100U, 299U}) {
    auto old = integrators({{"A", 0.3}, {"GONE", 2.0}, {"B", -1.7}, {"C", 1.0, "mm"}});
    const std::vector<Integrator> after{{"B", 5.0}, {"NEW", 0.01}, {"A", 5.0}, {"C", 1.0, "um"}};
    auto expected = all_steps(*old, std::span(inputs).first(at));
    auto next = integrators(after);
    const std::vector<std::byte> state = state_of(*old);
    std::vector<std::byte> into = state_of(*next);
    const KeptLayout kept = read_description(describe(old->shape()), state.size());
    CarriedValues carried = carry_parameters(kept, parameters_of(*old), next->shape(), parameters_of(*next));
    carry_state(kept, state, next->shape(), into, carried);
    next->restore(into);
    set_parameters(*next, carried.parameters);
    for (const double input : std::span(inputs).subspan(at)) {
      expected.push_back(one_step(*next, input));
    }

    ChangeableProgram program(integrators({{"A", 0.3}, {"GONE", 2.0}, {"B", -1.7}, {"C", 1.0, "mm"}}));
    std::vector<double> outputs;
    std::optional<Change> change;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (k + 1 == at) {
        change.emplace(program, integrators(after));
        program.propose(change->proposed);
      }
      outputs.push_back(one_step(program, inputs[k]));
      if (k == at) {
        EXPECT_EQ(change->left, carried.left);
        settle(program, *change);
      }
    }
    EXPECT_EQ(outputs, expected) << at;
  }
}

TEST(ChangeableProgram, AChangeAndTheChangeBackChangeNoBitOfWhatBothHave) {
  const auto inputs = random_inputs(200, 3);
  auto plain = integrators({{"A", 0.3}, {"B", 1.5}});
  const auto expected = all_steps(*plain, inputs);
  ChangeableProgram program(integrators({{"A", 0.3}, {"B", 1.5}}));
  std::vector<double> outputs;
  std::optional<Change> there;
  std::optional<Change> back;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    if (k == 50) {
      there.emplace(program, integrators({{"NEW", 0.0}, {"B", 9.0}, {"A", 9.0}}));
      program.propose(there->proposed);
    } else if (k == 120) {
      back.emplace(program, *program.former());
      program.propose(back->proposed);
    }
    outputs.push_back(one_step(program, inputs[k]));
    if (k == 51) {
      settle(program, *there);
    } else if (k == 121) {
      settle(program, *back);
    }
  }
  // The order of a sum differs in the version between; its states do not.
  EXPECT_TRUE(std::equal(outputs.begin() + 121, outputs.end(), expected.begin() + 121));
  EXPECT_TRUE(std::equal(outputs.begin(), outputs.begin() + 51, expected.begin()));
  EXPECT_EQ(program.version_number(), 3U);
}

/// With a limit below the jump nothing happens, to no bit; with one above, the change is taken.
TEST(ChangeableProgram, AnOutputThatWouldJumpKeepsTheOldVersion) {
  const auto inputs = random_inputs(100, 4);
  for (const bool is_allowed : {false, true}) {
    auto plain = integrators({{"A", 1.0}, {"B", 2.0}});
    const auto expected = all_steps(*plain, inputs);
    ChangeableProgram program(integrators({{"A", 1.0}, {"B", 2.0}}));
    std::vector<double> outputs = all_steps(program, std::span(inputs).first(40));
    // Without B, Y loses what B had summed, and its part of the step itself.
    auto alone = integrators({{"A", 1.0}});
    const double jump = std::abs(all_steps(*alone, std::span(inputs).first(42)).back() - expected[41]);
    Change change(program, integrators({{"A", 1.0}}), is_allowed ? jump * 1.001 : jump * 0.999);
    program.propose(change.proposed);
    for (const double input : std::span(inputs).subspan(40)) {
      outputs.push_back(one_step(program, input));
      if (program.taken() != nullptr) {
        program.conclude();
      }
    }
    ASSERT_TRUE(program.is_decided());
    EXPECT_NEAR(change.proposed.bumps[0].size, jump, 1e-12);
    EXPECT_EQ(change.proposed.verdict, is_allowed ? ChangeVerdict::taken : ChangeVerdict::bump);
    EXPECT_EQ(outputs == expected, !is_allowed);
    EXPECT_EQ(program.version_number(), is_allowed ? 2U : 1U);
  }
}

TEST(ChangeableProgram, ValuesAreComparedAsTheTaskLimitsThem) {
  const BumpLimit limit{.most = 1.0, .low = 0.0, .high = 10.0};
  EXPECT_EQ(bump_of(9.5, 30.0, limit).size, 0.5);
  EXPECT_EQ(bump_of(12.0, 30.0, limit).size, 0.0);
  EXPECT_EQ(bump_of(-5.0, 3.0, limit).size, 3.0);
  EXPECT_FALSE(bump_of(1.0, no_value, limit).is_within(limit));
  EXPECT_FALSE(bump_of(no_value, std::numeric_limits<double>::infinity(), limit).is_within(limit));
  // What was no number is safe on its way out already: any number is better.
  EXPECT_TRUE(bump_of(no_value, 3.0, limit).is_within(limit));
  EXPECT_TRUE(bump_of(1.0, 1.0, {}).is_within({}));
  EXPECT_FALSE(bump_of(1.0, std::nextafter(1.0, 2.0), {}).is_within({}));
}

TEST(ChangeableProgram, AStateThatIsNotFiniteStaysBehind) {
  ChangeableProgram program(integrators({{"A", 1.0}, {"B", 1.0}}));
  (void)one_step(program, 1.0);
  (void)one_step(program, std::numeric_limits<double>::infinity());
  Change change(program, integrators({{"A", 1.0}, {"B", 1.0}}), 0.0);
  program.propose(change.proposed);
  (void)one_step(program, 0.0);
  EXPECT_EQ(one_step(program, 0.25), 0.5);
  settle(program, change);
}

TEST(ChangeableProgram, ParametersThatCameAfterThePlanWithholdTheChange) {
  ChangeableProgram program(integrators({{"A", 1.0}}));
  Change change(program, integrators({{"A", 1.0}}), 0.0);
  program.propose(change.proposed);
  (void)one_step(program, 1.0);
  program.set_parameter(0, 2.0);
  EXPECT_EQ(one_step(program, 1.0), 3.0);
  EXPECT_EQ(program.taken(), nullptr);
  ASSERT_TRUE(program.is_decided());
  EXPECT_EQ(change.proposed.verdict, ChangeVerdict::other_values);
  EXPECT_EQ(program.parameter(0), 2.0);
}

/// What servers reach stays in its place; what is no more keeps its value, and does nothing.
TEST(ChangeableProgram, ParametersAndInnerSignalsKeepTheirPlaces) {
  ChangeableProgram program(integrators({{"A", 1.0}, {"B", 2.0}, {"C", 3.0, "mm"}}));
  (void)one_step(program, 1.0);
  Change change(program, integrators({{"C", 30.0, "mm"}, {"NEW", 5.0}, {"A", 10.0}}));
  program.propose(change.proposed);
  (void)one_step(program, 1.0);
  (void)one_step(program, 1.0);
  settle(program, change);
  EXPECT_THAT(parameters_of(program), ElementsAre(1.0, 2.0, 3.0));
  program.set_parameter(0, -1.0);
  program.set_parameter(1, -2.0);
  program.set_parameter(2, -3.0);
  EXPECT_THAT(parameters_of(program), ElementsAre(-1.0, 2.0, -3.0));
  EXPECT_THAT(parameters_of(program.version().program()), ElementsAre(-3.0, 5.0, -1.0));
  std::vector<double> inner(3);
  program.inner_values(inner);
  EXPECT_EQ(inner[0], 3.0);
  EXPECT_TRUE(std::isnan(inner[1]));
  EXPECT_EQ(inner[2], 9.0);
  EXPECT_EQ(program.shape().parameters.size(), 3U);
}

TEST(ChangeableProgram, AProposalThatNoStepTookUpCanBeWithdrawn) {
  ChangeableProgram program(integrators({{"A", 1.0}}));
  for (const int steps : {0, 1}) {
    Change change(program, integrators({{"A", 1.0}, {"B", 7.0}}));
    program.propose(change.proposed);
    for (int i = 0; i < steps; ++i) {
      (void)one_step(program, 0.0);
    }
    EXPECT_TRUE(program.withdraw());
  }
  EXPECT_EQ(one_step(program, 1.0), 1.0);
  EXPECT_EQ(one_step(program, 1.0), 2.0);
  EXPECT_EQ(program.taken(), nullptr);
  EXPECT_EQ(program.version_number(), 1U);
}

TEST(ChangeableProgram, AnImageIsWhatAStepBeganWithAndGave) {
  ChangeableProgram program(integrators({{"A", 2.0}}));
  (void)one_step(program, 1.0);
  StepImage image{.parameters = {0.0}, .state = std::vector<std::byte>(16), .inputs = {0.0}, .outputs = {0.0}};
  EXPECT_FALSE(program.has_image());
  program.ask_for_image(image);
  EXPECT_FALSE(program.has_image());
  (void)one_step(program, 3.0);
  (void)one_step(program, 100.0);
  ASSERT_TRUE(program.has_image());
  auto again = integrators({{"A", 0.0}});
  again->restore(image.state);
  again->set_parameter(0, image.parameters[0]);
  EXPECT_THAT(image.inputs, ElementsAre(3.0));
  EXPECT_THAT(image.outputs, ElementsAre(8.0));
  EXPECT_EQ(one_step(*again, image.inputs[0]), image.outputs[0]);
  program.ask_for_image(image);
  EXPECT_TRUE(program.withdraw_image());
  (void)one_step(program, 5.0);
  EXPECT_FALSE(program.has_image());
}

}  // namespace
}  // namespace hysteron::runtime
