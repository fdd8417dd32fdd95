// A host in a process of its own, with a device and a client, through the losses of both; and what its guard does where
// its program hangs.
#include "runtime/host/host.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/config/output_claims.hpp"
#include "runtime/config/run_config.hpp"
#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/device.hpp"
#include "runtime/modbus/listen.hpp"
#include "support/descriptor.hpp"
#include "tests/runtime/host/host_process.hpp"
#include "tests/runtime/modbus/tls_files.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;
using test::HostProcess;
using test::run_file;
using test::Stage;
using test::x_on_stage;

TEST(Host, ADeviceThatDiesAndAClientThatIsLostMakeTheOutputsSafeUntilTheyAreBack) {
  Stage stage;
  stage.give(0.25);
  HostProcess host(run_file(stage.port, std::string("heartbeat = \"any\"\nheartbeat_time = \"2s\"\n") + x_on_stage));
  stage.start();
  auto client = host.client({"Y", "task.fault"});
  const auto shows = [&](double y, Fault fault) {
    return test::soon(
               [&] { return client->read(0).value == y && client->read(1).value == static_cast<double>(fault); }) &&
           test::soon([&] { return stage.server == nullptr || stage.taken() == y; });
  };
  for (int round = 0; round < 2; ++round) {
    EXPECT_TRUE(shows(0.5, Fault::none));
    stage.server.reset();
    EXPECT_TRUE(shows(-1.0, Fault::lost_link));
    stage.start();
    EXPECT_TRUE(shows(0.5, Fault::none));
    client.reset();
    EXPECT_TRUE(test::soon([&] { return stage.taken() == -1.0; }));
    client = host.client({"Y", "task.fault"});
  }
  EXPECT_TRUE(shows(0.5, Fault::none));
  const auto [code, said] = host.end();
  EXPECT_EQ(code, 0) << said;
  EXPECT_TRUE(said.starts_with("TWICE: stopped; ")) << said;
  EXPECT_EQ(stage.taken(), -1.0) << "the last values arrive before it ends";
}

TEST(Host, NamesTheDeviceThatIsLostAndCountsFaults) {
  Stage stage;
  stage.give(0.25);
  HostProcess host(run_file(stage.port, x_on_stage));
  stage.start();
  auto client = host.client({"Y", "task.state", "task.fault", "task.faults", "task.last_fault"});
  const auto shows = [&](std::size_t point, double value) {
    return test::soon([&] { return client->read(point).value == value; });
  };
  EXPECT_TRUE(shows(0, 0.5));
  EXPECT_TRUE(shows(1, 1.0));
  const double before = client->read(3).value;
  stage.server.reset();
  EXPECT_TRUE(shows(2, static_cast<double>(Fault::lost_link)));
  EXPECT_TRUE(shows(1, 2.0)) << "task.state is faulted";
  EXPECT_TRUE(test::soon([&] { return client->read(3).value > before; }));
  const auto told = [&](const std::string& text) {
    return test::soon([&] { return host.told().find(text) != std::string::npos; });
  };
  EXPECT_TRUE(
      told(fmt::format("Fault: lost link, X on stage (127.0.0.1:{}): the device has not answered ", stage.port)) ||
      told(fmt::format("Fault: lost link, Y on stage (127.0.0.1:{}): the device has not answered ", stage.port)))
      << host.told();
  stage.start();
  EXPECT_TRUE(shows(1, 1.0));
  EXPECT_TRUE(shows(4, static_cast<double>(Fault::lost_link))) << "the newest stays to be seen";
  EXPECT_TRUE(told("Fault: none any more; ")) << host.told();
  const auto [code, said] = host.end();
  EXPECT_EQ(code, 0);
  EXPECT_NE(said.find(" on stage (127.0.0.1:"), std::string::npos) << said;
  EXPECT_TRUE(said.ends_with("; fault: none")) << said;
}

TEST(Host, ACertificateThatEndedStopsNoControl) {
  const test::TlsFiles files;
  const auto write = [&files](const test::Certificate& server) {
    files.folder.write("server.pem", server.certificate_pem());
    files.private_file("server.key", server.key_pem());
  };
  write(test::Certificate({.name = "server", .begins = -7200, .ends = -3600, .for_clients = false}, &files.authority));
  Stage stage;
  stage.give(0.25);
  HostProcess host(
      run_file(stage.port, fmt::format("[tls]\ncertificate = \"{0}server.pem\"\nkey = \"{0}server.key\"\nclients = "
                                       "\"{0}clients.pem\"\nwithout_role = [\"read\"]\n{1}",
                                       files.folder / "", x_on_stage)));
  stage.start();
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; })) << host.told() << host.said_before();
  const auto told = [&](const std::string& text) {
    return test::soon([&] { return host.told().find(text) != std::string::npos; });
  };
  EXPECT_TRUE(told("TLS: the server's certificate ended on ")) << host.told();
  write(test::Certificate({.name = "server", .for_clients = false}, &files.authority));
  EXPECT_TRUE(told("TLS: new certificate, until ")) << host.told();
  const auto [code, said] = host.end();
  EXPECT_EQ(code, 0) << said << host.told();
}

TEST(Host, ADeviceThatNeverAnswersDelaysNoCycle) {
  Stage stage;
  const auto silent = modbus::listen_on("127.0.0.1", 0, {});  // connections are made, and nobody takes them
  HostProcess host(run_file(stage.port, fmt::format("[inputs.X]\ndevice = \"silent\"\n[devices.silent]\nport = {}\n"
                                                    "timeout = \"60s\"\n",
                                                    modbus::port_of(silent))));
  stage.start();
  const auto client = host.client({"task.cycles", "task.fault"});
  // A cycle that waited for the device would take a minute, and this test gives up before.
  EXPECT_TRUE(test::soon([&] { return client->read(0).value > 100.0; }));
  EXPECT_TRUE(test::soon([&] { return client->read(1).value == static_cast<double>(Fault::lost_link); }));
  EXPECT_TRUE(test::soon([&] { return stage.taken() == -1.0; })) << "the other device is served meanwhile";
  const auto [code, said] = host.end();
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(said.ends_with("fault: lost link")) << said;
}

TEST(Host, ADeviceThatIsLeftOutIsSaidHoweverShortTheRun) {
  Stage stage;
  const auto silent = modbus::listen_on("127.0.0.1", 0, {});
  HostProcess host(run_file(stage.port, fmt::format("[inputs.X]\ndevice = \"silent\"\n[devices.silent]\nport = {}\n"
                                                    "on_absence = \"go_on\"\n",
                                                    modbus::port_of(silent))));
  stage.start();
  EXPECT_TRUE(test::soon([&] { return host.told().find("Device: silent has not answered") != std::string::npos; }));
  const auto [code, said] = host.end();
  EXPECT_EQ(code, 0) << said;
  EXPECT_NE(said.find("; never answered since the start: silent"), std::string::npos) << said;
}

TEST(Host, ADeviceThatDoesNotTakeTheSafeValuesIsSaidAtTheEndAndLeftToTheGuard) {
  Stage stage;
  stage.give(0.25);
  const std::string text = run_file(stage.port, x_on_stage);
  HostProcess host(text);
  stage.start();
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; }));
  const pid_t guard = host.guard();
  stage.server.reset();
  const auto [code, said] = host.end();
  EXPECT_EQ(code, 1);
  EXPECT_NE(said.find(fmt::format("; its guard, process {}, goes on until the devices have their safe values", guard)),
            std::string::npos)
      << said;
  EXPECT_TRUE(said.ends_with("fault: lost link")) << said;
  EXPECT_EQ(stage.taken(), 0.5);
  EXPECT_EQ(::kill(guard, 0), 0) << "it waits for the device";
  stage.start();
  EXPECT_TRUE(test::soon([&] { return stage.taken() == -1.0; }));
  const test::Twice program;
  OutputClaims claims(parse_run_config("RUN.toml", text, program.shape()));
  EXPECT_TRUE(test::soon([&] { return !claims.claim(); })) << "and ends when the device has them";
}

TEST(Host, ADeathOfTheGuardIsSaidAndEndsTheTaskWithSafeOutputs) {
  Stage stage;
  stage.give(0.25);
  stage.start();
  HostProcess host(run_file(stage.port, x_on_stage));
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; }));
  const pid_t guard = host.guard();
  ASSERT_GT(guard, 0);
  ASSERT_EQ(::kill(guard, SIGKILL), 0);
  const auto [code, said] = host.ended();
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(said.starts_with("TWICE: stopped by a fault; ")) << said;
  EXPECT_TRUE(said.ends_with("fault: lost guard")) << said;
  EXPECT_EQ(said.find("its guard, process"), std::string::npos) << said;
  EXPECT_EQ(stage.taken(), -1.0);
  EXPECT_NE(host.told().find(fmt::format("Guard: process {} is gone: it was ended by signal 9", guard)),
            std::string::npos)
      << host.told();
}

TEST(Host, WhereTheStepHangsTheGuardHoldsTheDeviceAndTheTaskWritesNoMore) {
  Stage stage;
  stage.give(0.25);
  HostProcess host(run_file(stage.port, x_on_stage));
  stage.start();
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; }));
  stage.give(13.0);
  EXPECT_TRUE(test::soon([&] { return stage.taken() == -1.0; }));
  // The hung process still lives, and so does its thread for the device.
  const auto writes = stage.door.writes();
  EXPECT_TRUE(test::soon([&] {
    EXPECT_EQ(stage.taken(), -1.0);
    return stage.door.writes() > writes + 50;
  }));
  EXPECT_TRUE(test::soon([&] { return host.told().find("Fault: hang: ") != std::string::npos; })) << host.told();
}

TEST(Host, ServesOpenPlcsAddresses) {
  Stage stage;
  HostProcess host(run_file(stage.port, "map = \"openplc\"\n[addresses]\nY = \"%ML7\"\ntask.reset = \"%MW3\"\n"));
  stage.start();
  // X is an LREAL, so %ML0; the first words that clients read and write are task.state and task.commit.
  const auto at = [](std::string_view address) { return modbus::parse_address(address)->at; };
  modbus::Device screen({.link = modbus::TcpLink{.port = host.port()},
                         .values = {{.at = at("%ML0"), .format = {.type = PointType::real64}, .written = true},
                                    {.at = at("%ML7"), .format = {.type = PointType::real64}},
                                    {.at = at("%IW0"), .format = {.type = PointType::uint16}},
                                    {.at = at("%QW0"), .format = {.type = PointType::uint16}},
                                    {.at = at("%MW3"), .format = {.type = PointType::uint16}}},
                         .response = milliseconds(2000)});
  screen.write(0, 0.75);
  EXPECT_TRUE(test::soon([&] { return screen.read(1).value == 1.5 && stage.taken() == 1.5; }));
  EXPECT_TRUE(test::soon([&] { return screen.read(2).value == 1.0; })) << "task.state is running";
  for (const std::size_t command : {3U, 4U}) {
    EXPECT_TRUE(test::soon([&] { return screen.read(command).quality == modbus::Quality::good; })) << command;
  }
  EXPECT_EQ(host.end().first, 0);
}

TEST(Host, TellsTheServiceManagerThatItIsReadyLivesAndStops) {
  const hysteron::test::ScratchFolder folder;
  const std::string name = folder / "notify";
  const Descriptor manager(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, name.c_str(), sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(manager.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
  ::setenv("WATCHDOG_USEC", "20000", 1);
  HostProcess host(
      "[task]\nscheduling = \"other\"\nlock_memory = false\n[outputs.Y]\nsafe = 0.0\n[modbus]\nport = 0\n");
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
  const auto next = [&] {
    pollfd one{manager.number(), POLLIN, 0};
    std::array<char, 100> text{};
    const auto size = ::poll(&one, 1, 30'000) > 0 ? ::recv(manager.number(), text.data(), text.size(), 0) : 0;
    return std::string(text.data(), static_cast<std::size_t>(size));
  };
  EXPECT_EQ(next(), "READY=1");
  EXPECT_EQ(next(), "WATCHDOG=1");
  EXPECT_EQ(next(), "WATCHDOG=1");
  EXPECT_EQ(host.end().first, 0);
  std::string last = "WATCHDOG=1";
  while (last == "WATCHDOG=1") {
    last = next();
  }
  EXPECT_EQ(last, "STOPPING=1");
}

}  // namespace
}  // namespace hysteron::runtime
