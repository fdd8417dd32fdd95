#include "runtime/mqtt/json_dialect.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace hysteron::runtime {
namespace {

constexpr std::array<const char*, 3> quality_names{"good", "uncertain", "bad"};

/// JSON has no word for what is no number.
std::string value_text(double value, PointType type) {
  if (!std::isfinite(value)) {
    return "null";
  }
  if (type == PointType::boolean) {
    return value != 0.0 ? "true" : "false";
  }
  return is_real(type) ? fmt::format("{}", value) : fmt::format("{:.0f}", value);
}

/// Bytes that are no UTF-8 are replaced: what is sent is JSON whatever the diagram's units say.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

JsonDialect::JsonDialect(std::string topic, int qos, std::span<const MqttPoint> points)
    : topic_(std::move(topic)), qos_(qos) {
  for (const MqttPoint& point : points) {
    frames_.push_back({.before = quoted(point.name) + ":{\"value\":",
                       .after = ",\"unit\":" + quoted(point.unit) + ",\"quality\":\"",
                       .type = point.type});
  }
}

MqttMessage JsonDialect::will() {
  return {.topic = topic_ + "/state", .payload = R"({"online":false})", .qos = 1, .retain = true};
}

MqttMessage JsonDialect::birth(const MqttRow& /*whole*/, std::int64_t now_ms) {
  return {.topic = topic_ + "/state",
          .payload = fmt::format(R"({{"online":true,"timestamp":{}}})", now_ms),
          .qos = 1,
          .retain = true};
}

MqttMessage JsonDialect::farewell(std::int64_t now_ms) {
  return {.topic = topic_ + "/state",
          .payload = fmt::format(R"({{"online":false,"timestamp":{}}})", now_ms),
          .qos = 1,
          .retain = true};
}

MqttMessage JsonDialect::data(const MqttRow& row, bool /*is_stored*/, std::int64_t /*now_ms*/) {
  std::string text = fmt::format(R"({{"timestamp":{},"cycle":{},"values":{{)", row.utc_ms, row.cycle);
  bool is_first = true;
  for (const MqttValue& value : row.values) {
    const Frame& frame = frames_[value.point];
    text += is_first ? "" : ",";
    is_first = false;
    text += frame.before;
    text += value_text(value.value, frame.type);
    text += frame.after;
    text += quality_names.at(static_cast<std::size_t>(value.quality));
    text += "\"}";
  }
  return {.topic = topic_ + "/data", .payload = text + "}}", .qos = qos_};
}

}  // namespace hysteron::runtime
