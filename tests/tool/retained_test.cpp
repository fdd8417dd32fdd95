// What an operator has set outlives an edit of the diagram, and a change of the engine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/task/carry.hpp"
#include "tests/tool/workbench.hpp"
#include "tool/serve_program.hpp"

namespace hysteron {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* retained_plant = R"(FUNCTION_BLOCK PLANT  (* @ts 1ms *)
  VAR_INPUT X : LREAL := 1.0;  (* @unit V *) END_VAR
  VAR_OUTPUT Y : LREAL;  (* @unit um *) SLOW : LREAL;  (* @unit um *) N : DINT; END_VAR
  VAR
    HYST : HY_HYSTERESIS_RO := (C1 := 1.5, C2 := 0.1, C3 := 0.7);
    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 7.0);
    LATE : HY_DEAD_TIME := (DEAD_TIME := 0.013);
    AT4 : HY_SAMPLE;  (* @every 4 *)
    BACK : HY_HOLD;
    COUNT : HY_CTU;
  END_VAR

  HYST(XIN := X * WAVE.XOUT);
  WAVE();
  LATE(XIN := HYST.XOUT);
  AT4(XIN := LATE.XOUT);
  BACK(XIN := AT4.XOUT);
  COUNT(CU := HYST.XOUT > 2.0, PV := 3);
  Y := HYST.XOUT;
  SLOW := BACK.XOUT;
  N := COUNT.CV;
END_FUNCTION_BLOCK
)";

std::vector<double> steps_of(runtime::StepProgram& program, int count) {
  std::vector<double> all;
  const std::vector<double> inputs{1.0};
  std::vector<double> outputs(3);
  for (int k = 0; k < count; ++k) {
    program.step(inputs, outputs);
    all.insert(all.end(), outputs.begin(), outputs.end());
  }
  return all;
}

/// As a start does it with values of another layout.
void carry_over(const runtime::StepProgram& from, runtime::StepProgram& to) {
  std::vector<std::byte> kept(from.state_size());
  from.save(kept);
  const auto layout = runtime::read_description(runtime::describe(from.shape()), kept.size());
  runtime::CarriedValues carried =
      runtime::carry_parameters(layout, runtime::parameters_of(from), to.shape(), runtime::parameters_of(to));
  for (std::size_t i = 0; i < carried.parameters.size(); ++i) {
    to.set_parameter(i, carried.parameters[i]);
  }
  to.reset();
  std::vector<std::byte> state(to.state_size());
  to.save(state);
  runtime::carry_state(layout, kept, to.shape(), state, carried);
  to.restore(state);
  EXPECT_THAT(carried.left, IsEmpty());
}

TEST(Retained, AnotherEngineGoesOnWithTheSameBits) {
  const Program program = compile_text(retained_plant);
  for (const auto& [first, second] : {std::pair{tool::Engine::interpreter, tool::Engine::compiled},
                                      std::pair{tool::Engine::compiled, tool::Engine::interpreter}}) {
    for (const int steps : {1, 2, 3, 4, 501}) {  // in each phase of the slower part
      const auto whole = tool::step_program(program, tool::Engine::interpreter, false);
      const auto begun = tool::step_program(program, first, false);
      whole->set_parameter(0, 1.75);
      begun->reset();  // there is one state behind all compiled ones of a library
      begun->set_parameter(0, 1.75);
      (void)steps_of(*whole, steps);
      (void)steps_of(*begun, steps);
      const auto gone_on = tool::step_program(program, second, false);
      carry_over(*begun, *gone_on);
      EXPECT_EQ(steps_of(*gone_on, 300), steps_of(*whole, 300)) << steps;
    }
  }
}

TEST(Retained, AnEditKeepsWhatIsStillTheSameAndSaysWhatIsNot) {
  const test::Workbench bench;
  const std::string run = "hysteron serve plant.st --config RUN.toml --virtual --engine interpreter --cycles ";
  const std::string safe = "[outputs.Y]\nsafe = 0.0\n[outputs.SLOW]\nsafe = 0.0\n[outputs.N]\nsafe = 0.0\n";
  bench.write("RUN.toml", safe + "[retain]\nfolder = \"kept\"\n");
  bench.write("plant.st", retained_plant);
  ASSERT_EQ(bench.shell(run + "500").code, 0);
  std::string edited = retained_plant;
  const auto replace = [&](const std::string& from, const std::string& to) {
    edited.replace(edited.find(from), from.size(), to);
  };
  replace("    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 7.0);",
          "    WAVE : HY_SINE := (AMPLITUDE := 3.0, FREQUENCY := 7.0);\n    FILTER : HY_LAG := (T1 := 0.01);");
  replace("  LATE(XIN := HYST.XOUT);", "  FILTER(XIN := HYST.XOUT);\n  LATE(XIN := FILTER.XOUT);");
  bench.write("plant.st", edited);
  const auto second = bench.shell(run + "500");
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(second.out, HasSubstr(", from retained state "));
  EXPECT_THAT(second.out, HasSubstr(" of another version: "));
  EXPECT_THAT(second.err, HasSubstr("Retain: not taken over: FILTER."));
  EXPECT_THAT(second.err, Not(HasSubstr("HYST.")));
  EXPECT_THAT(bench.shell("ls kept").out, HasSubstr(".aside1"));
  const auto third = bench.shell(run + "500");
  EXPECT_EQ(third.err, "") << "now it is of this diagram";

  bench.write("RUN.toml", safe + "[retain]\nfolder = \"kept\"\nmismatch = \"refuse\"\n");
  bench.write("plant.st", retained_plant);
  EXPECT_THAT(bench.shell(run + "10").err, HasSubstr("HY811 error: "));
}

TEST(Retained, AnotherEngineIsNoOtherDiagram) {
  const test::Workbench bench;
  bench.write("plant.st", retained_plant);
  bench.write("p.toml", "[parameters.HYST]\nC1 = 1.25\n");
  const std::string serve = "hysteron serve plant.st --config RUN.toml --virtual --cycles 50 --engine ";
  for (const std::string mismatch : {"carry", "cold", "refuse"}) {
    bench.write(
        "RUN.toml",
        "[outputs.Y]\nsafe = 0.0\n[outputs.SLOW]\nsafe = 0.0\n[outputs.N]\nsafe = 0.0\n[retain]\nfolder = \"kept_" +
            mismatch + "\"\nmismatch = \"" + mismatch + "\"\n");
    ASSERT_EQ(bench.shell(serve + "compiled --params p.toml").code, 0);
    for (const char* const engine : {"interpreter", "compiled", "interpreter"}) {
      const auto outcome = bench.shell(serve + engine);
      EXPECT_EQ(outcome.code, 0) << outcome.err;
      EXPECT_EQ(outcome.err, "");
      EXPECT_THAT(outcome.out, HasSubstr(" with 1 parameter as retained and not as given: HYST.C1 ("));
      EXPECT_THAT(outcome.out, Not(HasSubstr("another version")));
    }
    EXPECT_EQ(bench.shell("ls kept_" + mismatch).out, "retain_a\nretain_b\n") << "nothing is put aside";
  }
}

/// Folders that are none get the mend of that.
TEST(Retained, AFileIsNoFolder) {
  const test::Workbench bench;
  bench.write("plant.st", retained_plant);
  const auto outcome = bench.shell("hysteron retained plant.st");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("Not a directory\nmend: name the folder that stands at `folder`"));
}

/// What was tuned at the machine goes back into the project, and the other way round.
TEST(Retained, ParametersGoIntoAFileAndBack) {
  const test::Workbench bench;
  bench.write("plant.st", retained_plant);
  bench.write(
      "RUN.toml",
      "[outputs.Y]\nsafe = 0.0\n[outputs.SLOW]\nsafe = 0.0\n[outputs.N]\nsafe = 0.0\n[retain]\nfolder = \"kept\"\n");
  bench.write("p.toml",
              "# of machine 7\n[parameters.HYST]\nC1 = 1.6  # measured on Monday\n\n[fit.HYST]\nC1 = {min = 1.0}\n");
  const std::string run = "hysteron serve plant.st --config RUN.toml --virtual --cycles 100 --engine interpreter";
  ASSERT_EQ(bench.shell(run + " --params p.toml").code, 0);
  const auto shown = bench.shell("hysteron retained kept");
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("  HYST.C1 "));
  EXPECT_THAT(shown.out, HasSubstr("  1.6\n"));
  EXPECT_THAT(bench.shell("hysteron retained kept --json").out, HasSubstr("\"name\": \"HYST.C1\""));

  bench.write("on_site.toml", "[parameters.HYST]\nC1 = 1.75\n");
  EXPECT_EQ(bench.shell("hysteron retained kept --set on_site.toml").code, 0);
  EXPECT_THAT(bench.shell(run).out, HasSubstr("1 parameter as retained and not as given: HYST.C1"));
  const auto written = bench.shell("hysteron retained kept --params p.toml --out back.toml");
  EXPECT_EQ(written.code, 0) << written.err;
  EXPECT_THAT(bench.read("back.toml"), HasSubstr("# of machine 7"));
  EXPECT_THAT(bench.read("back.toml"), HasSubstr("C1 = 1.75"));
  EXPECT_THAT(bench.read("back.toml"), HasSubstr("min = 1.0"));
  const auto given = bench.shell(run + " --params back.toml");
  EXPECT_EQ(given.code, 0) << given.err;
  EXPECT_THAT(given.out, Not(HasSubstr("not as given")));

  for (const char* const beyond : {"[parameters.LATE]\nDEAD_TIME = -1.0\n", "[parameters.LATE]\nSETTLED = 7.5\n",
                                   "[parameters.HYST]\nC1 = true\n"}) {
    bench.write("beyond.toml", beyond);
    EXPECT_THAT(bench.shell("hysteron retained kept --set beyond.toml").err, HasSubstr("HY214 error: beyond.toml:2"));
  }
  EXPECT_THAT(bench.shell("hysteron retained kept --out kept/retain_a").err, HasSubstr("HY709 error: "));
  bench.write("wrong.toml", "[parameters.NONE]\nK = 1.0\n");
  const auto refused = bench.shell("hysteron retained kept --set wrong.toml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("NONE.K is not among the retained parameters."));
  EXPECT_THAT(bench.shell("hysteron retained nowhere").err,
              HasSubstr("HY816 error: nowhere: there are no retained values"));
  bench.write("bad/retain_a", "nothing");
  EXPECT_THAT(bench.shell("hysteron retained bad").err, HasSubstr("no slot is whole"));
}

}  // namespace
}  // namespace hysteron
