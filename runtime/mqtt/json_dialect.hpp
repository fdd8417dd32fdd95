// Plain JSON, as docs/reference/schemas/mqtt-data.json and mqtt-state.json describe it:
//
//   TOPIC/data    a row: {"timestamp": ms, "cycle": n, "values": {"U": {"value": 1.5, "unit": "V", "quality": "good"}}}
//   TOPIC/state   {"online": true, "timestamp": ms}, retained; the broker says {"online": false} where this ends
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/mqtt/dialect.hpp"

namespace hysteron::runtime {

class JsonDialect final : public MqttDialect {
 public:
  JsonDialect(std::string topic, int qos, std::span<const MqttPoint> points);

  [[nodiscard]] MqttMessage will() override;
  [[nodiscard]] std::string commands() const override { return {}; }
  [[nodiscard]] MqttMessage birth(const MqttRow& whole, std::int64_t now_ms) override;
  [[nodiscard]] MqttMessage data(const MqttRow& row, bool is_stored, std::int64_t now_ms) override;
  [[nodiscard]] MqttMessage farewell(std::int64_t now_ms) override;
  [[nodiscard]] bool asks_for_birth(std::string_view /*payload*/) const override { return false; }

 private:
  /// What stands round a value, the same in each row.
  struct Frame {
    std::string before{};
    std::string after{};
    PointType type = PointType::real64;
  };

  std::string topic_;
  int qos_;
  std::vector<Frame> frames_{};
};

}  // namespace hysteron::runtime
