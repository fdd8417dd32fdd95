// The run file on ordinary days: what a start waits for, what a restart keeps, and what a trigger may take.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "runtime/host/served_map.hpp"
#include "runtime/modbus/map_text.hpp"
#include "tests/runtime/config/run_file.hpp"
#include "tests/runtime/task/accumulator.hpp"

namespace hysteron::runtime {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string safe_y = "[outputs.Y]\nsafe = 0.0\n";

std::string mend_of(const std::string& text) {
  try {
    (void)parse_run_config("RUN.toml", text, plant());
  } catch (const InputError& refused) {
    return refused.diagnostics().all().front().mend;
  }
  return "";
}

TEST(RunDays, WhatAStartWaitsForIsRead) {
  const auto config =
      parse_run_config("RUN.toml",
                       "[watchdog]\nguard_wait = \"2min\"\n[devices.a]\non_absence = \"go_on\"\n[devices.b]\n" +
                           safe_y + "[online_change]\nsocket = \"a.socket\"\nload = 0.5\n",
                       plant());
  EXPECT_EQ(config.guard_wait, 120'000'000'000);
  EXPECT_TRUE(config.devices[0].may_be_absent);
  EXPECT_FALSE(config.devices[1].may_be_absent);
  EXPECT_EQ(config.online_change->most_load, 0.5);
  EXPECT_EQ(parse_run_config("RUN.toml", safe_y, plant()).guard_wait, 60'000'000'000);
  EXPECT_EQ(errors_of(safe_y + "[online_change]\nsocket = \"a.socket\"\nload = 1.5\n"), "805@5:8 ");
}

/// The name of a vector is each of its elements, as in a history and in MQTT; a register is of one element.
TEST(RunDays, AVectorIsGivenByItsName) {
  ProgramShape shape = plant();
  shape.inputs = {{.name = "S[0]"}, {.name = "S[1]"}, {.name = "Z"}};
  shape.outputs = {{.name = "Y[1]", .low = -1.0}, {.name = "Y[2]", .low = -1.0}};
  const std::string retain = "[retain]\nfolder = \"kept\"\n";
  const std::string both = "[outputs.y]\nsafe = 0.5\nslew = 2.0\n";
  const auto config = parse_run_config("RUN.toml", retain + both + "[inputs.S]\nretain = true\n", shape);
  EXPECT_TRUE(config.task.inputs[0].is_retained && config.task.inputs[1].is_retained);
  EXPECT_FALSE(config.task.inputs[2].is_retained);
  for (const OutputSafety& output : config.task.outputs) {
    EXPECT_EQ(output.value, 0.5);
    EXPECT_EQ(output.slew, 2.0);
  }
  EXPECT_EQ(errors_of(both + "[outputs.\"Y[1]\"]\nsafe = 0.5\n", shape), "802@1:10 ") << "which of the two counts?";
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = -2.0\n", shape), "808@2:8 ") << "once, and not for each element";
  EXPECT_EQ(errors_of("[devices.a]\n" + both + "device = \"a\"\n", shape), "804@5:10 ");
  EXPECT_EQ(errors_of("[devices.a]\n" + both + "[inputs.S]\ndevice = \"a\"\n", shape), "804@6:10 ");
  EXPECT_EQ(errors_of(both + "[inputs.T]\nretain = true\n", shape), "807@4:9 ");
}

TEST(RunDays, RetainIsOfInputsThatClientsWriteAndOfAFolder) {
  const std::string retain = "[retain]\nfolder = \"kept\"\n";
  const auto config = parse_run_config("RUN.toml", safe_y + retain + "[inputs.Z]\nretain = true\n", plant());
  EXPECT_FALSE(config.task.inputs[0].is_retained);
  EXPECT_TRUE(config.task.inputs[1].is_retained);
  EXPECT_EQ(errors_of(safe_y + "[inputs.Z]\nretain = true\n"), "804@4:10 ");
  EXPECT_EQ(errors_of(safe_y + retain + "[devices.a]\n[inputs.Z]\nretain = true\ndevice = \"a\"\n"), "804@7:10 ");
}

TEST(RunDays, TheMapSaysWhichInputsAreRetained) {
  const test::Accumulator program;
  const auto map_of = [&](const std::string& rest) {
    return register_map_of(parse_run_config("RUN.toml",
                                            "[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n"
                                            "[retain]\nfolder = \"kept\"\n" +
                                                rest,
                                            program.shape()),
                           program);
  };
  const auto with = map_of("[inputs.X]\nretain = true\n");
  const auto without = map_of("");
  EXPECT_THAT(modbus::as_markdown(with), HasSubstr("| X | V |  |  | read write, retained |"));
  EXPECT_THAT(modbus::as_json(with), HasSubstr("\"retained\": true"));
  EXPECT_THAT(modbus::as_markdown(without),
              AllOf(HasSubstr("| X | V |  |  | read write |"), Not(HasSubstr("write, retained |"))));
  EXPECT_EQ(with.hash(), without.hash()) << "it lies where it lay";
}

TEST(RunDays, ATriggerHasRoomForWhatItKeepsAndCaptures) {
  const std::string trace = safe_y + "[trace]\nfile = \"run.trace\"\n";
  const auto config = parse_run_config("RUN.toml", trace + "trigger = \"fault\"\ncaptures = 8\n", plant());
  EXPECT_EQ(config.trace->trigger->captures, 8U);
  EXPECT_EQ(errors_of(trace + "captures = 2\n"), "804@5:12 ");
  EXPECT_EQ(errors_of(trace + "trigger = \"fault\"\ncaptures = 9\n"), "805@6:12 ");
  EXPECT_EQ(errors_of(trace + "trigger = \"fault\"\ncaptures = 9\nfiles = 9\n"), "");
  ProgramShape wide = plant();
  wide.inputs.resize(100, {.name = "I"});
  for (std::size_t i = 0; i < wide.inputs.size(); ++i) {
    wide.inputs[i].name += std::to_string(i);
  }
  // 1,000,000 cycles of 102 numbers and their head, twice.
  EXPECT_EQ(errors_of(trace + "trigger = \"fault\"\nbefore = 1000000\n", wide), "805@6:10 ");
  EXPECT_EQ(errors_of(trace + "trigger = \"fault\"\nbefore = 1000000\n"), "");
}

TEST(RunDays, AnAddressThatIsNoneIsToldFromOneThatIsNotThereYet) {
  EXPECT_EQ(errors_of(safe_y + "[modbus]\nlisten = \"192.0.2.1\"\n"), "");
  EXPECT_EQ(errors_of(safe_y + "[modbus]\nlisten = \"localhost\"\n"), "829@4:10 ");
  EXPECT_THAT(mend_of(safe_y + "[modbus]\nlisten = \"of\"\n"), HasSubstr("did you mean \"off\"?"));
  EXPECT_THAT(mend_of(safe_y + "[modbus]\nlisten = \"localhost\"\n"), HasSubstr("127.0.0.1 for this machine alone"));
}

TEST(RunDays, TheLivePageForcesNothingUnlessItIsSaid) {
  const auto web = [](const std::string& rest) { return parse_run_config("RUN.toml", safe_y + rest, plant()).web; };
  EXPECT_FALSE(web(""));
  const auto plain = web("[web]\nlisten = \"127.0.0.1:8080\"\ntoken_file = \"t\"\nread_token_file = \"r\"\n");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->listen, "127.0.0.1:8080");
  EXPECT_EQ(plain->token_file, "t");
  EXPECT_EQ(plain->read_token_file, "r");
  EXPECT_TRUE(plain->rights.parameters && plain->rights.reset && !plain->rights.force);
  const auto forcing = web("[web]\nrights = [\"force\"]\n");
  ASSERT_TRUE(forcing);
  EXPECT_TRUE(!forcing->rights.parameters && !forcing->rights.reset && forcing->rights.force);
  const auto nothing = web("[web]\nrights = []\n");
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(!nothing->rights.parameters && !nothing->rights.reset && !nothing->rights.force);
}

/// What a place on a device does not hold is said of inputs and outputs, and none where the run file limits it.
TEST(RunDays, ADeclaredRangeThatADeviceDoesNotHoldIsAWarning) {
  const auto warnings = [](const std::string& rest) {
    std::string all;
    const auto config = parse_run_config(
        "RUN.toml", "[devices.a]\n[outputs.Y]\nsafe = 0.0\ndevice = \"a\"\ntype = \"int16\"\nscale = 0.0001\n" + rest,
        plant());
    for (const Diagnostic& one : config.warnings.all()) {
      all += one.cause;
    }
    return all;
  };
  EXPECT_EQ(warnings(""), "Y goes from -10 to 10, and its format, int16, reaches -3.2768 to 3.2767 alone.");
  EXPECT_EQ(warnings("low = -3.0\nhigh = 3.0\n"), "");
}

}  // namespace
}  // namespace hysteron::runtime
