// Goals whose optimum is known by hand, limits that bind, plants that differ, and starts that are unstable.
#include "tuning/goal/goal_search.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "support/errors.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/tuning/goal/loops.hpp"
#include "tuning/goal/contradiction.hpp"
#include "tuning/goal/slowness.hpp"

namespace hysteron {
namespace {

using std::numbers::pi;

/// The gain at which the loop of an integrator is the wished lag: 1 − TS·K = e^(−TS/T), T = settling/ln 50.
double gain_for(double settling) {
  return (1.0 - std::exp(-loops::ts * std::log(50.0) / settling)) / loops::ts;
}

std::string settings_of_gain(double start, const std::string& goal, const std::string& fit = "{min = 0.0}") {
  return fmt::format("[parameters.P]\nK = {}\n[fit.P]\nK = {}\n[goal]\norder = 1\nloop = \"P.XOUT\"\n{}", start, fit,
                     goal);
}

TEST(GoalSearch, FindsTheGainThatMeetsTheWishExactly) {
  for (const double start : {0.3, 4.0, 60.0}) {
    const GoalProblem problem =
        loops::problem_of(loops::integrator(), settings_of_gain(start, "settling_time = 0.5\n"));
    const GoalResult result = tune_for_goal(problem);
    EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
    EXPECT_NEAR(result.x[0], gain_for(0.5), 1e-3 * gain_for(0.5)) << start;
    EXPECT_LT(result.plants[0].after.error, 1e-4);
    EXPECT_NEAR(result.plants[0].after.settling_time, 0.5, 2.0 * loops::ts);
  }
}

/// The largest effort of the step is K·1, at once: a limit on it is a limit on K.
TEST(GoalSearch, KeepsALimitOnTheEffortAndReachesIt) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(), settings_of_gain(2.0, "settling_time = 0.5\n[goal.limits]\neffort = 5.0\n"));
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
  EXPECT_LE(result.x[0], 5.0);
  EXPECT_NEAR(result.x[0], 5.0, 5e-3);
  EXPECT_TRUE(result.limits[0].is_kept);
  EXPECT_TRUE(result.limits[0].is_active);
}

/// With d delays, φ = 90° − (d + ½)·w and TS·K = 2·sin(w/2): the gain that a phase margin allows.
TEST(GoalSearch, ReachesThePhaseMarginAndNoLess) {
  constexpr int delays = 6;
  constexpr double margin = 65.0;
  const double w = (90.0 - margin) / 180.0 * pi / (delays + 0.5);
  const double allowed = 2.0 * std::sin(0.5 * w) / loops::ts;
  for (const double start : {1.0, 14.0}) {
    const GoalProblem problem =
        loops::problem_of(loops::integrator(delays),
                          settings_of_gain(start, "settling_time = 0.3\n[goal.limits]\nphase_margin_deg = 65.0\n"));
    const GoalResult result = tune_for_goal(problem);
    EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
    EXPECT_GE(result.limits[0].value, margin);
    EXPECT_NEAR(result.x[0], allowed, 2e-3 * allowed) << start;
  }
}

TEST(GoalSearch, ReachesALimitOnTheSensitivity) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(6), settings_of_gain(1.0, "settling_time = 0.3\n[goal.limits]\nsensitivity = 1.5\n"));
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
  EXPECT_LE(result.limits[0].value, 1.5);
  // |1 + L| of the closed form, its least over the frequency
  double least = 1e9;
  for (double at = 1e-3; at < pi; at += 1e-4) {
    least = std::min(
        least, std::abs(1.0 + loops::ts * result.x[0] * std::polar(1.0, -6.0 * at) / (std::polar(1.0, at) - 1.0)));
  }
  EXPECT_NEAR(1.0 / least, 1.5, 2e-3);
}

/// Integrators of gain 0.5 and 2: the worst error over K, by trying them all.
TEST(GoalSearch, OfSeveralPlantsTheWorstCounts) {
  const test::ScratchFolder folder;
  const std::string light = folder.write("light.toml", "[parameters.BODY]\nK = 2.0\n");
  const std::string heavy = folder.write("heavy.toml", "[parameters.BODY]\nK = 0.5\n");
  const auto both = [&](const std::string& robust) {
    return loops::problem_of(loops::integrator(),
                             fmt::format("[parameters.P]\nK = 1.0\n[fit.P]\nK = {{min = 0.0}}\n[goal]\norder = 1\n"
                                         "settling_time = 0.5\nplants = [\"{}\", \"{}\"]\nrobust = \"{}\"\n",
                                         light, heavy, robust));
  };
  for (const std::string robust : {"worst", "mean"}) {
    const GoalProblem problem = both(robust);
    const GoalResult result = tune_for_goal(problem);
    EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
    GoalModel model(problem);
    double best = 1e9;
    double best_gain = 0.0;
    for (double gain = 1.0; gain < 20.0; gain += 0.002) {
      ASSERT_EQ(model.evaluate(Eigen::VectorXd::Constant(1, gain), false), LoopState::Settles);
      if (model.cost() < best) {
        best = model.cost();
        best_gain = gain;
      }
    }
    EXPECT_NEAR(result.x[0], best_gain, 5e-3) << robust;
    if (robust == "worst") {
      EXPECT_NEAR(result.plants[0].after.error, result.plants[1].after.error, 1e-3) << "at a minimax both are equal";
    }
  }
}

TEST(GoalSearch, LeavesAnUnstableStart) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(), settings_of_gain(250.0, "settling_time = 0.5\n", "{min = 0.1, max = 300.0}"));
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.start_state, LoopState::Unstable);
  EXPECT_FALSE(result.plants[0].before);
  EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
  EXPECT_NEAR(result.x[0], gain_for(0.5), 1e-3 * gain_for(0.5));
}

int number_of_refusal(const std::function<void()>& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.diagnostics().all().front().number;
  }
  return 0;
}

TEST(GoalSearch, SaysThatNothingIsStable) {
  EXPECT_EQ(number_of_refusal([] {
              (void)tune_for_goal(loops::problem_of(
                  loops::integrator(), settings_of_gain(250.0, "settling_time = 0.5\n", "{min = 220.0, max = 300.0}")));
            }),
            error::no_stable_loop);
}

TEST(GoalSearch, SaysThatNoLoopPasses) {
  const std::string beside = "[fit.P]\nK = {}\n[goal]\nsettling_time = 1.0\nloop = \"BESIDE.XOUT\"\n";
  EXPECT_EQ(number_of_refusal([&] { (void)tune_for_goal(loops::problem_of(loops::integrator(), beside)); }),
            error::no_loop_there);
}

/// Below 0 < TS·K < 2 the effort is at least the lower bound of K: a limit under it cannot be kept.
TEST(GoalSearch, NamesTheLimitThatCannotBeKept) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(),
      settings_of_gain(8.0, "settling_time = 0.5\n[goal.limits]\neffort = 2.0\n", "{min = 4.0, max = 20.0}"));
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Contradiction);
  EXPECT_FALSE(result.limits[0].is_kept);
  EXPECT_NEAR(result.x[0], 4.0, 1e-3);
  EXPECT_EQ(result.at_bound[0], AtBound::Lower);
  EXPECT_FALSE(result.is_held_by_test);
  EXPECT_GT(result.limits[0].against, 0.9);
}

/// K from 0.1 on keeps each of these limits. Below K = 0.445 the loop settles too slowly for a test of 1.5 s: a bound
/// that nobody gave, and no contradiction.
TEST(GoalSearch, NamesATestThatIsTooShortForItsLimits) {
  const auto problem_of = [](double start, const std::string& duration, const std::string& limit) {
    return loops::problem_of(loops::integrator(),
                             settings_of_gain(start, "settling_time = 0.5\n" + duration + "[goal.limits]\n" + limit,
                                              "{min = 0.1, max = 50.0}"));
  };
  for (const std::string limit :
       {"effort = 0.3\n", "effort = 0.01\n", "gain_margin_db = 60.0\n", "phase_margin_deg = 89.9\n"}) {
    for (const double start : {0.2, 1.0}) {
      const GoalProblem problem = problem_of(start, "", limit);
      const GoalResult result = tune_for_goal(problem);
      EXPECT_EQ(result.status, GoalStatus::Contradiction) << limit;
      EXPECT_TRUE(result.is_held_by_test) << limit << start << " at " << result.x[0];
      EXPECT_THAT(result.message, ::testing::HasSubstr("settles too slowly for the length of the test, 1.5 s"));
      Diagnostics said;
      report_contradiction(problem, result, said);
      ASSERT_EQ(said.all().size(), 1U);
      EXPECT_THAT(said.all()[0].cause, ::testing::HasSubstr("whose loop settles within the test")) << limit;
      EXPECT_THAT(said.all()[0].mend, ::testing::StartsWith("let the test last longer than its 1.5 s")) << limit;
      EXPECT_THAT(said.all()[0].mend, ::testing::Not(::testing::HasSubstr("--start"))) << limit;
    }
    const GoalResult longer = tune_for_goal(problem_of(0.2, "duration = 40.0\n", limit));
    EXPECT_FALSE(longer.is_held_by_test) << limit;
    const bool is_kept = limit != "effort = 0.01\n";
    EXPECT_EQ(longer.status, is_kept ? GoalStatus::Tuned : GoalStatus::Contradiction) << limit << longer.message;
    EXPECT_TRUE(is_kept || longer.x[0] == 0.1) << longer.x[0];
  }
}

/// Both gains make the loop, and the first alone its effort: K of P below 0.06 settles within the test where K of BODY
/// is above 7.4. The search has to slide along the loops that are too slow.
TEST(GoalSearch, SlidesAlongLoopsThatAreTooSlow) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(),
      settings_of_gain(1.0, "settling_time = 0.5\n[goal.limits]\neffort = 0.06\n", "{min = 0.001, max = 50.0}") +
          "[fit.BODY]\nK = {min = 0.1, max = 10.0}\n");
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message << result.x.transpose();
  EXPECT_TRUE(result.limits[0].is_kept);
}

/// A pole p: h = 1, p − 1, …, of size ∝ pᵏ, so that what is asked for is 0.75·N·ln p = ln(10⁻⁷) less a constant.
TEST(Slowness, IsThatOfThePole) {
  LoopResponse response;
  const std::size_t watched = 4000;
  for (const double pole : {0.985, 0.992}) {
    response.impulse = {1.0};
    for (std::size_t k = 1; k < 2048; ++k) {
      response.impulse.push_back((pole - 1.0) * std::pow(pole, static_cast<double>(k - 1)));
    }
    // ∂h/∂p, of which the envelope takes the logarithm.
    response.impulse_by = Eigen::MatrixXd::Zero(2048, 1);
    for (Eigen::Index k = 1; k < 2048; ++k) {
      const auto power = static_cast<double>(k - 1);
      response.impulse_by(k, 0) = std::pow(pole, power) + (pole - 1.0) * power * std::pow(pole, power - 1.0);
    }
    const auto exact = [&](double p) {
      return (std::log(1.0 - p) + (0.75 * static_cast<double>(watched) - 1.0) * std::log(p) - std::log(1e-7)) /
             -std::log(1e-7);
    };
    const Margin found = slowness(response, watched);
    EXPECT_NEAR(found.value, std::max(exact(pole) + 0.005, -1.0), 1e-9) << pole;
    if (found.value > -1.0) {
      EXPECT_NEAR(found.by[0], (exact(pole + 1e-6) - exact(pole - 1e-6)) / 2e-6, 1e-3 * std::fabs(found.by[0]));
    }
  }
}

/// y(k+1) = A·y(k) + B·u(k), A = 1.05, B = 0.05, runs away by itself. Ms ≤ 1.2 needs B·K ≥ (A − 1)·(1 + 1/1.2), that is
/// K ≥ 1.83; a first step of the effort of 1.5, a rate of 150/s, needs K ≤ 1.5.
constexpr std::string_view unstable_plant = R"(FUNCTION_BLOCK LOOP  (* @ts 10ms *)
  VAR_INPUT SP : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR P : HY_GAIN := (K := 1.7); STATE : HY_DELAY; END_VAR
  P(XIN := SP - STATE.XOUT);
  Y := STATE.XOUT;
  STATE(XIN := 1.05 * STATE.XOUT + 0.05 * P.XOUT);
END_FUNCTION_BLOCK
)";

TEST(GoalSearch, NamesTheLimitsThatStandAgainstEachOther) {
  const GoalProblem problem = loops::problem_of(unstable_plant, R"([fit.P]
K = {min = 0.0}
[goal]
settling_time = 1.0
duration = 3.0
loop = "P.XOUT"
[goal.limits]
effort_rate = 150.0
sensitivity = 1.2
phase_margin_deg = 5.0
)");
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Contradiction) << result.message;
  EXPECT_FALSE(result.limits[0].is_kept);
  EXPECT_FALSE(result.limits[2].is_kept);
  EXPECT_GT(result.limits[0].against, 0.1);
  EXPECT_GT(result.limits[2].against, 0.05);
  EXPECT_EQ(result.limits[1].against, 0.0) << "a limit that is far away is no part of it";
  // The least largest excess: K/1.5 − 1 = ln(Ms/1.2)/ln 1.2, Ms = 0.05/(0.05·K − 0.05).
  const double k = result.x[0];
  EXPECT_NEAR(k / 1.5 - 1.0, std::log(1.0 / (k - 1.0) / 1.2) / std::log(1.2), 2e-3);
}

TEST(GoalSearch, WithoutLimitsAndWithoutALoopTunesAllTheSame) {
  const GoalProblem problem =
      loops::problem_of(loops::integrator(),
                        "[parameters.P]\nK = 3.0\n[fit.P]\nK = {min = 0.0}\n[goal]\norder = 1\nsettling_time = 0.5\n");
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Tuned);
  EXPECT_NEAR(result.x[0], gain_for(0.5), 1e-3 * gain_for(0.5));
  EXPECT_FALSE(result.plants[0].after.margins);
}

/// The pole 1 − TS·K: at K = 0.001 it dies away, at K = −1 it grows, at K = 210 it swings up.
TEST(GoalSearch, TellsALoopThatIsSlowFromOneThatIsUnstable) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(), settings_of_gain(0.001, "settling_time = 0.5\n", "{min = -5.0, max = 300.0}"));
  GoalModel model(problem);
  for (const auto& [gain, state] : {std::pair(0.001, LoopState::TooSlow),
                                    {-1.0, LoopState::Unstable},
                                    {210.0, LoopState::Unstable},
                                    {5.0, LoopState::Settles}}) {
    EXPECT_EQ(model.evaluate(Eigen::VectorXd::Constant(1, gain), false), state) << gain;
  }
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.start_state, LoopState::TooSlow);
  EXPECT_NEAR(result.x[0], gain_for(0.5), 1e-3 * gain_for(0.5));
}

TEST(GoalSearch, SaysThatALongerTestIsWanted) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(), settings_of_gain(0.001, "settling_time = 0.5\n", "{min = 0.0005, max = 0.01}"));
  try {
    (void)tune_for_goal(problem);
    FAIL() << "no loop settles";
  } catch (const InputError& refused) {
    const Diagnostic& said = refused.diagnostics().all().front();
    EXPECT_EQ(said.number, error::no_stable_loop);
    EXPECT_THAT(said.cause, ::testing::HasSubstr("settles too slowly"));
    EXPECT_THAT(said.mend, ::testing::HasSubstr("last longer than its 1.5 s"));
  }
}

/// Most of the range is unstable, so that further starts find nothing.
TEST(GoalSearch, KeepsAResultWhereAFurtherStartFindsNoLoop) {
  const GoalProblem problem = loops::problem_of(
      loops::integrator(), settings_of_gain(5.0, "settling_time = 0.5\n", "{min = 4.999999, max = 1e300}"));
  const GoalResult result = tune_for_goal(problem, {.starts = 3});
  EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
  EXPECT_EQ(result.best_start, 0);
  EXPECT_NEAR(result.x[0], gain_for(0.5), 1e-3 * gain_for(0.5));
  ASSERT_EQ(result.start_errors.size(), 3U);
  EXPECT_TRUE(std::isinf(result.start_errors[1])) << result.start_errors[1];
}

TEST(GoalSearch, SaysThatAParameterEndsOnItsBound) {
  for (const auto& [start, bounds, bound] :
       {std::tuple(1.0, "{min = 0.0, max = 5.0}", 5.0), {60.0, "{min = 20.0, max = 100.0}", 20.0}}) {
    const GoalResult result =
        tune_for_goal(loops::problem_of(loops::integrator(), settings_of_gain(start, "settling_time = 0.5\n", bounds)));
    EXPECT_EQ(result.x[0], bound);
    EXPECT_EQ(result.at_bound[0], bound == 5.0 ? AtBound::Upper : AtBound::Lower);
  }
}

/// On the bound itself the effort would be 5, which the limit forbids by a hair: the result stands beside it.
TEST(GoalSearch, AParameterBesideABoundThatALimitForbidsIsAtItsBound) {
  const GoalResult result = tune_for_goal(loops::problem_of(
      loops::integrator(), settings_of_gain(1.0, "settling_time = 0.5\n[goal.limits]\neffort = 4.9999999\n",
                                            "{min = 0.0, max = 5.0, scale = 10.0}")));
  EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
  EXPECT_LT(result.x[0], 5.0);
  EXPECT_GT(result.x[0], 4.999);
  EXPECT_EQ(result.at_bound[0], AtBound::Upper);
}

/// The length that is wrong is the one that is told.
TEST(GoalSearch, SaysWhichLengthATestCannotHave) {
  const auto cause = [](const std::string& goal) {
    try {
      (void)loops::problem_of(loops::integrator(), settings_of_gain(1.0, goal));
      return std::string();
    } catch (const InputError& refused) {
      return refused.diagnostics().all().front().cause;
    }
  };
  EXPECT_EQ(cause("settling_time = 0.5\nduration = 0.05\n"), "The test lasts 0.05 s, 5 steps of the diagram.");
  EXPECT_EQ(cause("settling_time = 20000.0\nduration = 20000.0\n"),
            "The test lasts 6e+04 s, 6e+06 steps of the diagram, since limits count over three settling times.");
}

/// What a limit is held against does not depend on how long the error is watched.
TEST(GoalSearch, AShortTestDoesNotHideALaterOvershoot) {
  const auto problem_of = [](const std::string& duration) {
    return loops::problem_of(loops::oven,
                             "[fit.PID]\nKP = {min = 0.01, max = 20.0}\nTR = {min = 0.1}\n[goal]\n"
                             "settling_time = 2.0\nloop = \"PID.XOUT\"\n" +
                                 duration + "[goal.limits]\novershoot_percent = 4.0\n");
  };
  const GoalProblem whole = problem_of("");
  const GoalProblem brief = problem_of("duration = 2.0\n");
  GoalModel of_whole(whole);
  GoalModel of_brief(brief);
  const Eigen::VectorXd x = Eigen::Vector2d(1.6, 1.3);  // swings about its set point
  ASSERT_EQ(of_whole.evaluate(x, false), LoopState::Settles);
  ASSERT_EQ(of_brief.evaluate(x, false), LoopState::Settles);
  const Signal& y = of_whole.response(0).output;
  const auto behind = y.begin() + static_cast<std::ptrdiff_t>(brief.end);
  ASSERT_GT(*std::max_element(behind, y.end()), *std::max_element(y.begin(), behind)) << "the overshoot comes later";
  EXPECT_EQ(of_brief.value_of(0, 0), of_whole.value_of(0, 0));
  EXPECT_GT(of_brief.largest_excess(), 0.0);
  EXPECT_NE(of_brief.cost(), of_whole.cost());
}

TEST(GoalSearch, NamesNoLimitThatIsKept) {
  const GoalProblem problem =
      loops::problem_of(loops::integrator(6), settings_of_gain(12.0,
                                                               "settling_time = 0.5\n[goal.limits]\neffort = 5.0\n"
                                                               "effort_rate = 1e6\nphase_margin_deg = 20.0\n",
                                                               "{min = 8.0, max = 20.0}"));
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Contradiction);
  for (const LimitResult& limit : result.limits) {
    EXPECT_TRUE(!limit.is_kept || limit.against == 0.0) << text_of(problem.limits[limit.limit].kind).name;
  }
  EXPECT_FALSE(result.limits[0].is_kept);
  EXPECT_EQ(result.at_bound[0], AtBound::Lower);
}

TEST(GoalSearch, KeepsEveryLimitOfALoopWithAll) {
  const GoalProblem problem = loops::problem_of(loops::oven, R"(
[fit.PID]
KP = {min = 0.01, max = 20.0}
TR = {min = 0.1, max = 20.0}
TD = {min = 0.0, max = 2.0}
[goal]
settling_time = 2.0
dead_time = 0.35
loop = "PID.XOUT"
[goal.limits]
effort = 6.0
effort_rate = 120.0
overshoot_percent = 4.0
gain_margin_db = 7.0
phase_margin_deg = 55.0
sensitivity = 1.7
)");
  const GoalResult result = tune_for_goal(problem);
  EXPECT_EQ(result.status, GoalStatus::Tuned) << result.message;
  for (const LimitResult& limit : result.limits) {
    EXPECT_TRUE(limit.is_kept) << text_of(problem.limits[limit.limit].kind).name << " is " << limit.value;
  }
  EXPECT_LT(result.plants[0].after.error, result.plants[0].before->error);
  // No single parameter, moved by a hundredth, is better and keeps the limits.
  GoalModel model(problem);
  ASSERT_EQ(model.evaluate(result.x, false), LoopState::Settles);
  const double cost = model.cost();
  for (Eigen::Index j = 0; j < result.x.size(); ++j) {
    for (const double factor : {0.99, 1.01}) {
      Eigen::VectorXd moved = result.x;
      moved[j] *= factor;
      ASSERT_EQ(model.evaluate(moved, false), LoopState::Settles);
      EXPECT_TRUE(model.largest_excess() > 0.0 || model.cost() > (1.0 - 1e-4) * cost)
          << problem.parameters[static_cast<std::size_t>(j)].name;
    }
  }
}

}  // namespace
}  // namespace hysteron
