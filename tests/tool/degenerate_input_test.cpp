// Inputs that hold next to nothing, or far too much, through every command: each gives a result or an error with its
// number and its mend. No crash, no hang, and no success with a NaN in what is written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "support/numbers.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AnyOf;
using testing::ContainsRegex;
using testing::HasSubstr;

struct Named {
  std::string name;
  std::string text;
};

std::string block(std::string_view inputs, std::string_view outputs, std::string_view variables,
                  std::string_view body) {
  const auto section = [](std::string_view kind, std::string_view declared) {
    return declared.empty() ? std::string() : fmt::format("  {} {} END_VAR\n", kind, declared);
  };
  return fmt::format("FUNCTION_BLOCK PLANT  (* @ts 10ms *)\n{}{}{}  {}\nEND_FUNCTION_BLOCK\n",
                     section("VAR_INPUT", inputs), section("VAR_OUTPUT", outputs), section("VAR", variables), body);
}

/// A plant that a diagnosis is made for, and those that have no parameter, no input, no output, nothing that moves.
std::vector<Named> degenerate_diagrams() {
  constexpr std::string_view u = "U : LREAL;";
  constexpr std::string_view y = "Y : LREAL;";
  return {{"usual", block(u, y, "G : HY_GAIN := (K := 2.0); L : HY_LAG := (T1 := 0.1);",
                          "G(XIN := U); L(XIN := G.XOUT); Y := L.XOUT;")},
          {"factor", block(u, y, "", "Y := 2.0*U;")},
          {"delay", block(u, y, "D : HY_DELAY;", "D(XIN := U); Y := D.XOUT;")},
          {"neutral", block(u, y, "L : HY_LAG;", "L(XIN := U); Y := L.XOUT;")},
          {"same", block(u, y, "", "Y := U;")},
          {"constant", block(u, y, "", "Y := 1.0;")},
          {"no_input", block("", y, "", "Y := 1.0;")},
          {"no_output", block(u, "", "D : HY_DELAY;", "D(XIN := U);")},
          {"late", block(u, y, "D : HY_DEAD_TIME := (DEAD_TIME := 8.0);", "D(XIN := U); Y := D.XOUT;")},
          {"no_value", block(u, y, "", "Y := U/(U - U);")},
          {"integral", block(u, y, "S : HY_INTEGRAL;", "S(XIN := U); Y := S.XOUT;")}};
}

double wave(double t) {
  return std::sin(3.0 * t) + 0.5 * std::sin(7.1 * t);
}

template <class Input, class Output>
std::string log_of(std::size_t rows, const Input& u, const Output& y, double sample_time = 0.01) {
  std::string text = "t,u,y\n";
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = sample_time * static_cast<double>(k);
    text += fmt::format("{},{},{}\n", number_text(t), number_text(u(t)), number_text(y(t, k)));
  }
  return text;
}

/// White enough, and the same everywhere.
double flicker(std::size_t k) {
  const double x = 0.6180339887498949 * static_cast<double>(k * k % 10007 + 1);
  return x - std::floor(x) - 0.5;
}

std::vector<Named> degenerate_logs() {
  const auto u = wave;
  const auto y = [](double t, std::size_t k) { return 1.9 * wave(t - 0.08) + 0.002 * flicker(k); };
  const auto scaled = [&](double of_u, double of_y) {
    return log_of(
        300, [of_u](double t) { return of_u * wave(t); }, [=](double t, std::size_t k) { return of_y * y(t, k); });
  };
  const auto constant = [](double value) { return [value](double /*t*/, std::size_t /*k*/ = 0) { return value; }; };
  std::vector<Named> logs{{"usual", log_of(300, u, y)},
                          {"empty", ""},
                          {"header", "t,u,y\n"},
                          {"one", log_of(1, u, y)},
                          {"two", log_of(2, u, y)},
                          {"five", log_of(5, u, y)},
                          {"constant_input", log_of(300, constant(1.0), y)},
                          {"constant_output", log_of(300, u, constant(3.0))},
                          {"zero_output", log_of(300, u, constant(0.0))},
                          {"all_constant", log_of(300, constant(1.0), constant(3.0))},
                          {"all_zero", log_of(300, constant(0.0), constant(0.0))},
                          {"same", log_of(300, u, [](double t, std::size_t) { return wave(t); })},
                          {"exact", log_of(300, u, [](double t, std::size_t) { return 2.0 * wave(t); })},
                          {"far_off", log_of(300, u, [&](double t, std::size_t k) { return 1e9 + y(t, k); })},
                          {"tiny", scaled(1e-12, 1e-12)},
                          {"huge", scaled(1e12, 1e12)},
                          {"tiny_output", scaled(1.0, 1e-12)},
                          {"huge_output", scaled(1.0, 1e12)},
                          {"beyond", scaled(1e300, 1e300)},
                          {"below", scaled(1e-300, 1e-300)},
                          {"no_input_column", "t,y\n0,1\n0.01,2\n0.02,1\n"},
                          {"no_output_column", "t,u\n0,1\n0.01,2\n0.02,1\n"},
                          {"two_columns_u", "t,u,u,y\n0,1,1,1\n0.01,2,2,2\n0.02,1,1,1\n"},
                          {"spike", log_of(
                                        300, [](double t) { return std::abs(t - 1.0) < 0.005 ? 1.0 : 0.0; }, y)},
                          {"step", log_of(
                                       300, [](double t) { return t > 1.0 ? 1.0 : 0.0; }, y)}};
  for (const std::string_view cell : {"nan", "inf", "-inf", "", "1e400"}) {
    logs.push_back({"cell_" + std::to_string(logs.size()), fmt::format("t,u,y\n0,1,1\n0.01,{},2\n0.02,1,1\n", cell)});
    logs.push_back({"cell_" + std::to_string(logs.size()), fmt::format("t,u,y\n0,1,1\n0.01,2,{}\n0.02,1,1\n", cell)});
  }
  return logs;
}

class DegenerateInput : public testing::Test {
 protected:
  void SetUp() override {
    for (const Named& diagram : degenerate_diagrams()) {
      bench.write(diagram.name + ".st", diagram.text);
    }
    for (const Named& log : degenerate_logs()) {
      bench.write(log.name + ".csv", log.text);
    }
    bench.write("none.toml", "");
    bench.write("fit.toml", "[fit.G]\nK = {}\n[fit.L]\nT1 = {}\n");
  }

  /// A result, a finding, or an error that says what to do.
  int ends_well(const std::string& line) const {
    const test::Outcome outcome = bench.shell(line);
    const auto said = [&] { return fmt::format("{}\n{}{}", line, outcome.out, outcome.err); };
    EXPECT_THAT(outcome.code, AnyOf(0, 1, 2)) << said();
    if (outcome.code == 2) {
      EXPECT_THAT(outcome.err, AllOf(ContainsRegex("HY[0-9]+ error: "), HasSubstr("mend: "))) << line;
    }
    if (outcome.code == 0) {
      EXPECT_THAT(outcome.out, testing::Not(ContainsRegex("(^|[^a-zA-Z_])(-?nan|-?inf)([^a-zA-Z_]|$)"))) << said();
    }
    return outcome.code;
  }

  /// The verdict is there, and all its numbers are finite or null.
  void expect_verdict(const std::string& line, bool is_refused) const {
    const std::string text = bench.read("found/verdict.json");
    const auto verdict = nlohmann::json::parse(text, nullptr, false);
    ASSERT_FALSE(verdict.is_discarded()) << line << "\n" << text;
    EXPECT_EQ(verdict["refused"], is_refused) << line;
    EXPECT_GE(verdict["confidence"].get<double>(), 0.0) << line;
    EXPECT_LE(verdict["confidence"].get<double>(), 1.0) << line;
    EXPECT_THAT(text, testing::Not(ContainsRegex("[:,[] *-?(nan|inf)[],}\n]"))) << line;
  }

  void diagnose(const std::string& diagram, const std::string& log, const std::string& parameters,
                const std::string& options) const {
    const std::string line =
        fmt::format("rm -rf found; hysteron diagnose {}.st --log {}.csv --params {}.toml --out found {}", diagram, log,
                    parameters, options);
    SCOPED_TRACE(line);
    if (const int code = ends_well(line); code < 2) {
      expect_verdict(line, code == 1);
    }
  }

  test::Workbench bench;
};

TEST_F(DegenerateInput, DiagramsThroughTheCommandsThatReadNoRecord) {
  for (const Named& diagram : degenerate_diagrams()) {
    for (const std::string_view command :
         {"check {}", "fmt {}", "test {}", "map {}", "generate {} --target cpp --out generated"}) {
      ends_well("hysteron " + fmt::format(fmt::runtime(command), diagram.name + ".st"));
    }
  }
}

TEST_F(DegenerateInput, EveryRecordIsRunOrRefused) {
  for (const Named& diagram : degenerate_diagrams()) {
    for (const Named& log : degenerate_logs()) {
      const int code =
          ends_well(fmt::format("hysteron run {}.st --in {}.csv --out out.csv --summary", diagram.name, log.name));
      if (code == 0) {
        EXPECT_THAT(bench.read("out.csv"), testing::Not(AnyOf(HasSubstr("nan"), HasSubstr("inf"))))
            << diagram.name << log.name;
      }
    }
  }
}

TEST_F(DegenerateInput, EveryRecordIsTunedOrRefused) {
  for (const Named& log : degenerate_logs()) {
    for (const std::string_view more : {"", "--start 3 --json"}) {
      const int code = ends_well(
          fmt::format("hysteron tune usual.st --log {}.csv --params fit.toml --out tuned.toml {}", log.name, more));
      if (code < 2) {
        EXPECT_THAT(bench.read("tuned.toml"), testing::Not(ContainsRegex("= -?(nan|inf)"))) << log.name;
      }
    }
  }
  for (const Named& diagram : degenerate_diagrams()) {
    ends_well(fmt::format("hysteron tune {}.st --log usual.csv --params none.toml --out tuned.toml", diagram.name));
  }
}

TEST_F(DegenerateInput, EveryRecordIsDiagnosedOrRefused) {
  for (const Named& log : degenerate_logs()) {
    diagnose("usual", log.name, "fit", "--effects lag,offset,delay --most 1 --effort 0.1");
    diagnose("factor", log.name, "none", "--effects lag,offset --most 1 --effort 0.1");
  }
}

TEST_F(DegenerateInput, EveryDiagramIsDiagnosedOrRefused) {
  for (const Named& diagram : degenerate_diagrams()) {
    for (const std::string_view log : {"usual", "same", "step"}) {
      diagnose(diagram.name, std::string(log), "none", "--effects lag,offset,delay,gain_drift --most 2 --effort 0.1");
    }
  }
}

/// Without a parameter every effect of the library is the first that a fit may move.
TEST_F(DegenerateInput, APlantWithoutAParameterIsSearchedWithTheWholeLibrary) {
  for (const std::string_view diagram : {"factor", "delay", "neutral"}) {
    diagnose(std::string(diagram), "usual", "none", "--budget 10");
  }
}

}  // namespace
}  // namespace hysteron
