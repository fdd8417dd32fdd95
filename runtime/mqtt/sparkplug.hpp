// Sparkplug B, version 3.0: an edge node without devices.
//
//   spBv1.0/GROUP/NBIRTH/NODE   every metric with name, alias, type, unit and value; number 0 of a sequence
//   spBv1.0/GROUP/NDATA/NODE    a row: metrics by alias; numbers 1 to 255, then 0, 1, …
//   spBv1.0/GROUP/NDEATH/NODE   the broker says it where the node ends; its bdSeq is that of the birth
//   spBv1.0/GROUP/NCMD/NODE     taken: "Node Control/Rebirth". No other command is: the task is not written to.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/mqtt/dialect.hpp"

namespace hysteron::runtime {

class SparkplugNode final : public MqttDialect {
 public:
  SparkplugNode(std::string group, std::string node, std::vector<MqttPoint> points);

  [[nodiscard]] MqttMessage will() override;
  [[nodiscard]] std::string commands() const override { return topic("NCMD"); }
  [[nodiscard]] MqttMessage birth(const MqttRow& whole, std::int64_t now_ms) override;
  [[nodiscard]] MqttMessage data(const MqttRow& row, bool is_stored, std::int64_t now_ms) override;
  [[nodiscard]] MqttMessage farewell(std::int64_t now_ms) override;
  [[nodiscard]] bool asks_for_birth(std::string_view payload) const override;

 private:
  [[nodiscard]] std::string topic(const char* kind) const;
  [[nodiscard]] std::string death() const;

  std::string group_;
  std::string node_;
  std::vector<MqttPoint> points_;
  std::uint8_t connection_ = 255;  ///< bdSeq: of the first connection, 0
  std::uint8_t sequence_ = 0;      ///< of the next message
};

}  // namespace hysteron::runtime
