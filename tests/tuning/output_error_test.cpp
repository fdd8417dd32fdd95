// Output error: parameters that are known come back, within the standard errors that are stated.
#include "tuning/output_error.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "codegen/parameters/apply.hpp"
#include "records/read.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "tests/support/error_page.hpp"
#include "tests/tuning/measured_machines.hpp"
#include "tests/tuning/output_error_diagrams.hpp"
#include "tuning/rollout.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using namespace output_error_diagrams;
using namespace measured_machines;
using records::Record;
using ::testing::HasSubstr;

double truth_of(const Program& truth, const std::string& name) {
  const auto element = element_of(name);
  const std::string path(element ? element->vector : std::string_view(name));
  return truth.graph.parameters[static_cast<std::size_t>(find_parameter(truth.graph, path))].value.at(
      element ? static_cast<std::size_t>(element->index) : 0);
}

struct Case {
  std::string_view diagram;
  std::string_view truth;
  std::string_view start;
  Record drive;
  std::vector<double> noise;
};

Case stack_case() {
  return {hysteresis,
          hysteresis_truth,
          hysteresis_start,
          inputs("u", 0.01, 400, [](double t) { return 1.8 - (1.6 + 0.2 * std::sin(0.7 * t)) * std::cos(two_pi * t); }),
          {0.05}};
}
Case oven_case() {
  return {thermal,
          thermal_truth,
          thermal_start,
          inputs("heat", 1.0, 300, [](double t) { return std::fmod(t, 120.0) < 60.0 ? 100.0 : 0.0; }),
          {0.3}};
}
Case axis_case() {
  return {servo,
          servo_truth,
          servo_start,
          inputs("i", 0.002, 500, [](double t) { return std::fmod(t, 0.5) < 0.25 ? 1.0 : -0.7; }),
          {0.5, 0.01}};
}

/// The coefficients of transfer functions in s and in z, whose first of DEN is left as it is.
Case resonance_case() {
  return {resonance,
          resonance_truth,
          resonance_start,
          inputs("u", 0.001, 600, [](double t) { return std::fmod(t, 0.11) < 0.05 ? 1.0 : -0.7 + t; }),
          {0.02, 0.01}};
}

class OutputErrorCases : public ::testing::TestWithParam<Case (*)()> {};

TEST_P(OutputErrorCases, FindsTheTruthWithoutNoise) {
  const Case one = GetParam()();
  const Program truth = program_of(one.diagram, one.truth);
  const auto fit = fit_output_error(problem_of(one.diagram, one.start, {measured(truth, one.drive)}));
  for (std::size_t j = 0; j < fit.names.size(); ++j) {
    const double wanted = truth_of(truth, fit.names[j]);
    EXPECT_NEAR(fit.solution.x[static_cast<Index>(j)], wanted, 1e-6 * std::fabs(wanted)) << fit.names[j];
  }
}

TEST_P(OutputErrorCases, StandardErrorsCoverTheTruthOverFiftySeeds) {
  const Case one = GetParam()();
  const Program truth = program_of(one.diagram, one.truth);
  std::vector<double> squares;
  double within_two = 0.0;
  double count = 0.0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto fit =
        fit_output_error(problem_of(one.diagram, one.start, {measured(truth, one.drive, one.noise, seed)}));
    EXPECT_TRUE(fit.solution.converged()) << fit.solution.message;
    squares.resize(fit.names.size());
    for (std::size_t j = 0; j < fit.names.size(); ++j) {
      const auto at = static_cast<Index>(j);
      const double deviation =
          (fit.solution.x[at] - truth_of(truth, fit.names[j])) / fit.covariance.standard_errors[at];
      EXPECT_LT(std::fabs(deviation), 5.0) << fit.names[j] << ", seed " << seed;
      squares[j] += deviation * deviation;
      within_two += std::fabs(deviation) < 2.0 ? 1.0 : 0.0;
      count += 1.0;
    }
  }
  // Of normal deviations 95 % lie within 2; the root mean square of 50 is 1 ± 0.1.
  EXPECT_GT(within_two / count, 0.89);
  for (const double sum : squares) {
    EXPECT_GT(std::sqrt(sum / 50.0), 0.6);
    EXPECT_LT(std::sqrt(sum / 50.0), 1.4);
  }
}

TEST_P(OutputErrorCases, DualRolloutHasThePlainValuesAndTheSlopesOfDifferences) {
  const Case one = GetParam()();
  const Program truth = program_of(one.diagram, one.truth);
  const auto problem = problem_of(one.diagram, one.start, {measured(truth, one.drive, one.noise)});
  detail::Rollout rollout(problem);
  Eigen::VectorXd x(rollout.unknowns());
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    x[static_cast<Index>(j)] = 1.01 * problem.parameters[j].start + 0.001;
  }
  (void)checked_jacobian(rollout, x);
}

INSTANTIATE_TEST_SUITE_P(Diagrams, OutputErrorCases,
                         ::testing::Values(&stack_case, &oven_case, &axis_case, &resonance_case));

/// More unknowns than one pass of dual numbers has: ten gains, each on an input of its own frequency.
TEST(OutputError, MoreParametersThanOnePassHolds) {
  std::string text = "FUNCTION_BLOCK SUMS (* @ts 1ms *)\n  VAR_INPUT T0 : LREAL;\n";
  std::string settings = "[fit]\n";
  std::string terms;
  for (int i = 0; i < 10; ++i) {
    text += "    A" + std::to_string(i) + " : LREAL := 1.0; (* @param *)\n";
    settings += "A" + std::to_string(i) + " = {}\n";
    terms += (i > 0 ? " + A" : "A") + std::to_string(i) + " * SIN(" + std::to_string(i + 1) + ".0 * T0)";
  }
  text += "  END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n  Y := " + terms + ";\nEND_FUNCTION_BLOCK\n";
  Program truth = compile_text(text);
  for (std::size_t i = 0; i < truth.graph.parameters.size(); ++i) {
    truth.graph.parameters[i].value = {0.3 * static_cast<double>(i) - 1.0};
  }
  const Record record = measured(truth, inputs("t0", 0.001, 700, [](double t) { return 9.0 * t; }));
  const auto fit = fit_output_error(problem_of(text, settings, {record}));
  ASSERT_EQ(fit.names.size(), 10U);
  for (std::size_t j = 0; j < 10; ++j) {
    EXPECT_NEAR(fit.solution.x[static_cast<Index>(j)], truth_of(truth, fit.names[j]), 1e-9) << fit.names[j];
  }
}

TEST(OutputError, UnitsDoNotMatter) {
  const Case one = stack_case();
  const Program truth = program_of(one.diagram, one.truth);
  const Record micrometres = measured(truth, one.drive, one.noise);
  Record metres = one.drive;
  std::vector<double> y = micrometres.column("Y").values;
  for (double& value : y) {
    value *= 1e-6;
  }
  metres.add({.name = "Y", .values = std::move(y)});
  const auto first = fit_output_error(problem_of(one.diagram, one.start, {micrometres}));
  const auto second =
      fit_output_error(problem_of(one.diagram,
                                  "[parameters.HYST]\nC1 = 8.0e-6\nC2 = 2.0e-6\nC3 = 1.2\nY0 = -110.0e-6\n"
                                  "[fit.HYST]\nC1 = {}\nC2 = {}\nC3 = {}\nY0 = {}\n",
                                  {metres}));
  EXPECT_EQ(first.solution.iterations, second.solution.iterations);
  for (std::size_t j = 0; j < first.names.size(); ++j) {
    const auto at = static_cast<Index>(j);
    const double unit = first.names[j] == "HYST.C3" ? 1.0 : 1e-6;
    EXPECT_NEAR(second.solution.x[at] / (unit * first.solution.x[at]), 1.0, 1e-8) << first.names[j];
    EXPECT_NEAR(second.covariance.standard_errors[at] / (unit * first.covariance.standard_errors[at]), 1.0, 1e-5);
  }
}

constexpr std::string_view tank = R"(FUNCTION_BLOCK TANK (* @ts 10ms *)
  VAR_INPUT Q : LREAL; END_VAR
  VAR_OUTPUT LEVEL : LREAL; END_VAR
  VAR
    AREA : HY_GAIN;
    SUM : HY_INTEGRAL;
  END_VAR
  AREA(XIN := Q);
  SUM(XIN := AREA.XOUT);
  LEVEL := SUM.XOUT;
END_FUNCTION_BLOCK
)";

TEST(OutputError, InitialStatesAreFittedForEachRecord) {
  const Program truth = program_of(tank, "[parameters.AREA]\nK = 2.5\n");
  std::vector<Record> records;
  const double levels[] = {3.0, -7.0};
  for (const double level : levels) {
    const Record drive = inputs("q", 0.01, 200, [](double t) { return 1.0 + std::sin(3.0 * t); });
    Record record = drive;
    std::vector<double> values = simulate(truth, drive).front();
    for (double& value : values) {
      value += level;  // an integral keeps what it starts with
    }
    record.add({.name = "level", .values = std::move(values)});
    records.push_back(std::move(record));
  }
  const auto fit =
      fit_output_error(problem_of(tank, "[fit.AREA]\nK = {}\n[tune]\ninitial_states = [\"sum.sum\"]\n", records));
  ASSERT_EQ(fit.names.size(), 3U);
  EXPECT_EQ(fit.names[1], "SUM.SUM at the start of record 1");
  EXPECT_NEAR(fit.solution.x[0], 2.5, 1e-9);
  EXPECT_NEAR(fit.solution.x[1], 3.0, 1e-9);
  EXPECT_NEAR(fit.solution.x[2], -7.0, 1e-9);
}

TEST(OutputError, EachRecordBeginsFromReset) {
  const Case one = oven_case();
  const Program truth = program_of(one.diagram, one.truth);
  const Record steps = measured(truth, one.drive);
  const Record sine =
      measured(truth, inputs("heat", 1.0, 200, [](double t) { return 50.0 + 40.0 * std::sin(t / 9.0); }));
  const auto fit = fit_output_error(problem_of(one.diagram, one.start, {steps, sine}));
  EXPECT_EQ(fit.scores.front().train_samples, 500U);
  EXPECT_LT(fit.scores.front().train, 1e-7);
  for (std::size_t j = 0; j < fit.names.size(); ++j) {
    const double wanted = truth_of(truth, fit.names[j]);
    EXPECT_NEAR(fit.solution.x[static_cast<Index>(j)], wanted, 1e-7 * wanted);
  }
}

TEST(OutputError, HuberWithstandsOutliers) {
  const Case one = oven_case();
  const Program truth = program_of(one.diagram, one.truth);
  Record clean = measured(truth, one.drive, one.noise);
  std::vector<double> values = clean.column("TEMP").values;
  Noise noise(7);
  for (std::size_t k = 0; k < values.size(); k += 11) {
    values[k] += 25.0 + 5.0 * noise();
  }
  Record spoilt = one.drive;
  spoilt.add({.name = "TEMP", .values = std::move(values)});
  const auto squares = fit_output_error(problem_of(one.diagram, one.start, {spoilt}));
  const auto huber =
      fit_output_error(problem_of(one.diagram, std::string(one.start) + "[tune]\nloss = \"huber\"\n", {spoilt}));
  EXPECT_NEAR(huber.solution.x[0], 21.5, 0.3);                        // AMBIENT
  EXPECT_GT(std::fabs(squares.solution.x[0] - 21.5), 1.0);            // drawn by 25/11
  EXPECT_NEAR(huber.solution.x[1] + huber.solution.x[2], 35.6, 3.0);  // T1 and K
}

TEST(OutputError, GainsInSeriesCannotBeToldApart) {
  constexpr std::string_view text = R"(FUNCTION_BLOCK SERIES (* @ts 1ms *)
  VAR_INPUT X : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR FIRST : HY_GAIN; SECOND : HY_GAIN; END_VAR
  FIRST(XIN := X);
  SECOND(XIN := FIRST.XOUT);
  Y := SECOND.XOUT;
END_FUNCTION_BLOCK
)";
  const Program truth = program_of(text, "[parameters.FIRST]\nK = 2.0\n[parameters.SECOND]\nK = 3.0\n");
  const Record record = measured(truth, inputs("x", 0.001, 100, [](double t) { return std::sin(90.0 * t); }), {0.01});
  const auto fit = fit_output_error(problem_of(text, "[fit.FIRST]\nK = {}\n[fit.SECOND]\nK = {}\n", {record}));
  EXPECT_NEAR(fit.solution.x[0] * fit.solution.x[1], 6.0, 0.02);
  EXPECT_THAT(fit.covariance.warnings, ::testing::Contains(HasSubstr("cannot be told apart by this record")));
  EXPECT_TRUE(std::isinf(fit.covariance.standard_errors[0]));
}

TEST(OutputError, BoundsHold) {
  const Case one = oven_case();
  const Program truth = program_of(one.diagram, one.truth);
  const auto problem =
      problem_of(one.diagram, "[fit.BODY]\nT1 = {max = 20.0}\n[fit.RISE]\nK = {}\n[fit]\nAMBIENT = {start = 20.0}\n",
                 {measured(truth, one.drive)});
  const auto fit = fit_output_error(problem);
  const auto t1 = static_cast<std::size_t>(std::ranges::find(fit.names, "BODY.T1") - fit.names.begin());
  EXPECT_EQ(fit.solution.x[static_cast<Index>(t1)], 20.0);
  EXPECT_EQ(fit.solution.at_bound[t1], AtBound::Upper);
}

TEST(OutputError, TrainAndTestAreScoredApart) {
  const Program truth = program_of(tank, "[parameters.AREA]\nK = 2.5\n");
  Record record = inputs("q", 0.01, 200, [](double) { return 1.0; });
  std::vector<double> level = simulate(truth, record).front();
  for (std::size_t k = 100; k < 200; ++k) {
    level[k] += 0.5;  // the second half is another one
  }
  record.add({.name = "level", .values = std::move(level)});
  const auto fit = fit_output_error(
      problem_of(tank, "[fit.AREA]\nK = {}\n[tune]\ntrain = [0.0, 1.0]\ntest = [1.0, 2.0]\n", {record}));
  EXPECT_NEAR(fit.solution.x[0], 2.5, 1e-9);
  EXPECT_NEAR(fit.scores.front().test, 0.5, 1e-9);
  EXPECT_EQ(fit.scores.front().train_samples, 100U);
  EXPECT_EQ(fit.scores.front().test_samples, 100U);
}

TEST(OutputError, CancelKeepsTheBestSoFar) {
  const Case one = stack_case();
  const Program truth = program_of(one.diagram, one.truth);
  const auto problem = problem_of(one.diagram, one.start, {measured(truth, one.drive, one.noise)});
  OutputErrorOptions options;
  int calls = 0;
  options.progress = [&calls](int, const FitProgress&) { return ++calls < 3; };
  const auto fit = fit_output_error(problem, options);
  EXPECT_EQ(fit.solution.status, FitStatus::Cancelled);
  EXPECT_LE(fit.scores.front().train, fit.scores.front().before);
  EXPECT_TRUE(fit.solution.x.allFinite());
}

TEST(OutputError, StepsIntoValuesThatAreNotFiniteAreShortened) {
  constexpr std::string_view text = R"(FUNCTION_BLOCK ROOT (* @ts 1ms *)
  VAR_INPUT X : LREAL; K : LREAL := 5.0; (* @param *) END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  Y := X * SQRT(K - 1.0);
END_FUNCTION_BLOCK
)";
  const Program truth = program_of(text, "[parameters]\nK = 1.0001\n");
  const Record record = measured(truth, inputs("x", 0.001, 50, [](double t) { return 1.0 + t; }));
  const auto fit = fit_output_error(problem_of(text, "[fit]\nK = {}\n", {record}));
  EXPECT_NEAR(fit.solution.x[0], 1.0001, 1e-9);
}

TEST(OutputError, SeveralStartsLeaveALocalMinimum) {
  constexpr std::string_view text = R"(FUNCTION_BLOCK WAVE (* @ts 1ms *)
  VAR_INPUT X : LREAL; W : LREAL := 1.0; (* @param *) END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  Y := SIN(W * X);
END_FUNCTION_BLOCK
)";
  const Program truth = program_of(text, "[parameters]\nW = 7.0\n");
  const Record record = measured(truth, inputs("x", 0.001, 400, [](double t) { return 20.0 * t; }));
  const auto problem = problem_of(text, "[fit]\nW = {min = 0.1, max = 10.0}\n", {record});
  EXPECT_GT(std::fabs(fit_output_error(problem).solution.x[0] - 7.0), 0.1);
  const auto fit = fit_output_error(problem, {.starts = 40});
  EXPECT_NEAR(fit.solution.x[0], 7.0, 1e-8);
  EXPECT_EQ(fit.start_costs.size(), 40U);
  EXPECT_EQ(fit_output_error(problem, {.starts = 4}).start_costs,
            (std::vector<double>(fit.start_costs.begin(), fit.start_costs.begin() + 4)));
}

TEST(OutputError, NoFitEndsWorseThanItsStart) {
  constexpr std::string_view text = R"(FUNCTION_BLOCK WAVE (* @ts 1ms *)
  VAR_INPUT X : LREAL; W : LREAL := 1.0; (* @param *) END_VAR
  VAR_OUTPUT Y : LREAL; Z : LREAL; END_VAR
  Y := SIN(W * X);
  Z := COS(W * X) + 0.3 * X;
END_FUNCTION_BLOCK
)";
  const Program truth = program_of(text, "[parameters]\nW = 7.0\n");
  const Record record = measured(truth, inputs("x", 0.001, 400, [](double t) { return 20.0 * t; }));
  for (int k = 0; k < 40; ++k) {
    const double start = 0.15 + 0.245 * k;
    for (const std::string_view outputs : {"[\"Y\"]", "[\"Y\", \"Z\"]"}) {
      const auto fit = fit_output_error(problem_of(
          text, fmt::format("[fit]\nW = {{min = 0.1, max = 10.0, start = {}}}\n[tune]\noutputs = {}\n", start, outputs),
          {record}));
      double least = infinity;  // of two outputs one may be given up for the other
      for (const OutputScore& score : fit.scores) {
        least = std::min(least, score.train / score.before);
      }
      EXPECT_LE(least, 1.0 + 1e-6) << start << " " << outputs;
    }
  }
}

TEST(OutputError, TunedFileKeepsAllElseAndReadsBackToTheSameBits) {
  const Case one = oven_case();
  const Program truth = program_of(one.diagram, one.truth);
  const auto settings = parameters::parse_parameter_file(
      "p.toml", "[parameters.BODY]\nSETTLED = true\n[fit.RISE]\nK = {min = 0.0}\n[tune]\ntrain = [0.0, 200.0]\n");
  const std::vector<Record> records{measured(truth, one.drive, one.noise)};
  const auto problem = output_error_problem(compile_text(std::string(one.diagram)), settings, records);
  const auto fit = fit_output_error(problem);
  const auto text = parameters::parameter_text(tuned_file(settings, problem, fit), tuned_remarks(problem, fit));
  const auto again = parameters::parse_parameter_file("tuned.toml", text);
  ASSERT_NE(again.find("RISE.K"), nullptr);
  EXPECT_EQ(std::get<double>(again.find("RISE.K")->value), fit.solution.x[0]);
  EXPECT_EQ(std::get<bool>(again.find("BODY.SETTLED")->value), true);
  ASSERT_EQ(again.fits.size(), 1U);
  EXPECT_EQ(again.fits.front().minimum->value, 0.0);
  EXPECT_EQ(again.tune.train.front().end, 200.0);
  EXPECT_THAT(text, HasSubstr("standard error"));
  EXPECT_THAT(text, HasSubstr("K/W"));
}

// ---- bad input
// --------------------------------------------------------------------------------------------------------

int first_number(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.diagnostics().all().front().number;
  }
  return 0;
}

TEST(OutputError, RefusesWhatItCannotFit) {
  const Record log = measured(program_of(tank), inputs("q", 0.01, 20, [](double) { return 1.0; }));
  const auto refuse = [&](std::string_view settings) {
    return first_number([&] { fit_output_error(problem_of(tank, settings, {log})); });
  };
  EXPECT_EQ(refuse("[fit.AREA]\nK = {}\n"), 0);
  EXPECT_EQ(refuse("[fit.AREA]\nG = {}\n"), error::unknown_key);
  EXPECT_EQ(refuse("[tune]\ninitial_states = [\"SUM.NONE\"]\n"), error::unknown_key);
  EXPECT_EQ(refuse("[fit.AREA]\nK = {}\n[tune]\noutputs = [\"NONE\"]\n"), error::unknown_key);
  EXPECT_EQ(refuse("[fit.AREA]\nK = {start = 3.0, max = 2.0}\n"), error::contradicting_range);
  EXPECT_EQ(refuse("[fit.AREA]\nK = {max = 0.5}\n"), error::contradicting_range);  // the diagram's own value is 1
  Record slow = Record::even(0.0, 0.02, 20);
  slow.add({.name = "q", .values = std::vector<double>(20, 1.0)});
  slow.add({.name = "level", .values = std::vector<double>(20, 1.0)});
  EXPECT_EQ(first_number([&] { problem_of(tank, "[fit.AREA]\nK = {}\n", {log, slow}); }), error::sample_time_mismatch);
}

TEST(OutputError, OnlyRealParametersAreFitted) {
  const Case one = stack_case();
  const Program truth = program_of(one.diagram, one.truth);
  EXPECT_EQ(first_number([&] { problem_of(one.diagram, "[fit.HYST]\nSTART = {}\n", {measured(truth, one.drive)}); }),
            error::wrong_value_type);
}

/// The diagrams of the pages HY716 to HY719.
constexpr std::string_view gain = R"(FUNCTION_BLOCK P (* @ts 1ms *)
  VAR_INPUT X : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR AMP : HY_GAIN; LIM : HY_LIMIT; END_VAR
  AMP(XIN := X);
  LIM(XIN := AMP.XOUT);
  Y := LIM.XOUT;
END_FUNCTION_BLOCK
)";

TEST(OutputError, AStateThatIsSetAnewLeadsToOneThatIsNot) {
  const Record drive = inputs("x", 1.0, 100, [](double t) { return t < 30.0 ? 0.0 : 5.0; });
  const Record record = measured(program_of(body), drive);
  try {
    fit_output_error(problem_of(body, "[fit.L]\nT1 = {}\n[tune]\ninitial_states = [\"L.X1\"]\n", {record}));
    FAIL() << "L.X1 has no influence";
  } catch (const InputError& refused) {
    const auto& first = refused.diagnostics().all().front();
    EXPECT_EQ(first.number, error::no_influence);
    EXPECT_THAT(first.mend, HasSubstr("name L.RATE1 instead"));
  }
  const auto fit =
      fit_output_error(problem_of(body, "[fit.L]\nT1 = {}\n[tune]\ninitial_states = [\"L.RATE1\"]\n", {record}));
  EXPECT_NEAR(fit.solution.x[1], 0.0, 1e-6);
}

TEST(OutputError, PagesKeepTheirWord) {
  constexpr std::string_view log = "t,x,y\n0.000,0.0,0.0\n0.001,1.0,2.1\n0.002,2.0,3.9\n";
  for (const int number :
       {error::nothing_to_fit, error::no_measured_output, error::nothing_to_train_on, error::no_influence}) {
    const auto page = test::read_error_page("HY" + std::to_string(number));
    SCOPED_TRACE(page.number);
    const auto run = [&](const test::FencedBlock& block) {
      return first_number([&] {
        const bool is_record = block.kind == "csv";
        fit_output_error(problem_of(gain, is_record ? "[fit.AMP]\nK = {}\n" : block.text,
                                    {records::parse_record("log.csv", std::string(is_record ? block.text : log))}));
      });
    };
    EXPECT_EQ(run(page.fails), number);
    EXPECT_EQ(run(page.mended), 0);
    const auto title = std::ranges::find(error_titles(), number, &ErrorTitle::number);
    ASSERT_NE(title, error_titles().end());
    EXPECT_EQ(page.title, title->title);
  }
}

}  // namespace
}  // namespace hysteron
