// What is published, without a task: clocks that the test sets, rows that it gives, and a broker that is real.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runtime/mqtt/json_dialect.hpp"
#include "runtime/mqtt/mqtt.hpp"
#include "tests/runtime/mqtt/broker.hpp"

namespace hysteron::runtime::test {

class WithBroker : public testing::Test {
 protected:
  void SetUp() override { skip_without_broker(); }
};

/// A task of 1 ms with the points U, the number of the cycle, and Y, its half; a row every tenth cycle.
class MqttBench {
 public:
  static constexpr std::int64_t ms = 1'000'000;
  static constexpr std::int64_t noon_ms = 1'795'867'200'000;  ///< 2026-11-28T12:00:00Z

  explicit MqttBench(std::uint16_t port) {
    settings.link.broker = "127.0.0.1";
    settings.link.port = port;
    settings.link.client_id = "bench";
    settings.rows = {
        .points = {{.name = "U", .unit = "V", .is_port = true}, {.name = "Y", .unit = "um", .is_port = true}},
        .fault_column = 2,
        .refresh = 1000};
    settings.period = ms;
    settings.bytes = 10'000'000;
    settings.keep = 3600 * std::int64_t{1'000'000'000};
  }

  void start(std::unique_ptr<MqttDialect> dialect = nullptr) {
    if (dialect == nullptr) {
      dialect = std::make_unique<JsonDialect>("plant", qos, settings.rows.points);
    }
    sender_ = std::make_unique<MqttSender>(settings, std::move(dialect), tap_, counter_,
                                           BesideClocks{.utc = [this] { return utc_; },
                                                        .steady = [this] { return steady_; },
                                                        .elapsed = [this] { return elapsed_; }});
  }
  /// Cycles of the task, and the clocks with them.
  void run(std::uint64_t cycles) {
    for (std::uint64_t i = 0; i < cycles; ++i) {
      ++elapsed_;
      pass(ms);
      const auto u = static_cast<double>(elapsed_);
      tap_.offer(elapsed_, elapsed_, std::vector<double>{u, 0.5 * u, 0.0});
    }
  }
  void pass(std::int64_t time) {
    utc_ += time;
    steady_ += time;
  }
  void turn() { sender_->turn(std::chrono::milliseconds(1)); }
  /// Turns, with time going by, until something holds.
  bool until(const std::function<bool()>& holds) {
    return soon([&] {
      turn();
      pass(ms);
      return holds();
    });
  }
  /// Turns until all that was given is confirmed.
  bool until_confirmed() {
    return until([&] { return count().is_connected && count().waiting == 0; });
  }
  void finish() { sender_->finish(std::chrono::milliseconds(2000)); }
  void finish(std::chrono::milliseconds longest) { sender_->finish(longest); }
  void stop() { sender_.reset(); }

  [[nodiscard]] KeptCount count() const { return counter_.read(); }
  [[nodiscard]] std::string said() {
    std::string text;
    for (const std::string& line : sender_->remarks().lines()) {
      text += line + "\n";
    }
    return text;
  }
  [[nodiscard]] Remarks& remarks() { return sender_->remarks(); }

  MqttSettings settings{};
  int qos = 1;

 private:
  KeptCounter counter_{};
  SampleTap tap_{{0, 1, 2}, 10, 5000, counter_};
  std::unique_ptr<MqttSender> sender_;
  std::int64_t utc_ = noon_ms * ms;
  std::int64_t steady_ = 1'000'000 * ms;
  std::uint64_t elapsed_ = 0;
};

/// The values of U in rows of JSON.
inline std::vector<std::int64_t> numbers_in(const std::vector<std::string>& rows) {
  std::vector<std::int64_t> list;
  for (const std::string& row : rows) {
    list.push_back(nlohmann::json::parse(row).at("values").at("U").at("value").get<std::int64_t>());
  }
  return list;
}

}  // namespace hysteron::runtime::test
