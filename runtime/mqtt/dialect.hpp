// What is said to a broker, and on which topics: the same for every payload. JSON and Sparkplug B are two of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/mqtt/row.hpp"

namespace hysteron::runtime {

struct MqttMessage {
  std::string topic{};
  std::string payload{};
  int qos = 0;
  bool retain = false;
};

class MqttDialect {
 public:
  MqttDialect() = default;
  MqttDialect(const MqttDialect&) = delete;
  MqttDialect& operator=(const MqttDialect&) = delete;
  virtual ~MqttDialect() = default;

  /// Of a new connection, before it: what the broker tells others where it ends without a farewell.
  [[nodiscard]] virtual MqttMessage will() = 0;
  /// The topic of commands; empty where none are taken.
  [[nodiscard]] virtual std::string commands() const = 0;
  /// Once connected, and where asks_for_birth() says so. `whole` has every point.
  [[nodiscard]] virtual MqttMessage birth(const MqttRow& whole, std::int64_t now_ms) = 0;
  /// `is_stored`: the row is from before this connection.
  [[nodiscard]] virtual MqttMessage data(const MqttRow& row, bool is_stored, std::int64_t now_ms) = 0;
  /// Before the end of the connection.
  [[nodiscard]] virtual MqttMessage farewell(std::int64_t now_ms) = 0;
  [[nodiscard]] virtual bool asks_for_birth(std::string_view payload) const = 0;
};

}  // namespace hysteron::runtime
