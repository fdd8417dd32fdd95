// FMUs: what the XML states, and what the binary does through the calls of FMI, held against the interpreter.
#include "tool/fmu.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "codegen/interpreter/machine.hpp"
#include "support/numbers.hpp"
#include "tests/codegen/backends/recorded_run.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/tool/fmu_importer.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using hysteron::testing::RandomDiagram;
using hysteron::testing::RecordedRun;
using test::FmuInstance;
using test::LoadedFmu;

constexpr std::string_view axis = R"(FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT
    X      : LREAL;  (* @unit um @doc <where> & "why" *)
    TEMP   : LREAL;  (* @unit degC *)
    GAIN   : LREAL := 2.0;  (* @param @min 0 @max 10 @doc proportional gain *)
    N      : DINT;
    ACTIVE : BOOL;
    STATUS : WORD;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit um *)
    K : DINT;
    Q : BOOL;
    W : WORD;
  END_VAR
  VAR
    LAG : HY_LAG := (T1 := 0.02);
  END_VAR

  LAG(XIN := X);
  Y := GAIN * LAG.XOUT;
  K := N + 1;
  Q := NOT ACTIVE;
  W := STATUS;
END_FUNCTION_BLOCK
)";

std::string packed(const Program& program, const FmuOptions& options) {
  Diagnostics warnings;
  const GeneratedFile file = tool::pack_fmu(program, options, warnings);
  EXPECT_TRUE(warnings.all().empty());
  return file.text;
}

std::string packed(std::string_view text, FmiVersion version) {
  return packed(compile_text(std::string(text)), {.version = version});
}

constexpr std::array versions{FmiVersion::Two, FmiVersion::Three};

/// Random inputs at every sample, the outputs of each sample, and a reset in the middle, as `record` has them.
void hold_against_interpreter(const Program& program, const FmuOptions& options, std::uint64_t seed) {
  constexpr std::size_t steps = 200;
  const RecordedRun run = options.float32 ? hysteron::testing::record<float>(program, steps, seed)
                                          : hysteron::testing::record<double>(program, steps, seed);
  const LoadedFmu fmu(packed(program, options));
  FmuInstance one(fmu);
  FmuInstance other(fmu);  // gets other inputs, and must not disturb the first
  ASSERT_TRUE(one.there() && other.there());
  ASSERT_EQ(one.start() + other.start(), 0);
  constexpr std::array inputs{"X1", "X2", "X3", "B1", "B2", "N1"};
  constexpr std::array outputs{"Y0", "Y1", "Y2", "Y3", "Q", "N"};
  std::vector<double> results;
  std::size_t first = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    if (k == steps / 2) {
      ASSERT_EQ(one.call("Reset"), 0);
      ASSERT_EQ(one.start(), 0);
      first = k;
    }
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      ASSERT_EQ(one.set(inputs[i], run.inputs[k * RecordedRun::columns + i]), 0);
    }
    ASSERT_EQ(other.set("X1", static_cast<double>(k)), 0);
    ASSERT_EQ(other.step(0.001 * static_cast<double>(k), 0.001), 0);
    ASSERT_EQ(one.step(0.001 * static_cast<double>(k - first), 0.001), 0);
    for (const char* const output : outputs) {
      results.push_back(one.get(output));
    }
  }
  EXPECT_EQ(hysteron::testing::equal_steps(run, results), steps) << "seed " << seed;
}

TEST(Fmu, RandomDiagramsHaveTheBitsOfTheInterpreter) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Program program = RandomDiagram(seed + 4100, fmt::format("P{}", seed), 25).program();
    hold_against_interpreter(program, {.version = versions[seed % 2], .float32 = seed >= 4}, seed);
  }
}

TEST(Fmu, VariablesAreAllThereAndNoReferenceIsTwice) {
  for (const FmiVersion version : versions) {
    const LoadedFmu fmu(packed(axis, version));
    std::set<unsigned> references;
    std::set<std::string> names;
    unsigned place = 0;
    for (const pugi::xml_node node : fmu.root().child("ModelVariables").children()) {
      EXPECT_TRUE(references.insert(node.attribute("valueReference").as_uint()).second);
      names.insert(node.attribute("name").value());
      EXPECT_EQ(node.attribute("valueReference").as_uint(), fmu.three() ? place : place + 1);
      ++place;
    }
    std::set<std::string> expected{"X", "TEMP", "GAIN", "N", "ACTIVE", "STATUS", "Y", "K", "Q", "W", "LAG.T1"};
    for (const std::string& name : expected) {
      EXPECT_TRUE(names.contains(name)) << name;
    }
    const auto variable = [&](const char* name) {
      return fmu.root().child("ModelVariables").find_child_by_attribute("name", name);
    };
    EXPECT_STREQ(variable("GAIN").attribute("causality").value(), "parameter");
    EXPECT_STREQ(variable("GAIN").attribute("variability").value(), "tunable");
    const pugi::xml_node gain = fmu.three() ? variable("GAIN") : variable("GAIN").first_child();
    EXPECT_STREQ(gain.attribute("start").value(), "2");
    EXPECT_STREQ(gain.attribute("min").value(), "0");
    EXPECT_STREQ(gain.attribute("max").value(), "10");
    EXPECT_STREQ(variable("X").attribute("description").value(), "<where> & \"why\"");
    EXPECT_EQ(fmu.type(fmu.reference("STATUS")), fmu.three() ? "UInt16" : "Integer");
  }
}

TEST(Fmu, AVectorIsAnArrayOfFmi3AndItsElementsInFmi2) {
  constexpr std::string_view rack = R"(FUNCTION_BLOCK RACK  (* @ts 1ms *)
  VAR_INPUT
    X : ARRAY[0..3] OF LREAL := [1.0, 2.0, 3.0, 4.0];  (* @unit um @min -10.0 @max 10.0 *)
    ON_SET : ARRAY[0..1] OF BOOL;
    K : LREAL := 2.0;  (* @param *)
  END_VAR
  VAR_OUTPUT
    Y : ARRAY[0..3] OF LREAL;  (* @unit um *)
    N : ARRAY[0..1] OF DINT;
    LAST : LREAL;  (* @unit um *)
  END_VAR
  VAR
    TABLE : HY_TABLE := (X := [0.0, 1.0, 2.0], Y := [0.0, 10.0, 15.0], COUNT := 3);
  END_VAR

  TABLE(XIN := K);
  Y := X * K;
  N[0] := BOOL_TO_DINT(ON_SET[1]);
  N[1] := BOOL_TO_DINT(ON_SET[0]) * 7;
  LAST := X[3];
END_FUNCTION_BLOCK
)";
  const LoadedFmu three(packed(rack, FmiVersion::Three));
  const auto variable = [&](const char* name) {
    return three.root().child("ModelVariables").find_child_by_attribute("name", name);
  };
  const pugi::xml_node x = variable("X");
  EXPECT_STREQ(x.name(), "Float64");
  EXPECT_STREQ(x.child("Dimension").attribute("start").value(), "4");
  EXPECT_STREQ(x.attribute("start").value(), "1 2 3 4");
  EXPECT_STREQ(x.attribute("min").value(), "-10");
  EXPECT_STREQ(variable("ON_SET").attribute("start").value(), "false false");
  EXPECT_THAT(variable("TABLE.Y").attribute("start").value(), ::testing::StartsWith("0 10 15 "));
  EXPECT_TRUE(variable("X[0]").empty() && variable("TABLE.Y[1]").empty());
  EXPECT_TRUE(variable("LAST").child("Dimension").empty());

  FmuInstance one(three);
  ASSERT_EQ(one.start(), 0);
  const auto reference = [&](const char* name) { return three.reference(name); };
  EXPECT_EQ(one.get_array(reference("X"), 4), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(one.get_array(reference("Y"), 4), (std::vector<double>{2, 4, 6, 8}));
  ASSERT_EQ(one.set_array(reference("X"), {5, 6, 7, 8}), 0);
  ASSERT_EQ(one.set_array(reference("ON_SET"), {1, 0}), 0);
  ASSERT_EQ(one.step(0.0, 0.001), 0);
  EXPECT_EQ(one.get_array(reference("Y"), 4), (std::vector<double>{10, 12, 14, 16}));
  EXPECT_EQ(one.get_array(reference("N"), 2), (std::vector<double>{0, 7}));
  EXPECT_EQ(one.get("LAST"), 8.0);
  // An array is given whole, and several variables one after the other.
  EXPECT_EQ(one.set_array(reference("X"), {1, 2, 3}), 3);
  EXPECT_EQ(one.set_array(reference("X"), {1, 2, 3, 4, 5}), 3);
  EXPECT_THROW((void)one.get("Y"), std::runtime_error);
  EXPECT_EQ(one.get_array(reference("X"), 4), (std::vector<double>{5, 6, 7, 8}));
  const std::uint32_t both[] = {reference("LAST"), reference("Y")};
  double values[5] = {};
  const auto get = three.function<int(void*, const std::uint32_t*, std::size_t, double*, std::size_t)>("GetFloat64");
  ASSERT_EQ(get(one.component(), both, 2, values, 5), 0);
  EXPECT_EQ(std::vector<double>(values, values + 5), (std::vector<double>{8, 10, 12, 14, 16}));
  void* state = nullptr;
  ASSERT_EQ(one.save(&state), 0);
  const std::vector<char> bytes = one.bytes_of(state);
  ASSERT_EQ(one.set_array(reference("X"), {0, 0, 0, 0}) + one.step(0.001, 0.001), 0);
  void* again = nullptr;
  ASSERT_EQ(one.state_from(bytes, &again) + one.restore(again), 0);
  EXPECT_EQ(one.get_array(reference("X"), 4), (std::vector<double>{5, 6, 7, 8}));
  EXPECT_EQ(one.get_array(reference("Y"), 4), (std::vector<double>{10, 12, 14, 16}));
  EXPECT_EQ(one.forget(&state) + one.forget(&again), 0);

  const LoadedFmu two(packed(rack, FmiVersion::Two));
  FmuInstance elements(two);
  ASSERT_EQ(elements.start(), 0);
  EXPECT_EQ(elements.get("X[3]"), 4.0);
  ASSERT_EQ(elements.set("X[3]", 9.0) + elements.set("TABLE.Y[2]", 11.0) + elements.step(0.0, 0.001), 0);
  EXPECT_EQ(elements.get("Y[3]"), 18.0);
}

TEST(Fmu, StructureNamesEachOutputAsOutputAndInitialUnknown) {
  for (const FmiVersion version : versions) {
    const LoadedFmu fmu(packed(axis, version));
    const pugi::xml_node structure = fmu.root().child("ModelStructure");
    std::set<unsigned> outputs;
    for (const char* const name : {"Y", "K", "Q", "W"}) {
      outputs.insert(fmu.reference(name));
    }
    for (const char* const kind : {"Output", "InitialUnknown"}) {
      std::set<unsigned> found;
      for (const pugi::xml_node node : fmu.three()
                                           ? structure.children(kind)
                                           : structure.child((std::string(kind) + "s").c_str()).children("Unknown")) {
        found.insert(node.attribute(fmu.three() ? "valueReference" : "index").as_uint());
      }
      EXPECT_EQ(found, outputs) << kind;
    }
  }
}

TEST(Fmu, UnitsArePowersOfTheSi) {
  const LoadedFmu fmu(packed(axis, FmiVersion::Three));
  const pugi::xml_node units = fmu.root().child("UnitDefinitions");
  const auto base = [&](const char* name) { return units.find_child_by_attribute("name", name).child("BaseUnit"); };
  EXPECT_EQ(base("um").attribute("m").as_int(), 1);
  EXPECT_DOUBLE_EQ(base("um").attribute("factor").as_double(), 1e-6);
  EXPECT_EQ(base("degC").attribute("K").as_int(), 1);
  EXPECT_DOUBLE_EQ(base("degC").attribute("offset").as_double(), 273.15);
  EXPECT_EQ(fmu.root().child("CoSimulation").attribute("fixedInternalStepSize").as_double(), 0.001);
  for (const pugi::xml_node node : fmu.root().child("ModelVariables").children()) {
    if (const std::string unit = node.attribute("unit").value(); !unit.empty()) {
      EXPECT_TRUE(units.find_child_by_attribute("name", unit.c_str())) << unit;
    }
  }
}

TEST(Fmu, OfEachTypeAValueArrives) {
  for (const FmiVersion version : versions) {
    const LoadedFmu fmu(packed(axis, version));
    FmuInstance one(fmu);
    ASSERT_EQ(one.begin(), 0);
    EXPECT_EQ(one.set("N", -2147483648.0) + one.set("ACTIVE", 0.0) + one.set("STATUS", 65535.0), 0);
    EXPECT_EQ(one.get("K"), -2147483647.0);  // outputs are known while inputs are still set
    EXPECT_EQ(one.get("Q"), 1.0);
    EXPECT_EQ(one.get("W"), 65535.0);
    EXPECT_EQ(one.set("ACTIVE", 1.0), 0);
    EXPECT_EQ(one.get("Q"), 0.0);
  }
}

/// The samples at k * 1 ms that lie in [t, t + h) run; between them outputs are held, and an input counts at the
/// sample.
TEST(Fmu, CommunicationPointsNeedNotBeSamples) {
  const Program program = compile_text(std::string(axis));
  for (const FmiVersion version : versions) {
    const LoadedFmu fmu(packed(axis, version));
    FmuInstance one(fmu);
    ASSERT_EQ(one.start(5.0), 0);
    Machine<double> machine(program);
    std::size_t samples = 0;
    double value = 0.0;
    double time = 5.0;
    for (const double size : {0.0004, 0.0004, 0.0004, 0.0033, 0.0005, 0.01, 0.0001, 0.0009}) {
      value += 1.0;
      ASSERT_EQ(one.set("X", value), 0);
      machine.set_input(0, value);
      ASSERT_EQ(one.step(time, size), 0) << time;
      time += size;
      const auto due = static_cast<std::size_t>(std::ceil((time - 5.0) / 0.001 - 1e-6));
      for (; samples < due; ++samples) {
        machine.step();
      }
      EXPECT_EQ(one.get("Y"), machine.output(0)) << time;
    }
    EXPECT_EQ(samples, 16U);
  }
}

TEST(Fmu, SumsOfRoundedStepsLoseNoSample) {
  const LoadedFmu fmu(
      packed("FUNCTION_BLOCK COUNTER (* @ts 1ms *) VAR_OUTPUT N : DINT; END_VAR VAR LAST : "
             "HY_DELAY_DINT; END_VAR N := LAST.XOUT + 1; LAST(XIN := N); END_FUNCTION_BLOCK",
             FmiVersion::Three));
  FmuInstance one(fmu);
  ASSERT_EQ(one.start(), 0);
  double time = 0.0;
  for (int k = 0; k < 10000; ++k) {
    ASSERT_EQ(one.step(time, 0.0001), 0);
    time += 0.0001;
  }
  EXPECT_EQ(one.get("N"), 1000.0);
}

TEST(Fmu, AParameterIsTunedWhileItRuns) {
  const Program program = compile_text(std::string(axis));
  for (const FmiVersion version : versions) {
    const LoadedFmu fmu(packed(axis, version));
    FmuInstance one(fmu);
    Machine<double> machine(program);
    ASSERT_EQ(one.start() + one.set("X", 3.0), 0);
    machine.set_input(0, 3.0);
    for (int k = 0; k < 20; ++k) {
      if (k == 10) {
        ASSERT_EQ(one.set("GAIN", 4.5) + one.set("LAG.T1", 0.007), 0);
        machine.set_parameter(static_cast<std::size_t>(find_parameter(program.graph, "GAIN")), 4.5);
        machine.set_parameter(static_cast<std::size_t>(find_parameter(program.graph, "LAG.T1")), 0.007);
      }
      ASSERT_EQ(one.step(0.001 * k, 0.001), 0);
      machine.step();
      EXPECT_EQ(one.get("Y"), machine.output(0));
    }
    constexpr int discarded = 2;
    EXPECT_EQ(one.set("GAIN", 10.5), discarded);
    EXPECT_EQ(one.set("GAIN", not_a_number), discarded);
    EXPECT_EQ(one.get("GAIN"), 4.5);
  }
}

TEST(Fmu, ASavedStateGoesOnAsBefore) {
  for (const FmiVersion version : versions) {
    const LoadedFmu fmu(packed(axis, version));
    FmuInstance one(fmu);
    ASSERT_EQ(one.start() + one.set("X", 1.0) + one.step(0.0, 0.004), 0);
    void* state = nullptr;
    ASSERT_EQ(one.save(&state), 0);
    std::vector<char> bytes = one.bytes_of(state);
    ASSERT_EQ(one.step(0.004, 0.005), 0);
    const double expected = one.get("Y");
    ASSERT_EQ(one.step(0.009, 1.0) + one.restore(state) + one.step(0.004, 0.005), 0);
    EXPECT_EQ(one.get("Y"), expected);

    FmuInstance other(fmu);
    void* read = nullptr;
    ASSERT_EQ(other.state_from(bytes, &read), 0);
    ASSERT_EQ(other.restore(read) + other.step(0.004, 0.005), 0);
    EXPECT_EQ(other.get("Y"), expected);
    EXPECT_EQ(one.forget(&state) + other.forget(&read), 0);
    EXPECT_EQ(state, nullptr);

    constexpr int error = 3;
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    EXPECT_EQ(other.state_from(bytes, &read), error);
    bytes.resize(10);
    EXPECT_EQ(other.state_from(bytes, &read), error);
  }
}

TEST(Fmu, CallsThatFmiDoesNotAllowAreRefused) {
  constexpr int error = 3;
  for (const FmiVersion version : versions) {
    const LoadedFmu fmu(packed(axis, version));
    EXPECT_FALSE(FmuInstance(fmu, "another").there());
    FmuInstance one(fmu);
    EXPECT_EQ(one.step(0.0, 0.001), error);
    EXPECT_EQ(one.call("Terminate"), error);
    EXPECT_EQ(one.set("Y", 1.0), error);
    ASSERT_EQ(one.start(), 0);
    EXPECT_EQ(one.step(0.0, 0.0), error);
    EXPECT_EQ(one.step(0.0, -1.0), error);
    EXPECT_EQ(one.step(0.0, not_a_number), error);
    EXPECT_EQ(one.step(0.5, 0.001), error);
    EXPECT_EQ(one.step(0.0, 1e300), error);
    EXPECT_EQ(one.step(0.0, 0.001), 0);
    EXPECT_EQ(one.call("Terminate"), 0);
    EXPECT_EQ(one.step(0.001, 0.001), error);
  }
}

TEST(Fmu, SourcesAreC99WithoutAWarning) {
  for (const FmiVersion version : versions) {
    const test::Workbench bench;
    std::string sources;
    for (const GeneratedFile& file : generate_fmu(compile_text(std::string(axis)), {.version = version}).files) {
      bench.write(file.name, file.text);
    }
    // FMI fixes the arguments, needed or not.
    const auto built = bench.shell(
        "cc -std=c99 -pedantic -Wall -Wextra -Wconversion -Werror -Wno-unused-parameter -fsyntax-only sources/*.c");
    EXPECT_EQ(built.code, 0) << built.err;
  }
}

TEST(Fmu, TheToolWritesItAndTheSameBytesAgain) {
  const test::Workbench bench;
  bench.write("axis.st", axis);
  const auto made = bench.shell("hysteron generate axis.st --target fmu --out m");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.out, "m/axis.fmu\n");
  const std::string bytes = bench.read("m/axis.fmu");
  EXPECT_EQ(bench.shell("TZ=Asia/Tokyo hysteron generate axis.st --target fmu --out m").code, 0);
  EXPECT_EQ(bench.read("m/axis.fmu"), bytes);
  EXPECT_EQ(bench.shell("hysteron generate axis.st --target fmu --fmi 2 --out m").code, 0);
  EXPECT_FALSE(LoadedFmu(bench.read("m/axis.fmu")).three());
  EXPECT_EQ(bench.shell("hysteron generate axis.st --target fmu --fmi 4 --out m").code, 2);
  EXPECT_EQ(bench.shell("hysteron generate axis.st --target c --fmi 2 --out m").code, 2);
}

TEST(Fmu, WithoutACompilerItHasSourcesAndSaysSo) {
  const test::Workbench bench;
  bench.write("axis.st", axis);
  const auto made = bench.shell("CC=no-such-compiler hysteron generate axis.st --target fmu --out m");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(made.err.starts_with("HY748 warning: ")) << made.err;
  const auto files = test::unpacked(bench.read("m/axis.fmu"));
  EXPECT_EQ(files.size(), 5U);
  EXPECT_TRUE(files.contains("sources/axis_fmi3.c"));
}

TEST(Fmu, ACompilerThatRefusesLeavesNothing) {
  const test::Workbench bench;
  bench.write("axis.st", axis);
  const auto made = bench.shell("CC=false hysteron generate axis.st --target fmu --out m");
  EXPECT_EQ(made.code, 2);
  EXPECT_TRUE(made.err.starts_with("HY726 error: ")) << made.err;
  EXPECT_FALSE(bench.has("m/axis.fmu"));
}

}  // namespace
}  // namespace hysteron
