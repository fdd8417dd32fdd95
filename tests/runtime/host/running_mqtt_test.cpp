// A task that publishes: its rows arrive, what cannot be used is refused before anything is reached, and a broker that
// is gone or hangs stops no control and holds up no end.
#include "runtime/host/running_mqtt.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>

#include "runtime/host/host.hpp"
#include "support/diagnostic.hpp"
#include "tests/runtime/host/host_process.hpp"
#include "tests/runtime/modbus/test_certificates.hpp"
#include "tests/runtime/mqtt/broker.hpp"
#include "tests/runtime/mqtt/mqtt_bench.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using test::Broker;
using test::soon;
using test::Subscriber;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* mqtt_run_file =
    "[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n[mqtt]\nbroker = \"127.0.0.1\"\n";

class RunningMqtts : public testing::Test {
 protected:
  /// A run of some cycles, as it is said to end; an error where it is refused.
  std::string run(const std::string& keys, std::uint64_t cycles, bool virtual_time = false) {
    test::Accumulator program;
    std::string out;
    testing::internal::CaptureStderr();
    try {
      auto config = parse_run_config("RUN.toml", mqtt_run_file + keys, program.shape());
      config.scheduling.scheduling = Scheduling::other;
      config.scheduling.lock_memory = false;
      well = run_host(program, config, {.how = "linked", .cycles = cycles, .virtual_time = virtual_time},
                      [&](std::string_view text) { out += text; });
    } catch (const InputError& refused) {
      const Diagnostic& first = refused.diagnostics().all().front();
      out = fmt::format("HY{}:{}: {} {}", first.number, first.place.line, first.cause, first.mend);
    }
    err = testing::internal::GetCapturedStderr();
    return out;
  }
  void private_file(const std::string& name, const std::string& text) const {
    std::filesystem::permissions(folder.write(name, text), std::filesystem::perms(0600));
  }

  hysteron::test::ScratchFolder folder{};
  bool well = false;
  std::string err{};
};

class PublishingRuns : public RunningMqtts {
 protected:
  void SetUp() override { test::skip_without_broker(); }
};

TEST_F(PublishingRuns, HaveEachCycle) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  const Subscriber subscriber(broker);
  const auto out =
      run(fmt::format("port = {}\nevery = \"1ms\"\npoints = [\"y\", \"G.A\", \"task.cycles\"]\n", broker.port()), 300);
  EXPECT_TRUE(well) << err;
  EXPECT_THAT(out, HasSubstr(fmt::format("; MQTT to 127.0.0.1:{}; ", broker.port())));
  EXPECT_EQ(err, "");
  ASSERT_TRUE(soon([&] {
    return !subscriber.on("hysteron/ACCUMULATOR/state").empty() &&
           subscriber.on("hysteron/ACCUMULATOR/state").back().find("false") != std::string::npos;
  }));
  const auto rows = subscriber.on("hysteron/ACCUMULATOR/data");
  ASSERT_GT(rows.size(), 200U) << "but for skipped cycles, each is a row";
  double last = 0.0;
  for (const std::string& row : rows) {
    const auto read = nlohmann::json::parse(row);
    const auto& values = read.at("values");
    EXPECT_EQ(values.at("Y").at("unit"), "um");
    EXPECT_EQ(values.at("G.A").at("value"), 1.0);
    EXPECT_EQ(values.at("task.cycles").at("value"), read.at("cycle"));
    const double y = values.at("Y").at("value").get<double>();
    if (values.at("Y").at("quality") == "good") {  // in the end, outputs go to their safe values
      EXPECT_EQ(y, values.at("task.cycles").at("value").get<double>()) << "of one cycle";
      EXPECT_GT(y, last);
      last = y;
    }
  }
}

TEST_F(RunningMqtts, ABrokerThatIsAbsentStopsNoControl) {
  const auto out = run(fmt::format("port = {}\nevery = \"10ms\"\n", test::free_port()), 500);
  EXPECT_TRUE(well) << "the network is not the task's";
  EXPECT_THAT(out, testing::AllOf(HasSubstr("; rows for MQTT are lost: "), HasSubstr("Connection refused"),
                                  HasSubstr("; fault: none")));
  EXPECT_THAT(err, StartsWith("MQTT: nothing reaches 127.0.0.1:"));
}

TEST_F(RunningMqtts, OnAVirtualClockNothingIsPublished) {
  const auto out = run(fmt::format("port = {}\nevery = \"1ms\"\n", test::free_port()), 5000, true);
  EXPECT_TRUE(well);
  EXPECT_THAT(out, HasSubstr("; nothing is published to MQTT; virtual clock"));
  EXPECT_EQ(err, "");
  EXPECT_THAT(run("ca = \"/none.pem\"\n", 10, true), StartsWith("HY831:")) << "a trial finds what a run would";
}

TEST_F(RunningMqtts, FilesThatCannotBeUsedAreRefused) {
  const auto refusal = [&](const std::string& keys) { return run("port = 1\n" + keys, 10); };
  const std::string user = "user = \"stage\"\npassword_file = \"" + (folder / "password") + "\"\n";
  EXPECT_THAT(refusal(user), StartsWith("HY100:"));
  folder.write("password", "secret\n");
  EXPECT_THAT(refusal(user), StartsWith("HY833:9: Others than its owner may read or change the password file "));
  private_file("password", "secret\nmore\n");
  EXPECT_THAT(refusal(user), StartsWith("HY804:9: The password file "));
  private_file("password", "\n");
  EXPECT_THAT(refusal(user), StartsWith("HY804:9: "));
  private_file("password", "secret\n");
  EXPECT_THAT(refusal(user), HasSubstr("fault: none"));
  EXPECT_EQ(err.find("secret"), std::string::npos);

  const test::Certificate authority({.name = "authority"}, nullptr);
  const test::Certificate own({.name = "stage"}, &authority);
  const test::Certificate old({.name = "stage", .begins = -7200, .ends = -3600}, &authority);
  const std::string ca = "ca = \"" + (folder / "ca.pem") + "\"\n";
  const std::string pair = "certificate = \"" + (folder / "a.pem") + "\"\nkey = \"" + (folder / "a.key") + "\"\n";
  EXPECT_THAT(refusal(ca), StartsWith("HY831:8: "));
  folder.write("ca.pem", "no certificate");
  EXPECT_THAT(refusal(ca), StartsWith("HY831:8: "));
  folder.write("ca.pem", authority.certificate_pem());
  EXPECT_THAT(refusal(ca), HasSubstr("fault: none"));
  folder.write("a.pem", own.certificate_pem());
  EXPECT_THAT(refusal(ca + pair), StartsWith("HY831:10: "));
  folder.write("a.key", own.key_pem());
  EXPECT_THAT(refusal(ca + pair), StartsWith("HY833:10: "));
  private_file("a.key", authority.key_pem());
  EXPECT_THAT(refusal(ca + pair), StartsWith("HY832:10: "));
  private_file("a.key", own.key_pem("word"));
  EXPECT_THAT(refusal(ca + pair), StartsWith("HY831:10: "));
  private_file("a.key", own.key_pem());
  EXPECT_THAT(refusal(ca + pair), HasSubstr("fault: none"));
  folder.write("a.pem", old.certificate_pem());
  private_file("a.key", old.key_pem());
  EXPECT_THAT(refusal(ca + pair), StartsWith("HY834:9: "));
}

TEST_F(RunningMqtts, APasswordInTheClearIsSaid) {
  private_file("password", "secret\n");
  const std::string user = "user = \"stage\"\npassword_file = \"" + (folder / "password") + "\"\n";
  (void)run("port = 1\n" + user, 10);
  EXPECT_EQ(err.find("in the clear"), std::string::npos) << "it does not leave the machine";
}

TEST_F(RunningMqtts, NeverWriteOverWhatTheyRead) {
  test::Accumulator program;
  for (const char* const key : {"ca", "password_file"}) {
    const auto config = parse_run_config(
        "RUN.toml", fmt::format("{}user = \"u\"\n{} = \"same\"\n[trace]\nfile = \"same\"\n", mqtt_run_file, key),
        program.shape());
    EXPECT_THROW(refuse_to_overwrite_inputs(config, {}), InputError) << key;
  }
}

/// An input whose quality the device tells is published with that quality.
TEST_F(RunningMqtts, TheQualityOfADeviceIsThatOfItsValue) {
  ProgramShape shape{
      .name = "P", .period = 1'000'000, .inputs = {{.name = "X"}, {.name = "Q"}}, .outputs = {{.name = "Y"}}};
  test::Accumulator program;
  program.mutable_shape() = shape;
  const auto config = parse_run_config("RUN.toml",
                                       "[devices.d]\n[inputs.X]\ndevice = \"d\"\n[inputs.Q]\nquality_of = "
                                       "\"X\"\n[outputs.Y]\nsafe = 0.0\n[mqtt]\nbroker = \"b\"\n"
                                       "points = [\"X\"]\n",
                                       program.shape());
  Task task(program, config.task);
  RunningMqtt mqtt(config, shape, task);
  const auto points = task.door().points();
  std::vector<std::string> columns;
  for (const std::size_t column : mqtt.tap().points()) {
    columns.push_back(points[column].name);
  }
  EXPECT_EQ(columns, (std::vector<std::string>{"X", "Q", "task.fault"}));
}

/// SIGTERM while the broker hangs: outputs are safe, and the process is gone in time.
TEST_F(PublishingRuns, EndInTimeWhereTheBrokerHangs) {
  Broker broker;
  ASSERT_TRUE(broker.start());
  test::Stage stage;
  stage.start();
  stage.give(2.0);
  test::HostProcess host(test::run_file(
      stage.port,
      fmt::format("{}[mqtt]\nbroker = \"127.0.0.1\"\nport = {}\nevery = \"1ms\"\n", test::x_on_stage, broker.port())));
  ASSERT_TRUE(soon([&] { return stage.taken() == 4.0; }));
  const auto client = host.client({"task.mqtt_rows", "task.mqtt_connected"});
  ASSERT_TRUE(soon([&] { return client->read(0).value > 50.0 && client->read(1).value == 1.0; }));
  broker.halt();
  stage.give(3.0);
  ASSERT_TRUE(soon([&] { return stage.taken() == 6.0; })) << "control goes on";
  const auto begin = std::chrono::steady_clock::now();
  const auto [code, said] = host.end();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(6));
  EXPECT_EQ(code, 0);
  EXPECT_EQ(stage.taken(), -1.0);
  EXPECT_THAT(said, HasSubstr("rows for MQTT are lost: "));
}

}  // namespace
}  // namespace hysteron::runtime
