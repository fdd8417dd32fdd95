// A host in a process of its own, with a device and a client, through the losses of both; and what its guard does where
// its program hangs.
#include "runtime/host/host.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/descriptor.hpp"
#include "runtime/modbus/device.hpp"
#include "runtime/modbus/listen.hpp"
#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/free_port.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;

/// Y := 2 · X; where X is 13, the step never ends.
class Twice final : public StepProgram {
 public:
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override {}
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override {
    for (volatile bool hangs = inputs[0] == 13.0; hangs;) {
    }
    outputs[0] = 2.0 * inputs[0];
  }
  void set_parameter(std::size_t /*parameter*/, double /*value*/) noexcept override {}
  [[nodiscard]] double parameter(std::size_t /*parameter*/) const noexcept override { return 0.0; }
  [[nodiscard]] std::size_t state_size() const noexcept override { return 0; }
  void save(std::span<std::byte> /*bytes*/) const noexcept override {}
  void restore(std::span<const std::byte> /*bytes*/) noexcept override {}

 private:
  ProgramShape shape_{
      .name = "TWICE", .period = 1'000'000, .inputs = {{.name = "X"}}, .outputs = {{.name = "Y"}}, .layout = "twice"};
};

/// Our own server as the device: it gives X and takes Y.
struct Stage {
  test::MemoryDoor door{{{.name = "X"}, {.name = "Y", .kind = PointKind::parameter, .writable = true}}};
  std::uint16_t port = test::free_port();
  std::unique_ptr<modbus::Server> server;

  void start() {
    server = std::make_unique<modbus::Server>(modbus::make_register_map(door.points(), {}), door,
                                              modbus::ServerOptions{.port = port});
  }
  void give(double x) { door.set(0, x); }
  [[nodiscard]] double taken() { return door.value(1); }
};

/// run_host in a process of its own, begun while the test has one thread.
class HostProcess {
 public:
  explicit HostProcess(const std::string& run_file) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
      std::abort();
    }
    said_ = modbus::Descriptor(ends[0]);
    process_ = ::fork();
    if (process_ == 0) {
      Twice program;
      const bool well = run_host(program, parse_run_config("RUN.toml", run_file, program.shape()), {.how = "linked"},
                                 [&](std::string_view text) {
                                   [[maybe_unused]] const ssize_t written = ::write(ends[1], text.data(), text.size());
                                 });
      ::_exit(well ? 0 : 1);
    }
    ::close(ends[1]);
    const std::string started = line();
    const auto at = started.find("Modbus on 127.0.0.1:");
    EXPECT_NE(at, std::string::npos) << started;
    port_ = at == std::string::npos ? std::uint16_t{1} : static_cast<std::uint16_t>(std::stoi(started.substr(at + 20)));
  }
  HostProcess(const HostProcess&) = delete;
  HostProcess& operator=(const HostProcess&) = delete;
  HostProcess(HostProcess&&) = delete;
  HostProcess& operator=(HostProcess&&) = delete;
  ~HostProcess() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
  }

  /// A client that reads points by their names.
  [[nodiscard]] std::unique_ptr<modbus::Device> client(const std::vector<std::string>& names) const {
    const Twice program;
    RunConfig config;
    config.task.inputs = {{.from_device = true}};
    config.task.outputs.resize(1);
    const auto map = register_map_of(config, program);
    modbus::DeviceOptions options{.link = modbus::TcpLink{.port = port_}, .response = milliseconds(2000)};
    for (const std::string& name : names) {
      for (const auto& entry : map.entries()) {
        if (map.point_of(entry).name == name) {
          options.values.push_back({.at = entry.at, .type = map.point_of(entry).type});
        }
      }
    }
    return std::make_unique<modbus::Device>(options);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  void send(int signal) const { ::kill(process_, signal); }
  /// Ends it by SIGTERM; its exit code, and what it said at its end.
  std::pair<int, std::string> end() {
    send(SIGTERM);
    const std::string last = line();
    int status = 0;
    ::waitpid(std::exchange(process_, 0), &status, 0);
    return {test::exit_code(status), last};
  }

 private:
  std::string line() {
    std::string text;
    for (char letter = 0; ::read(said_.number(), &letter, 1) == 1 && letter != '\n';) {
      text += letter;
    }
    return text;
  }

  modbus::Descriptor said_;
  pid_t process_ = 0;
  std::uint16_t port_ = 0;
};

/// The guard is patient: a machine that is busy with something else is no hang.
std::string run_file(std::uint16_t stage, const std::string& rest) {
  return fmt::format(
      "[task]\nscheduling = \"other\"\nlock_memory = false\n[watchdog]\nsilence = \"5s\"\n[devices.stage]\nport = {}\n"
      "cycle = \"2ms\"\ntimeout = \"1s\"\n[outputs.Y]\nsafe = -1.0\ndevice = \"stage\"\n[modbus]\nport = 0\n{}",
      stage, rest);
}

constexpr const char* x_on_stage = "[inputs.X]\ndevice = \"stage\"\narea = \"input\"\nlongest_age = \"1s\"\n";

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
  EXPECT_EQ(client->read(1).value, static_cast<double>(Fault::lost_link));
  EXPECT_TRUE(test::soon([&] { return stage.taken() == -1.0; })) << "the other device is served meanwhile";
  EXPECT_EQ(host.end().first, 0);
}

TEST(Host, ADeviceThatDoesNotTakeTheSafeValuesIsSaidAtTheEnd) {
  Stage stage;
  HostProcess host(run_file(stage.port, ""));
  const auto client = host.client({"task.cycles"});
  EXPECT_TRUE(test::soon([&] { return client->read(0).value > 0.0; }));
  const auto [code, said] = host.end();
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(said.ends_with("fault: lost link")) << said;
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
}

TEST(Host, ServesOpenPlcsAddresses) {
  Stage stage;
  HostProcess host(run_file(stage.port, "map = \"openplc\"\n[addresses]\nY = \"%ML7\"\ntask.reset = \"%MW3\"\n"));
  stage.start();
  // X is an LREAL, so %ML0; the first words that clients read and write are task.state and task.commit.
  const auto at = [](std::string_view address) { return modbus::parse_address(address)->at; };
  modbus::Device screen({.link = modbus::TcpLink{.port = host.port()},
                         .values = {{.at = at("%ML0"), .type = PointType::real64, .written = true},
                                    {.at = at("%ML7"), .type = PointType::real64},
                                    {.at = at("%IW0"), .type = PointType::uint16},
                                    {.at = at("%QW0"), .type = PointType::uint16},
                                    {.at = at("%MW3"), .type = PointType::uint16}},
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
  const modbus::Descriptor manager(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
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
