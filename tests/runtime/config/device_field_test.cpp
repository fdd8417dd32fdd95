// The task's inputs and outputs on devices: values, their age and quality, and who may write.
#include "runtime/config/device_field.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/free_port.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using modbus::Quality;
using std::chrono::milliseconds;

/// Our own server as the device: it gives X in input registers and takes Y in holding registers.
class ServedDevice {
 public:
  explicit ServedDevice(std::uint16_t port) : port_(port) {}
  void start() {
    server_ = std::make_unique<modbus::Server>(modbus::make_register_map(door_.points(), {}), door_,
                                               modbus::ServerOptions{.port = port_});
  }
  void stop() { server_.reset(); }
  void give(double x) { door_.set(0, x); }
  [[nodiscard]] double taken() { return door_.value(1); }
  [[nodiscard]] std::uint64_t writes() { return door_.writes(); }
  void refuse(const std::string& why) { door_.refuse(why); }

 private:
  std::uint16_t port_;
  test::MemoryDoor door_{{{.name = "X"}, {.name = "Y", .kind = PointKind::parameter, .writable = true}}};
  std::unique_ptr<modbus::Server> server_;
};

ProgramShape shape() {
  return {.name = "PLANT",
          .period = 1'000'000,
          .inputs = {{.name = "X", .preset = 7.0}, {.name = "X_AGE"}, {.name = "X_QUALITY"}, {.name = "Y_QUALITY"}},
          .outputs = {{.name = "Y"}}};
}

RunConfig config_of(std::uint16_t port, const std::string& on_loss = "fault", const std::string& output_age = "60s") {
  return parse_run_config("RUN.toml",
                          "[devices.stage]\nport = " + std::to_string(port) +
                              "\ncycle = \"2ms\"\n[outputs.Y]\nsafe = 0.0\ndevice = \"stage\"\nlongest_age = \"" +
                              output_age + "\"\non_loss = \"" + on_loss +
                              "\"\n[inputs.X]\ndevice = \"stage\"\narea = \"input\"\nlongest_age = \"250ms\"\n"
                              "on_loss = \"" +
                              on_loss +
                              "\"\n[inputs.X_AGE]\nage_of = \"X\"\n[inputs.X_QUALITY]\nquality_of = \"x\"\n"
                              "[inputs.Y_QUALITY]\nquality_of = \"Y\"\n",
                          shape());
}

using Inputs = std::array<double, 4>;
constexpr double good = static_cast<double>(Quality::good);
constexpr double lost = static_cast<double>(Quality::lost);

/// A healthy device has not answered in the first cycle: that is no fault until its first exchange has had its time.
TEST(DeviceField, TheFirstExchangeHasItsTimeAndThenADeviceIsMissed) {
  const std::uint16_t port = test::free_port();
  for (const bool may_be_absent : {false, true}) {
    RunConfig config = config_of(port);
    config.devices[0].may_be_absent = may_be_absent;
    config.devices[0].response = milliseconds(150);
    config.devices.push_back({.name = "unused"});
    DeviceField field(config, false);
    Inputs inputs{};
    const auto begin = std::chrono::steady_clock::now();
    const Fault first = field.read(inputs);
    const bool was_awaited = field.is_awaited();
    const std::size_t absent = field.absent();
    if (std::chrono::steady_clock::now() - begin < milliseconds(250)) {  // else this thread was not run meanwhile
      EXPECT_EQ(first, may_be_absent ? Fault::none : Fault::lost_link);
      EXPECT_EQ(was_awaited, !may_be_absent);
      EXPECT_EQ(absent, 0U);
    }
    EXPECT_TRUE(test::soon([&] { return field.absent() == 1; })) << "the device that is not asked does not count";
    EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(250));
    EXPECT_EQ(field.read(inputs), first);
    EXPECT_FALSE(field.is_awaited());
  }
}

TEST(DeviceField, ALossIsAFaultUntilTheDeviceIsBack) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.give(0.25);
  DeviceField field(config_of(port), false);
  Inputs inputs{7.0};
  const auto reads = [&](Fault fault) {
    return test::soon([&] {
      field.write(std::array{0.5});
      return field.read(inputs) == fault;
    });
  };
  EXPECT_TRUE(reads(Fault::lost_link));
  EXPECT_EQ(inputs[0], 7.0) << "nothing was read: the default stays";
  for (int round = 0; round < 3; ++round) {
    stage.start();
    EXPECT_TRUE(reads(Fault::none));
    EXPECT_EQ(inputs[0], 0.25);
    EXPECT_TRUE(test::soon([&] {
      (void)field.read(inputs);
      return inputs[2] == good && inputs[3] == good && stage.taken() == 0.5;
    }));
    stage.stop();
    EXPECT_TRUE(reads(Fault::lost_link));
    EXPECT_EQ(inputs[0], 0.25) << "the last value stays";
    EXPECT_EQ(inputs[2], lost);
    EXPECT_GT(inputs[1], 0.25) << "a loss is a fault only after the longest age";
  }
}

TEST(DeviceField, AValueThatIsReadAgainAndAgainNeverBecomesStale) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.start();
  DeviceField field(config_of(port), false);
  Inputs inputs{};
  const auto is_well = [&] {
    field.write(std::array{0.5});
    return field.read(inputs) == Fault::none;
  };
  ASSERT_TRUE(test::soon(is_well));
  std::this_thread::sleep_for(milliseconds(300));  // beyond the longest age
  EXPECT_TRUE(test::soon(is_well));
  EXPECT_EQ(config_of(port).task.inputs[0].longest_age, 0U) << "cycles since a server's write do not count here";
}

TEST(DeviceField, WhereTheDiagramLooksAfterItALossIsNoFault) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.start();
  DeviceField field(config_of(port, "keep"), false);
  Inputs inputs{};
  EXPECT_EQ(field.read(inputs), Fault::none);
  EXPECT_TRUE(test::soon([&] { return field.read(inputs) == Fault::none && inputs[2] == good; }));
  stage.stop();
  EXPECT_TRUE(test::soon([&] { return field.read(inputs) == Fault::none && inputs[2] == lost && inputs[1] > 0.3; }));
}

/// It never answered: the task goes on without it where it may, and from its first answer on a loss is a loss.
TEST(DeviceField, ADeviceThatMayBeAbsentIsNoFaultUntilItHasAnswered) {
  const std::uint16_t port = test::free_port();
  RunConfig config = config_of(port);
  config.devices[0].may_be_absent = true;
  ServedDevice stage(port);
  DeviceField field(config, false);
  Inputs inputs{7.0};
  std::vector<double> counts(device_points(config).size());
  const auto link = [&] {
    field.count(counts);
    return counts[0];
  };
  // Beyond the longest age of X, and after some attempts.
  const auto until = std::chrono::steady_clock::now() + milliseconds(400);
  while (std::chrono::steady_clock::now() < until) {
    field.write(std::array{0.5});
    ASSERT_EQ(field.read(inputs), Fault::none);
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(inputs[0], 7.0) << "nothing was read: the default stays";
  EXPECT_TRUE(test::soon([&] { return field.absent() == 1; }));
  EXPECT_EQ(field.absent_devices(), std::vector<std::string>{"stage"});
  EXPECT_EQ(link(), 3.0);
  EXPECT_EQ(field.delivery(), Delivery::done) << "an end does not wait for it";
  stage.give(0.25);
  stage.start();
  EXPECT_TRUE(test::soon([&] {
    field.write(std::array{0.5});
    return field.read(inputs) == Fault::none && field.absent() == 0 && inputs[0] == 0.25 && stage.taken() == 0.5;
  }));
  EXPECT_EQ(link(), 1.0);
  stage.stop();
  EXPECT_TRUE(test::soon([&] { return field.read(inputs) == Fault::lost_link; }));
  EXPECT_EQ(field.absent(), 0U);
}

TEST(DeviceField, WhatADeviceRefusesIsStale) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.start();
  DeviceField field(config_of(port, "fault", "50ms"), false);
  Inputs inputs{};
  const auto reads = [&](Fault fault) {
    return test::soon([&] {
      field.write(std::array{0.5});
      return field.read(inputs) == fault;
    });
  };
  ASSERT_TRUE(reads(Fault::none));
  stage.refuse("not now");
  EXPECT_TRUE(reads(Fault::stale_input));
  EXPECT_EQ(inputs[3], static_cast<double>(Quality::refused));
}

TEST(DeviceField, WhatIsOutsideOfTheLimitsOfAnInputIsNotTaken) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.start();
  ProgramShape limited = shape();
  limited.inputs[0].low = -1.0;
  limited.inputs[0].high = 2.0;
  DeviceField field(parse_run_config("RUN.toml",
                                     fmt::format("[devices.stage]\nport = {}\n[outputs.Y]\nsafe = 0.0\n[inputs.X]\n"
                                                 "device = \"stage\"\narea = \"input\"\n[inputs.X_QUALITY]\n"
                                                 "quality_of = \"X\"\n",
                                                 port),
                                     limited),
                    true);
  Inputs inputs{};
  for (const double sound : {-1.0, 0.5, 2.0}) {
    stage.give(sound);
    EXPECT_EQ(field.read(inputs), Fault::none) << sound;
    EXPECT_EQ(inputs[0], sound);
  }
  std::uint64_t refused = 0;
  for (const double wrong : {-1.0000001, 2.0000001, 1e300, -HUGE_VAL, std::nan("")}) {
    stage.give(wrong);
    EXPECT_EQ(field.read(inputs), Fault::stale_input) << wrong;
    EXPECT_EQ(field.faulty_port(), 0U);
    EXPECT_EQ(inputs[0], 2.0) << "the last that was taken stays";
    EXPECT_EQ(inputs[2], static_cast<double>(Quality::refused));
    EXPECT_EQ(field.not_taken(), ++refused);
  }
  stage.give(0.5);
  EXPECT_EQ(field.read(inputs), Fault::none);
}

TEST(DeviceField, SaysWhatWentWrongWithEachDevice) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  const RunConfig config = config_of(port);
  const std::vector<Point> points = device_points(config);
  DeviceField field(config, true);
  Inputs inputs{};
  const auto count_of = [&](const std::string& name) {
    std::vector<double> counts(points.size());
    field.count(counts);
    const auto found = std::ranges::find(points, "device.stage." + name, &Point::name);
    return counts.at(static_cast<std::size_t>(found - points.begin()));
  };
  (void)field.read(inputs);
  EXPECT_EQ(count_of("link"), 2.0) << "waiting";
  EXPECT_EQ(count_of("unreachable"), 1.0);
  stage.start();
  (void)field.read(inputs);
  EXPECT_EQ(count_of("link"), 1.0);
  EXPECT_EQ(count_of("connections"), 1.0);
  EXPECT_EQ(count_of("answers"), 1.0) << "nothing is written yet";
  stage.refuse("not now");
  field.write(std::array{0.5});
  (void)field.read(inputs);
  EXPECT_EQ(count_of("exceptions"), 1.0);
  stage.stop();
  (void)field.read(inputs);
  EXPECT_EQ(count_of("closed"), 1.0);
  EXPECT_EQ(count_of("link"), 2.0);
  EXPECT_EQ(count_of("timeouts") + count_of("wrong_answers") + count_of("bad_checksums"), 0.0);
}

TEST(DeviceField, WhatIsSaidOfDevicesMovesNoOtherAddress) {
  std::vector<Point> points{{.name = "U"}, {.name = "task.state", .type = PointType::uint16}};
  const std::string before = modbus::lock_text(modbus::make_register_map(points, {.title = "T"}));
  for (const Point& point : device_points(config_of(1))) {
    points.push_back(point);
  }
  points.push_back({.name = "task.reset", .type = PointType::uint16});
  const std::string after = modbus::lock_text(modbus::make_register_map(points, {.title = "T"}));
  EXPECT_TRUE(after.starts_with(before + "input 5 uint16 task.reset\n")) << after;
}

TEST(DeviceField, InTurnEveryCycleWritesAndThenReads) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.start();
  DeviceField field(config_of(port), true);
  Inputs inputs{};
  for (int cycle = 1; cycle < 50; ++cycle) {
    stage.give(cycle);
    EXPECT_EQ(field.read(inputs), Fault::none);
    EXPECT_EQ(inputs[0], cycle);
    EXPECT_EQ(inputs[1], 0.0);
    EXPECT_EQ(stage.writes(), static_cast<std::uint64_t>(cycle - 1));
    EXPECT_EQ(stage.taken(), cycle == 1 ? 0.0 : 10.0 * (cycle - 1));
    field.write(std::array{10.0 * cycle});
  }
  EXPECT_EQ(field.delivery(), Delivery::done);
  EXPECT_EQ(stage.taken(), 490.0);
  stage.stop();
  for (int cycle = 1; cycle <= 3; ++cycle) {
    EXPECT_EQ(field.read(inputs), Fault::lost_link);
    EXPECT_EQ(inputs[1], cycle * 0.001) << "on the virtual clock the age is that of the cycles";
  }
  field.write(std::array{0.0});
  EXPECT_EQ(field.delivery(), Delivery::failed);
}

TEST(DeviceField, WhoMayNotWriteWritesNothingNotEvenAtItsEnd) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.start();
  std::atomic<bool> may_write{true};
  {
    DeviceField field(config_of(port), false, [&] { return may_write.load(); });
    field.write(std::array{0.5});
    EXPECT_TRUE(test::soon([&] { return field.delivery() == Delivery::done; }));
    may_write.store(false);
    std::uint64_t writes = 0;
    EXPECT_TRUE(
        test::soon([&] { return stage.writes() == std::exchange(writes, stage.writes()); }));  // the one under way
    field.write(std::array{99.0});
    Inputs inputs{};
    stage.give(3.0);
    EXPECT_TRUE(test::soon([&] {
      (void)field.read(inputs);
      return inputs[0] == 3.0;
    })) << "it still reads";
  }
  EXPECT_EQ(stage.taken(), 0.5);
}

TEST(DeviceField, TheLastValuesArriveBeforeItEnds) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  stage.start();
  {
    DeviceField field(config_of(port), false);
    field.write(std::array{0.5});
    EXPECT_TRUE(test::soon([&] { return field.delivery() == Delivery::done; }));
    field.write(std::array{-1.0});
  }
  EXPECT_EQ(stage.taken(), -1.0);
}

TEST(DeviceOutputs, AreTakenFromANewConnectionAndADeadDeviceIsNotBelieved) {
  const std::uint16_t port = test::free_port();
  ServedDevice stage(port);
  DeviceOutputs outputs(config_of(port));
  outputs.open();
  EXPECT_FALSE(outputs.write(std::array{-1.0}));
  stage.start();
  EXPECT_TRUE(test::soon([&] { return outputs.write(std::array{-1.0}); }));
  EXPECT_EQ(stage.taken(), -1.0);
  EXPECT_TRUE(test::soon([&] { return outputs.write(std::array{-2.0}); }));
  EXPECT_EQ(stage.taken(), -2.0);
}

}  // namespace
}  // namespace hysteron::runtime
