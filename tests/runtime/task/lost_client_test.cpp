// The Modbus client that has to be heard falls silent: the outputs become safe, and return as configured.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "runtime/modbus/device.hpp"
#include "runtime/modbus/server.hpp"
#include "runtime/task/task.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;

constexpr double safe = -7.0;
constexpr double lost_client = static_cast<double>(Fault::lost_client);

/// A task on the machine's clock with a server that waits for writes of a client.
class ServedTask {
 public:
  explicit ServedTask(bool reset_after_loss)
      : task_(program_,
              {.inputs = {{}},
               .outputs = {{.high = 1.0, .value = safe}, {}},
               .reset_after_lost_client = reset_after_loss},
              {}),
        server_(modbus::make_register_map(task_.door().points(), {}), task_.door(),
                {.port = 0,
                 .heartbeat = {.mode = modbus::HeartbeatMode::write_telegram, .time = milliseconds(150)},
                 .client_lost = [this](bool lost) { task_.client_lost(lost); }}),
        cyclic_([this] {
          MonotonicClock clock;
          (void)task_.run(clock, stop_);
        }) {}
  ServedTask(const ServedTask&) = delete;
  ServedTask& operator=(const ServedTask&) = delete;
  ~ServedTask() {
    stop_.store(true);
    cyclic_.join();
  }

  [[nodiscard]] double value(std::string_view name) { return test::value(task_.door(), name); }
  /// A client that writes a point again and again for as long as it lives.
  [[nodiscard]] std::unique_ptr<modbus::Device> client(std::string_view name, double number) {
    modbus::RemoteValue value{.written = true};
    const auto map = server_.map();
    for (const modbus::MapEntry& entry : map->entries()) {
      if (map->point_of(entry).name == name) {
        value.at = entry.at;
        value.format = entry.format;
      }
    }
    auto device = std::make_unique<modbus::Device>(modbus::DeviceOptions{
        .link = modbus::TcpLink{.port = server_.port()}, .values = {value}, .period = milliseconds(5)});
    device->write(0, number);
    return device;
  }

 private:
  test::Accumulator program_;
  Task task_;
  modbus::Server server_;
  std::atomic<bool> stop_{false};
  std::thread cyclic_;
};

TEST(LostClient, BringsTheOutputsToTheirSafeValuesUntilItIsBack) {
  ServedTask task(false);
  EXPECT_TRUE(test::soon([&] { return task.value("Y") == 1.0; }));  // nobody was there who could be lost
  for (int round = 0; round < 2; ++round) {
    auto client = task.client("X", 0.5);
    EXPECT_TRUE(test::soon([&] { return task.value("X") == 0.5 && task.value("Y") == 1.0; }));
    EXPECT_EQ(task.value("task.fault"), 0.0);
    client.reset();
    EXPECT_TRUE(test::soon([&] { return task.value("Y") == safe; }));
    EXPECT_EQ(task.value("task.fault"), lost_client);
  }
}

TEST(LostClient, KeepsTheOutputsSafeUntilTheResetWhereOneIsAskedFor) {
  ServedTask task(true);
  auto client = task.client("X", 0.5);
  EXPECT_TRUE(test::soon([&] { return task.value("X") == 0.5 && task.value("Y") == 1.0; }));
  client.reset();
  EXPECT_TRUE(test::soon([&] { return task.value("Y") == safe; }));
  client = task.client("X", 0.75);
  EXPECT_TRUE(test::soon([&] { return task.value("X") == 0.75; }));
  const double cycle = task.value("task.cycles");
  EXPECT_TRUE(test::soon([&] { return task.value("task.cycles") > cycle + 50; }));
  EXPECT_EQ(task.value("Y"), safe);
  EXPECT_EQ(task.value("task.fault"), lost_client);
  client = task.client("task.reset", 1.0);
  EXPECT_TRUE(test::soon([&] { return task.value("Y") == 0.75 || task.value("Y") == 1.0; }));
  EXPECT_EQ(task.value("task.fault"), 0.0);
}

}  // namespace
}  // namespace hysteron::runtime
