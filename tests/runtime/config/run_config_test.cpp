// The run file: what it says arrives, and what it must not say is refused at its place.
#include "runtime/config/run_config.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/errors.hpp"
#include "tests/runtime/config/run_file.hpp"
#include "tests/support/error_page.hpp"

namespace hysteron::runtime {
namespace {

TEST(RunConfig, SaysEverything) {
  const auto config = parse_run_config("RUN.toml", R"(
[task]
period = "1ms"
missed = "catch_up"
catch_up = 5
tolerance = "50us"
scheduling = "deadline"
processor = 1
lock_memory = false
[watchdog]
time = "5ms"
sensitivity = 2
guard = false
silence = "0.1s"
[outputs.y]
safe = -1
on_fault = "ramp"
ramp = 20.0
hold_cycles = 10
low = -5.0
slew = 1000.0
device = "stage"
register = 8
[inputs.X]
device = "stage"
register = 4
[inputs.Z]
longest_age = "20ms"
[devices.stage]
host = "10.0.0.7"
port = 1502
unit = 3
cycle = "2ms"
timeout = "150ms"
[retain]
folder = "kept"
every = 100
mismatch = "cold"
[trace]
file = "run.trace"
trigger = "Y > 2.5"
before = 7
after = 9
[modbus]
listen = "0.0.0.0"
port = 1600
allow = ["10.0.0.0/8"]
connections = 4
read_only = true
word_order = "cdab"
lock_file = "plant.lock"
)",
                                       plant());
  EXPECT_EQ(config.task.loop.policy, MissedPolicy::catch_up);
  EXPECT_EQ(config.task.loop.catch_up, 5U);
  EXPECT_EQ(config.task.loop.tolerance, 50'000);
  EXPECT_EQ(config.scheduling.scheduling, Scheduling::deadline);
  EXPECT_EQ(config.scheduling.processor, 1);
  EXPECT_FALSE(config.scheduling.lock_memory);
  EXPECT_EQ(config.task.watchdog.longest(), 10'000'000);
  EXPECT_FALSE(config.guard);
  EXPECT_EQ(config.silence, 100'000'000);
  const OutputSafety& y = config.task.outputs[0];
  EXPECT_EQ(y.value, -1.0);
  EXPECT_EQ(y.action, SafeAction::ramp);
  EXPECT_EQ(y.ramp, 20.0);
  EXPECT_EQ(y.hold_cycles, 10U);
  EXPECT_EQ(y.low, -5.0);
  EXPECT_EQ(y.high, 10.0);  // the diagram's
  EXPECT_EQ(y.slew, 1000.0);
  ASSERT_EQ(config.devices.size(), 1U);
  const modbus::DeviceOptions& stage = config.devices[0];
  EXPECT_EQ(config.device_outputs[0].port, 0U);
  EXPECT_EQ(stage.values[config.device_outputs[0].link.value].at,
            (modbus::Stretch{modbus::Area::holding_register, 8, 4}));
  EXPECT_TRUE(config.task.inputs[0].from_device);
  EXPECT_FALSE(config.task.inputs[1].from_device);
  EXPECT_EQ(config.task.inputs[1].longest_age, 20U);
  EXPECT_EQ(std::get<modbus::TcpLink>(stage.link), (modbus::TcpLink{.host = "10.0.0.7", .port = 1502}));
  EXPECT_EQ(stage.unit, 3);
  EXPECT_EQ(stage.period, std::chrono::milliseconds(2));
  EXPECT_EQ(stage.response, std::chrono::milliseconds(150));
  EXPECT_EQ(config.retain->mismatch, MismatchPolicy::cold);
  EXPECT_EQ(config.task.retain_every, 100U);
  EXPECT_EQ(config.trace->trigger->level, 2.5);
  EXPECT_EQ(config.trace->trigger->before, 7U);
  EXPECT_EQ(config.modbus->port, 1600);
  EXPECT_EQ(config.modbus->connections, 4U);
  EXPECT_EQ(config.modbus->connections_per_address, 1U) << "a quarter of them";
  EXPECT_EQ(config.modbus->word_order, modbus::WordOrder::cdab);
  EXPECT_TRUE(config.modbus->read_only);
}

TEST(RunConfig, NeedsTheSafeValuesAndNothingElse) {
  const auto config = parse_run_config("RUN.toml", "[outputs.Y]\nsafe = 0.0\n", plant());
  EXPECT_EQ(config.task.loop.policy, MissedPolicy::skip);
  EXPECT_TRUE(config.guard);
  EXPECT_TRUE(std::isinf(config.task.outputs[0].slew));
  EXPECT_FALSE(config.modbus || config.trace || config.retain);
  EXPECT_EQ(errors_of(""), "806@0:0 ");
}

TEST(RunConfig, CollectsErrorsInTheOrderOfTheFile) {
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = \"0\"\nslow = 1\n[task]\npriority = 0\nmissed = \"skipp\"\n[extra]\n"),
            "804@2:8 803@3:1 805@5:12 804@6:10 803@7:2 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = inf\n"), "805@2:8 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\nslew = 0.0\n"), "805@3:8 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\nsafe = 1\n"), "802@3:1 ");
  EXPECT_EQ(errors_of("outputs = 3\n"), "806@0:0 804@1:11 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\non_fault = \"ramp\"\n"), "808@3:12 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\n[inputs.X]\nregister = 3\n"), "810@4:12 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\n[retain]\nevery = 5\n"), "804@3:1 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\n[modbus]\nallow = [1]\n"), "804@4:9 ");
}

/// Place, cause and mend of the only error.
std::string error_of(std::string_view text, const ProgramShape& shape = plant()) {
  try {
    (void)parse_run_config("RUN.toml", text, shape);
  } catch (const InputError& refused) {
    const Diagnostic& one = refused.diagnostics().all().front();
    return fmt::format("{}@{}:{} {} | {}", one.number, one.place.line, one.place.column, one.cause, one.mend);
  }
  return "";
}

TEST(RunConfig, ASafeValueIsOneThatItsTypesHold) {
  const auto on_device = [](const std::string& safe, const std::string& rest) {
    return "[devices.a]\n[outputs.W]\nsafe = 0\n[outputs.Y]\nsafe = " + safe + "\ndevice = \"a\"\n" + rest;
  };
  ProgramShape shape = plant_of_two();
  shape.outputs[0].low = -1e300;
  shape.outputs[0].high = 1e300;
  EXPECT_EQ(error_of(on_device("0.5", "type = \"int16\"\n"), shape),
            "808@5:8 The safe value 0.5 of Y is none that the type of its place on a holds, int16. | choose a whole "
            "number from -32768 to 32767, or another type.");
  for (const auto& [safe, rest] : {std::pair("40000", "type = \"int16\"\n"),
                                   {"-1", "type = \"uint32\"\n"},
                                   {"2", "area = \"coil\"\n"},
                                   {"1e39", "type = \"real32\"\n"}}) {
    EXPECT_EQ(errors_of(on_device(safe, rest), shape), "808@5:8 ") << safe << rest;
  }
  for (const auto& [safe, rest] : {std::pair("-32768", "type = \"int16\"\n"),
                                   {"1", "area = \"coil\"\n"},
                                   {"0.1", "type = \"real32\"\n"},
                                   {"1e39", "type = \"real64\"\n"}}) {
    EXPECT_EQ(errors_of(on_device(safe, rest), shape), "") << safe << rest;
  }
  shape.outputs[0].type = PointType::int32;
  EXPECT_EQ(error_of("[outputs.W]\nsafe = 0\n[outputs.Y]\nsafe = 0.5\n", shape),
            "808@4:8 The safe value 0.5 of Y is none that the type of the output holds, int32. | choose a whole number "
            "from -2147483648 to 2147483647.");
}

TEST(RunConfig, WhatIsWrongIsWhatIsNamed) {
  const std::string y = "[outputs.Y]\nsafe = 0\n";
  EXPECT_TRUE(error_of(y + "low = 3\nhigh = 1\n")
                  .starts_with("805@3:7 The limits of Y leave no value: low is 3, and high 1. |"))
      << error_of(y + "low = 3\nhigh = 1\n");
  EXPECT_EQ(errors_of(y + "high = -20\n"), "805@3:8 ") << "the diagram's low is -10";
  EXPECT_EQ(error_of("[outputs.Y]\nsafe = nan\n"),
            "805@2:8 safe must be a finite number. | choose a value in that range.");
  EXPECT_EQ(error_of("[outputs.Y]\nsafe = false\n"),
            "804@2:8 safe must be a number, of a BOOL 0 or 1. | write it as in safe = 0.");
  EXPECT_EQ(error_of(y + "[web]\nrights = [\"force\", \"write\"]\n"),
            "804@4:10 The live page has no right \"write\". | use some of: parameters, reset, force.");
  EXPECT_EQ(error_of(y + "[web]\nrights = [1]\n"),
            "804@4:10 rights must be a list of texts. | write it as in rights = [\"parameters\", \"reset\"].");
  EXPECT_EQ(error_of(y + "[online_change]\nsocket = \"a\"\nload = 2\n"),
            "805@5:8 load must be from 0.001 to 1. | choose a value in that range, or leave the key out.");
  EXPECT_EQ(error_of(y + "[modbus]\nlisten = \"\"\n"),
            "804@4:10 listen must be a text that is not empty. | write it as in listen = \"name\".");
  EXPECT_EQ(error_of(y + "[inputs.X]\nretain = true\n"),
            "804@4:10 An input has retain = true, and nothing is retained. | add [retain] with folder = \"retained\", "
            "or remove the key.");
  EXPECT_EQ(errors_of("[outputs.Y]\nlow = 1\n"), "806@1:10 ") << "its table, where it has one";
  EXPECT_EQ(error_of(y + "[modbus]\nallow = [\"127.0.0.1\", \"10.0.0.0/33\"]\n").substr(0, 37),
            "830@4:23 10.0.0.0/33 is no network. |");
  ProgramShape fast = plant();
  fast.period = 100'000;
  EXPECT_TRUE(error_of(y + "[task]\nperiod = \"1ms\"\n", fast)
                  .starts_with("809@4:10 The period is not the sample time of PLANT, which is 100us. |"))
      << error_of(y + "[task]\nperiod = \"1ms\"\n", fast);
}

TEST(RunConfig, AHeartbeatOfWritesNeedsWrites) {
  const std::string start = "[outputs.Y]\nsafe = 0.0\n[modbus]\nheartbeat_time = \"250ms\"\nown_writes = true\n";
  const auto config = parse_run_config("RUN.toml", start + "heartbeat = \"write\"\nafter_loss = \"reset\"\n", plant());
  EXPECT_EQ(config.modbus->heartbeat.mode, modbus::HeartbeatMode::write_telegram);
  EXPECT_EQ(config.modbus->heartbeat.time, std::chrono::milliseconds(250));
  EXPECT_TRUE(config.modbus->heartbeat.own_writes);
  EXPECT_TRUE(config.task.reset_after_lost_client);
  EXPECT_FALSE(parse_run_config("RUN.toml", start, plant()).task.reset_after_lost_client);
  EXPECT_EQ(errors_of(start + "read_only = true\nheartbeat = \"any\"\n"), "");
  EXPECT_EQ(errors_of(start + "read_only = true\nheartbeat = \"write\"\n"), "804@7:13 ");
  EXPECT_EQ(errors_of(start + "read_only = true\nafter_loss = \"reset\"\n"), "804@7:14 ");
}

TEST(RunConfig, ValuesOnDevicesHaveATypeAndAPlace) {
  const auto config = parse_run_config("RUN.toml", R"(
[devices.drive]
serial = "/dev/ttyS3"
baud = 115200
parity = "none"
stop_bits = 2
unit = 17
word_order = "cdab"
[outputs.Y]
safe = 0
device = "drive"
register = 100
type = "int16"
low = -1e6
high = 10
on_loss = "keep"
[inputs.X]
device = "drive"
register = 7
area = "discrete"
longest_age = "3s"
[inputs.Z]
age_of = "y"
)",
                                       plant());
  const modbus::DeviceOptions& drive = config.devices.at(0);
  EXPECT_EQ(std::get<modbus::SerialLink>(drive.link),
            (modbus::SerialLink{.path = "/dev/ttyS3", .baud = 115200, .parity = 'N', .stop_bits = 2}));
  EXPECT_EQ(drive.unit, 17);
  EXPECT_EQ(drive.values.at(0).format.order, modbus::WordOrder::cdab);
  const auto x = std::ranges::find(config.device_inputs, Tells::value, &DeviceInput::tells);
  EXPECT_EQ(drive.values.at(x->link.value).at, (modbus::Stretch{modbus::Area::discrete_input, 7, 1}));
  EXPECT_EQ(drive.values.at(x->link.value).format.type, PointType::boolean);
  EXPECT_EQ(drive.values.at(x->link.value).longest_age, std::chrono::seconds(3));
  const DeviceOutput& y = config.device_outputs.at(0);
  EXPECT_EQ(drive.values.at(y.link.value).at, (modbus::Stretch{modbus::Area::holding_register, 100, 1}));
  EXPECT_EQ(drive.values.at(y.link.value).format.type, PointType::int16);
  EXPECT_FALSE(y.link.faults);
  EXPECT_EQ(config.task.outputs[0].low, -32768.0) << "it cannot hold less";
  EXPECT_EQ(config.task.outputs[0].high, 10.0);
  const auto age = std::ranges::find(config.device_inputs, Tells::age, &DeviceInput::tells);
  EXPECT_EQ(age->port, 1U);
  EXPECT_EQ(age->link.value, y.link.value);
  EXPECT_TRUE(config.task.inputs[1].from_device) << "no client may write it";
}

TEST(RunConfig, DevicesAreRefusedAtTheirPlace) {
  const std::string y = "[outputs.Y]\nsafe = 0\n";
  EXPECT_EQ(errors_of(y + "[devices.a]\nbaud = 9600\n"), "804@4:8 ");
  EXPECT_EQ(errors_of(y + "[devices.a]\nserial = \"/dev/ttyS0\"\nport = 502\n"), "804@5:8 ");
  EXPECT_EQ(errors_of(y + "[devices.a]\nserial = \"/dev/ttyS0\"\nparity = \"E\"\n"), "804@5:10 ");
  const std::string x = y + "[devices.a]\n[inputs.X]\ndevice = \"a\"\n";
  EXPECT_EQ(errors_of(x + "type = \"boolean\"\n"), "804@6:8 ");
  EXPECT_EQ(errors_of(x + "area = \"coil\"\ntype = \"real32\"\n"), "804@7:8 ");
  EXPECT_EQ(errors_of(x + "register = 65533\n"), "805@6:12 ");
  EXPECT_EQ(errors_of(x + "register = 65535\ntype = \"uint16\"\n"), "");
  EXPECT_EQ(errors_of(x + "age_of = \"Y\"\n"), "804@6:10 810@6:10 ");
  EXPECT_EQ(errors_of(x + "[inputs.Z]\nquality_of = \"Y\"\n"), "810@7:14 ");
  EXPECT_EQ(errors_of(x + "[inputs.Z]\nquality_of = \"x\"\n"), "");
  EXPECT_EQ(errors_of(y + "area = \"input\"\ndevice = \"a\"\n[devices.a]\n"), "804@3:8 ");
}

TEST(RunConfig, ARegisterWrittenTwiceHasItsPage) {
  const auto page = hysteron::test::read_error_page("HY813");
  EXPECT_EQ(errors_of(page.fails.text, plant_of_two()), "813@9:12 ");
  EXPECT_EQ(errors_of(page.mended.text, plant_of_two()), "");
}

TEST(RunConfig, AddressesMayBeGiven) {
  const std::string server = "[outputs.Y]\nsafe = 0\n[modbus]\nmap = \"openplc\"\n[addresses]\n";
  const auto config = parse_run_config(
      "RUN.toml", server + "X = \"%QW5\"\n\"HYST.C1\" = \"holding 16\"\ntask.commit = \"%QW7\"\n", plant());
  EXPECT_EQ(config.modbus->placing, modbus::Placing::openplc);
  std::map<std::string, std::string> given;
  for (const modbus::GivenRegister& one : config.modbus->registers) {
    given[one.name] = one.address + "@" + std::to_string(one.place.line);
  }
  EXPECT_EQ(given, (std::map<std::string, std::string>{
                       {"X", "%QW5@6"}, {"HYST.C1", "holding 16@7"}, {"task.commit", "%QW7@8"}}));
  EXPECT_EQ(errors_of(server + "X = 5\n"), "804@6:5 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\n[addresses]\nX = \"%QW5\"\n"), "804@4:5 ");
}

TEST(RunConfig, TlsAndRolesArrive) {
  const std::string server = "[outputs.Y]\nsafe = 0\n[modbus]\n";
  const std::string tls = "[tls]\ncertificate = \"s.pem\"\nkey = \"s.key\"\nclients = \"c.pem\"\n";
  const auto config = parse_run_config("RUN.toml",
                                       server + tls +
                                           "without_role = [\"read\"]\n[roles]\noperator = [\"read\", \"inputs\"]\n"
                                           "\"tuner (night)\" = [\"parameters\", \"reset\"]\nnobody = []\n",
                                       plant());
  const modbus::TlsOptions& options = config.modbus->tls.value();
  EXPECT_EQ(config.modbus->port, 802) << "the port of Modbus/TCP Security, where none is given";
  EXPECT_EQ(options.certificate + options.key + options.clients, "s.pems.keyc.pem");
  EXPECT_EQ(options.key_place.line, 6U);
  EXPECT_EQ(options.without_role, modbus::Rights{}.without_writes());
  EXPECT_EQ(options.roles.at("operator"),
            (modbus::Rights{.read = true, .inputs = true, .parameters = false, .reset = false}));
  EXPECT_EQ(options.roles.at("tuner (night)"),
            (modbus::Rights{.read = false, .inputs = false, .parameters = true, .reset = true}));
  EXPECT_EQ(options.roles.at("nobody"), modbus::no_rights);
  EXPECT_EQ(
      parse_run_config("RUN.toml", server + "port = 0\n" + tls + "[roles]\na = [\"read\"]\n", plant()).modbus->port, 0);
  EXPECT_FALSE(parse_run_config("RUN.toml", server, plant()).modbus->tls);
}

TEST(RunConfig, TlsAndRolesAreRefusedAtTheirPlace) {
  const std::string server = "[outputs.Y]\nsafe = 0\n[modbus]\n";
  const std::string tls = "[tls]\ncertificate = \"s.pem\"\nkey = \"s.key\"\nclients = \"c.pem\"\n";
  EXPECT_EQ(errors_of(server + tls + "[roles]\noperator = [\"write\"]\n"), "804@9:12 ");
  EXPECT_EQ(errors_of(server + tls + "[roles]\noperator = \"read\"\n"), "804@9:12 ");
  EXPECT_EQ(errors_of(server + tls + "[roles]\noperator = [1]\n"), "804@9:12 ");
  EXPECT_EQ(errors_of(server + tls + "[roles]\n\"\" = [\"read\"]\n"), "804@9:6 ");
  EXPECT_EQ(errors_of(server + tls + "without_role = [\"all\"]\n[roles]\na = [\"read\"]\n"), "804@8:16 ");
  EXPECT_EQ(errors_of(server + tls + "[roles]\noperator = []\n"), "835@4:1 ");
  EXPECT_EQ(errors_of(server + "[tls]\nkey = \"s.key\"\n[roles]\na = [\"read\"]\n"), "804@4:1 804@4:1 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\n" + tls), "836@3:1 ");
}

TEST(RunConfig, AnOutputUnderTwoSpellingsIsRefused) {
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0\n[outputs.y]\nsafe = 1\n"), "802@3:10 ");
}

TEST(RunConfig, CyclesAroundATriggerNeedOne) {
  const std::string trace = "[outputs.Y]\nsafe = 0\n[trace]\nfile = \"run.trace\"\n";
  EXPECT_EQ(errors_of(trace + "before = 10\nafter = 20\n"), "804@5:10 804@6:9 ");
  EXPECT_EQ(errors_of(trace + "before = -1\ntrigger = \"fault\"\n"), "805@5:10 ");
  EXPECT_EQ(errors_of(trace + "after = \"many\"\n"), "804@5:9 804@5:9 ");
  EXPECT_EQ(errors_of(trace + "after = 20\ntrigger = \"fault\"\n"), "");
}

TEST(RunConfig, DurationsAreWholeNanoseconds) {
  EXPECT_EQ(parse_duration("5ms"), 5'000'000);
  EXPECT_EQ(parse_duration("0.25us"), 250);
  EXPECT_EQ(parse_duration("2s"), 2'000'000'000);
  EXPECT_EQ(parse_duration("1.5min"), 90'000'000'000);
  EXPECT_EQ(parse_duration("12h"), 43'200'000'000'000);
  EXPECT_EQ(parse_duration("30d"), 2'592'000'000'000'000);
  for (const char* const wrong : {"", "5", "ms", "5 ms", "-5ms", "0.5ns", "5m", "5D", "1e3ms", "99999999999s"}) {
    EXPECT_FALSE(parse_duration(wrong)) << wrong;
  }
}

TEST(RunConfig, TriggersNameASignalOfTheProgram) {
  const auto trigger = parse_trigger(" x<-1.5 ", plant());
  ASSERT_TRUE(trigger);
  EXPECT_EQ(trigger->signal, TraceTrigger::Signal::input);
  EXPECT_FALSE(trigger->above);
  EXPECT_EQ(trigger->level, -1.5);
  EXPECT_EQ(parse_trigger("FAULT", plant())->signal, TraceTrigger::Signal::fault);
  for (const char* const wrong : {"", "Y", "Y >", "> 1", "Q > 1", "Y > one", "Y >= 1"}) {
    EXPECT_FALSE(parse_trigger(wrong, plant())) << wrong;
  }
}

class RunFilePages : public testing::TestWithParam<int> {};

TEST_P(RunFilePages, FailAndMend) {
  const auto page = hysteron::test::read_error_page("HY" + std::to_string(GetParam()));
  EXPECT_TRUE(errors_of(page.fails.text).starts_with(std::to_string(GetParam()) + "@")) << errors_of(page.fails.text);
  EXPECT_EQ(std::ranges::count(errors_of(page.fails.text), '@'), 1);
  EXPECT_EQ(errors_of(page.mended.text), "");
}

INSTANTIATE_TEST_SUITE_P(Numbers, RunFilePages, testing::Range(801, 811));
INSTANTIATE_TEST_SUITE_P(Tls, RunFilePages, testing::Values(error::no_role_may_anything, error::roles_without_tls));

TEST(RunConfig, AHistoryNamesPointsInTheWordsOfTheDoor) {
  const std::string safe = "[outputs.Y]\nsafe = 0.0\n";
  const auto read = [&](const std::string& keys) {
    return *parse_run_config("RUN.toml", safe + "[history]\nfile = \"a.sqlite\"\n" + keys, plant()).history;
  };
  const HistoryConfig usual = read("");
  EXPECT_EQ(usual.points, (std::vector<std::string>{"X", "Z", "Y"}));
  EXPECT_EQ(usual.step, 1000U);
  EXPECT_EQ(usual.keep, 30 * 86'400'000'000'000);
  EXPECT_EQ(usual.bytes, 1'000'000'000U);
  const HistoryConfig own =
      read("points = [\"y\", \"TASK.FAULT\", \"Y\"]\nevery = \"5ms\"\nkeep = \"12h\"\nmegabytes = 5\n");
  EXPECT_EQ(own.points, (std::vector<std::string>{"Y", "task.fault"}));
  EXPECT_EQ(own.step, 5U);
  EXPECT_EQ(own.keep, 12 * 3'600'000'000'000);
  EXPECT_EQ(own.bytes, 5'000'000U);
  const auto errors = [&](const std::string& keys) { return errors_of(safe + "[history]\n" + keys); };
  EXPECT_EQ(errors("keep = \"1d\"\n"), "804@3:1 ");
  const std::string file = "file = \"a\"\n";
  EXPECT_EQ(errors(file + "every = \"1500us\"\n"), "804@5:9 ");
  EXPECT_EQ(errors(file + "every = \"100us\"\n"), "804@5:9 ");
  EXPECT_EQ(errors(file + "points = [\"W\"]\n"), "807@5:10 ");
  EXPECT_EQ(errors(file + "points = []\n"), "805@5:10 ");
  EXPECT_EQ(errors(file + "keep = \"1s\"\n"), "805@5:8 ");
  EXPECT_EQ(errors(file + "megabytes = 0\n"), "805@5:13 ");
}

TEST(RunConfig, TheNameOfAVectorIsEachOfItsElements) {
  ProgramShape shape = plant();
  for (const char* const name : {"V[0]", "V[1]", "VX[0]"}) {
    shape.inputs.push_back(shape.inputs.front());
    shape.inputs.back().name = name;
  }
  const std::string text =
      "[outputs.Y]\nsafe = 0.0\n[mqtt]\nbroker = \"b\"\non_change = true\npoints = [\"v\", \"Y\", "
      "\"V[1]\"]\n[dead_bands]\n";
  const MqttConfig mqtt = *parse_run_config("RUN.toml", text + "V = 0.5\n", shape).mqtt;
  EXPECT_EQ(mqtt.points, (std::vector<std::string>{"V[0]", "V[1]", "Y"}));
  EXPECT_EQ(mqtt.dead_bands, (std::vector<double>{0.5, 0.5, 0.0}));
  try {
    (void)parse_run_config("RUN.toml", text + "V = 0.5\n\"V[1]\" = 0.1\n", shape);
    ADD_FAILURE() << "taken";
  } catch (const InputError& problem) {
    ASSERT_EQ(problem.diagnostics().all().size(), 1U);
    EXPECT_EQ(problem.diagnostics().all()[0].number, error::run_key_twice);
    EXPECT_EQ(problem.diagnostics().all()[0].cause, "The dead band of V[1] has been given before.");
  }
}

TEST(RunConfig, AnMqttTableHasItsDefaultsFromTheDiagram) {
  const std::string safe = "[outputs.Y]\nsafe = 0.0\n";
  const auto read = [&](const std::string& keys) {
    return *parse_run_config("RUN.toml", safe + "[mqtt]\nbroker = \"b\"\n" + keys, plant()).mqtt;
  };
  const MqttConfig usual = read("");
  EXPECT_EQ(usual.broker, "b");
  EXPECT_EQ(usual.port, 1883);
  EXPECT_EQ(usual.points, (std::vector<std::string>{"X", "Z", "Y"}));
  EXPECT_EQ(usual.dead_bands, (std::vector<double>{0.0, 0.0, 0.0}));
  EXPECT_EQ(usual.step, 1000U);
  EXPECT_EQ(usual.refresh, 60'000U);
  EXPECT_EQ(usual.topic, "hysteron/PLANT");
  EXPECT_EQ(read("ca = \"ca.pem\"\n").port, 8883);
  EXPECT_EQ(read("ca = \"ca.pem\"\nport = 5\n").port, 5);
  EXPECT_EQ(read("on_change = true\nevery = \"2min\"\n").refresh, 120'000U) << "no more often than rows";
  const MqttConfig own = read(
      "payload = \"sparkplug-b\"\ngroup = \"g\"\nnode = \"n\"\npoints = [\"y\", \"task.fault\"]\non_change = true\n"
      "[dead_bands]\nY = 0.5\ntask.fault = 2\n");
  EXPECT_EQ(own.payload, MqttPayload::SparkplugB);
  EXPECT_EQ(own.group + own.node, "gn");
  EXPECT_EQ(own.points, (std::vector<std::string>{"Y", "task.fault"}));
  EXPECT_EQ(own.dead_bands, (std::vector<double>{0.5, 2.0}));
}

/// A key that does nothing, or cannot do what it says beside another, is an error where it stands.
TEST(RunConfig, AnMqttTableHasNoKeyThatDoesNothing) {
  const auto errors = [&](const std::string& keys) {
    return errors_of("[outputs.Y]\nsafe = 0.0\n[mqtt]\nbroker = \"b\"\n" + keys);
  };
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0.0\n[mqtt]\nport = 5\n"), "804@3:1 ");
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0.0\n[dead_bands]\nY = 1\n"), "804@3:1 ");
  for (const std::string broker : {"mqtt://b", "b:1883", "b/x"}) {
    EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0.0\n[mqtt]\nbroker = \"" + broker + "\"\n"), "804@4:10 ") << broker;
  }
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0.0\n[mqtt]\nbroker = \"fe80::1\"\n"), "");
  EXPECT_EQ(errors("certificate = \"a\"\n"), "804@5:15 ");
  EXPECT_EQ(errors("key = \"a\"\n"), "804@5:7 ");
  EXPECT_EQ(errors("ca = \"a\"\nkey = \"a\"\n"), "804@6:7 ");
  EXPECT_EQ(errors("ca = \"a\"\ncertificate = \"a\"\n"), "804@6:15 ");
  EXPECT_EQ(errors("password_file = \"a\"\n"), "804@5:17 ");
  EXPECT_EQ(errors("payload = \"sparkplug-b\"\ntopic = \"a\"\n"), "804@6:9 ");
  EXPECT_EQ(errors("payload = \"sparkplug-b\"\nqos = 1\n"), "804@6:7 ");
  EXPECT_EQ(errors("group = \"a\"\n"), "804@5:9 ");
  EXPECT_EQ(errors("node = \"a\"\n"), "804@5:8 ");
  EXPECT_EQ(errors("refresh = \"5s\"\n"), "804@5:11 ");
  EXPECT_EQ(errors("on_change = true\nrefresh = \"5ms\"\n"), "805@6:11 ");
  EXPECT_EQ(errors("[dead_bands]\nY = 1.0\n"), "804@5:1 ");
  const std::string change = "on_change = true\n[dead_bands]\n";
  EXPECT_EQ(errors(change + "Y = -1.0\n"), "804@7:5 ");
  EXPECT_EQ(errors(change + "Y = nan\n"), "804@7:5 ");
  EXPECT_EQ(errors(change + "W = 1.0\n"), "807@7:5 ");
  EXPECT_EQ(errors(change + "task.fault = 1.0\n"), "807@7:14 ") << "it is not published";
  EXPECT_EQ(errors(change + "y = 1.0\nY = 2.0\n"), "802@7:5 ") << "the library gives keys in the order of their names";
  EXPECT_EQ(errors("qos = 2\n"), "805@5:7 ");
  EXPECT_EQ(errors("every = \"1500us\"\n"), "804@5:9 ");
  EXPECT_EQ(errors("payload = \"xml\"\n"), "804@5:11 ");
  for (const char* const topic : {"a/#", "a/+/b", "$SYS", "/a", "a/", "a\\u0000b"}) {
    EXPECT_EQ(errors(fmt::format("topic = \"{}\"\n", topic)), "804@5:9 ") << topic;
  }
  for (const char* const name : {"a/b", "+", "#"}) {
    EXPECT_EQ(errors(fmt::format("payload = \"sparkplug-b\"\nnode = \"{}\"\n", name)), "804@6:8 ") << name;
  }
}

}  // namespace
}  // namespace hysteron::runtime
