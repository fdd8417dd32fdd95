#include "diagnosis/evidence/gap_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "diagnosis/evidence/gap_kinds.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/search/expansion.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::string_view heater = R"(FUNCTION_BLOCK HEATER  (* @ts 10ms *)
  VAR_INPUT
    U : LREAL;  (* @unit V *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit K *)
  END_VAR
  VAR
    GAIN : HY_GAIN := (K := 2.0);
    WARM : HY_LAG  := (T1 := 0.05);
  END_VAR
  GAIN(XIN := U);
  WARM(XIN := GAIN.XOUT);
  Y := WARM.XOUT;
END_FUNCTION_BLOCK
)";
constexpr std::size_t samples = 3000;
constexpr double step = 0.01;

std::vector<double> input() {
  std::vector<double> result;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = step * static_cast<double>(k);
    result.push_back(std::sin(1.3 * t) + 0.7 * std::sin(3.1 * t + 1.0) + 0.4 * std::sin(7.7 * t + 2.0));
  }
  return result;
}

/// The heater as its diagram has it, with something more: of the input, of the time in s, of another column.
using Missing = std::function<double(std::size_t k, const std::vector<double>& u, const std::vector<double>& column)>;

GapBudget budget_of(const Missing& missing, double to_unit = 1.0) {
  test::Noise noise(7);
  const std::vector<double> u = input();
  std::vector<double> column;
  double wander = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    wander = 0.5 * wander + noise();
    column.push_back(wander);
  }
  std::string text(heater);
  if (to_unit != 1.0) {
    text.replace(text.find("K := 2.0"), 8, fmt::format("K := {:.1f}", 2.0 * to_unit));
  }
  records::Record record = records::Record::even(0.0, step, samples);
  record.add({.name = "U", .values = u});
  std::vector<double> output = simulate(compile_text(text), record).front();
  for (std::size_t k = 0; k < samples; ++k) {
    output[k] += to_unit * (missing(k, u, column) + 0.01 * noise());
  }
  record.add({.name = "Y", .values = std::move(output)});
  record.add({.name = "FAN", .values = column});
  DiagnosisInput asked{.program = compile_text(text), .text = text};
  asked.file = parameters::parse_parameter_file("start.toml", "[fit.GAIN]\nK = {min = 0.0}\n");
  asked.records.push_back(std::move(record));
  Task task = task_of(asked);
  task.scales = {0.01 * to_unit};
  const Footing footing = footing_of(task, {.text = asked.text, .program = std::make_shared<Program>(asked.program)});
  const OutputSpace space(task, "HEATER", footing.calibrated, {"FAN"}, 2);
  const std::optional<GapBudget> budget = gap_budget(task, space, "Y", 2);
  EXPECT_TRUE(budget.has_value());
  return budget.value_or(GapBudget());
}

double time_of(std::size_t k) {
  return step * static_cast<double>(k);
}

struct Case {
  std::string_view kind;
  Missing missing;
};

TEST(GapBudget, TellsTheKindOfWhatIsMissing) {
  double slow = 0.0;
  double gap = 0.0;
  double last = 0.0;
  const Case cases[] = {
      {"linear_dynamics",
       [&](std::size_t k, const auto& u, const auto&) {
         slow = k == 0 ? 0.0 : slow + 0.004 * (u[k] - slow);
         return slow;
       }},
      {"linear_dynamics", [](std::size_t k, const auto& u, const auto&) { return 0.3 * u[k < 12 ? 0 : k - 12]; }},
      {"static_curve", [](std::size_t k, const auto& u, const auto&) { return 0.2 * u[k] * u[k]; }},
      {"static_curve", [](std::size_t k, const auto& u, const auto&) { return std::min(0.8, u[k]) - u[k]; }},
      {"memory",
       [&](std::size_t k, const auto& u, const auto&) {
         gap = k == 0 ? u[0] : std::clamp(gap, u[k] - 0.3, u[k] + 0.3);
         return 0.5 * gap;
       }},
      {"memory",
       [&](std::size_t k, const auto& u, const auto&) {
         const double direction = k > 0 && u[k] > last ? 1.0 : -1.0;
         last = u[k];
         return 0.2 * direction;
       }},
      {"time", [](std::size_t k, const auto&, const auto&) { return 0.02 * time_of(k); }},
      {"time", [](std::size_t k, const auto&, const auto&) { return std::exp(-time_of(k) / 1.5); }},
      {"periodic", [](std::size_t k, const auto&,
                      const auto&) { return 0.2 * std::sin(2.0 * std::numbers::pi * 4.1 * time_of(k) + 0.4); }},
      {"columns", [](std::size_t k, const auto&, const auto& fan) { return 0.2 * fan[k]; }},
  };
  for (const Case& one : cases) {
    const GapBudget found = budget_of(one.missing);
    SCOPED_TRACE(fmt::format("{} of case {}", one.kind, &one - cases));
    ASSERT_EQ(found.kinds.size(), gap_kinds.size());
    EXPECT_EQ(found.kinds.front().kind, one.kind);
    EXPECT_GT(found.kinds.front().alone, 0.8);
    EXPECT_GT(found.kinds.front().high, found.kinds.front().alone - 1e-12);
    EXPECT_GT(found.closed, 0.8);
    double sum = 0.0;
    for (const KindFinding& kind : found.kinds) {
      EXPECT_GE(kind.share, -1e-12);
      EXPECT_LE(kind.alone, found.closed + 1e-12);
      EXPECT_GE(kind.only, 0.0);
      sum += kind.share;
    }
    EXPECT_NEAR(sum, found.closed, 1e-9);
  }
}

TEST(GapBudget, NoiseIsOfNoKind) {
  const GapBudget found = budget_of([](std::size_t, const auto&, const auto&) { return 0.0; });
  EXPECT_LT(found.closed, 0.1);
  EXPECT_NEAR(found.noise, 1.0, 0.1);
}

TEST(GapBudget, IsTheSameInOtherUnits) {
  const Missing bend = [](std::size_t k, const auto& u, const auto&) { return 0.2 * u[k] * u[k]; };
  const GapBudget one = budget_of(bend);
  const GapBudget other = budget_of(bend, 1000.0);
  ASSERT_EQ(one.kinds.size(), other.kinds.size());
  EXPECT_NEAR(one.closed, other.closed, 1e-6);
  for (std::size_t i = 0; i < one.kinds.size(); ++i) {
    EXPECT_EQ(one.kinds[i].kind, other.kinds[i].kind);
    EXPECT_NEAR(one.kinds[i].share, other.kinds[i].share, 1e-6);
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
