#include "runtime/mqtt/sparkplug.hpp"

#include <cmath>
#include <utility>

#include "runtime/modbus/value_bits.hpp"
#include "runtime/mqtt/wire_format.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::string_view rebirth = "Node Control/Rebirth";

// Numbers of fields and types as in chapter 6.4 of the specification.
namespace payload_field {
constexpr std::uint32_t timestamp = 1;
constexpr std::uint32_t metrics = 2;
constexpr std::uint32_t sequence = 3;
}  // namespace payload_field
namespace metric_field {
constexpr std::uint32_t name = 1;
constexpr std::uint32_t alias = 2;
constexpr std::uint32_t timestamp = 3;
constexpr std::uint32_t type = 4;
constexpr std::uint32_t is_historical = 5;
constexpr std::uint32_t is_null = 7;
constexpr std::uint32_t properties = 9;
constexpr std::uint32_t int_value = 10;
constexpr std::uint32_t long_value = 11;
constexpr std::uint32_t float_value = 12;
constexpr std::uint32_t double_value = 13;
constexpr std::uint32_t boolean_value = 14;
}  // namespace metric_field
namespace property_field {
constexpr std::uint32_t keys = 1;    // of the set
constexpr std::uint32_t values = 2;  // of the set
constexpr std::uint32_t type = 1;
constexpr std::uint32_t int_value = 3;
constexpr std::uint32_t text_value = 8;
}  // namespace property_field

constexpr std::uint32_t int32_type = 3;
constexpr std::uint32_t int64_type = 4;
constexpr std::uint32_t boolean_type = 11;
constexpr std::uint32_t text_type = 12;

std::uint32_t type_of(PointType type) {
  switch (type) {
    case PointType::boolean:
      return boolean_type;
    case PointType::int16:
      return 2;
    case PointType::uint16:
      return 6;
    case PointType::int32:
      return int32_type;
    case PointType::uint32:
      return 7;
    case PointType::int64:
      return int64_type;
    case PointType::uint64:
      return 8;
    case PointType::real32:
      return 9;
    case PointType::real64:
      break;
  }
  return 10;
}

/// Negative numbers in two's complement, of 32 bits where the type has fewer.
void write_value(WireWriter& metric, double value, PointType type) {
  const std::uint64_t bits = modbus::bits_of(value, type);
  switch (type) {
    case PointType::boolean:
      return metric.varint(metric_field::boolean_value, bits);
    case PointType::int16:
      return metric.varint(metric_field::int_value,
                           static_cast<std::uint32_t>(std::int32_t{static_cast<std::int16_t>(bits)}));
    case PointType::uint16:
    case PointType::int32:
    case PointType::uint32:
      return metric.varint(metric_field::int_value, bits);
    case PointType::int64:
    case PointType::uint64:
      return metric.varint(metric_field::long_value, bits);
    case PointType::real32:
      return metric.real(metric_field::float_value, static_cast<float>(value));
    case PointType::real64:
      break;
  }
  metric.real(metric_field::double_value, value);
}

/// 6.4.15: good, stale, bad. The specification knows no others.
std::uint32_t quality_code(ValueQuality quality) {
  return quality == ValueQuality::Good ? 192U : quality == ValueQuality::Uncertain ? 500U : 0U;
}

class Properties {
 public:
  void add(std::string_view key, std::uint32_t type, std::uint32_t field, std::uint64_t value) {
    WireWriter one;
    one.varint(property_field::type, type);
    one.varint(field, value);
    add(key, one);
  }
  void add(std::string_view key, std::string_view text) {
    WireWriter one;
    one.varint(property_field::type, text_type);
    one.bytes(property_field::text_value, text);
    add(key, one);
  }
  void write(WireWriter& metric) const {
    if (!set_.written().empty()) {
      metric.bytes(metric_field::properties, set_.written());
    }
  }

 private:
  void add(std::string_view key, const WireWriter& value) {
    set_.bytes(property_field::keys, key);
    set_.bytes(property_field::values, value.written());
  }
  WireWriter set_{};
};

/// A metric; in a birth with name, type and unit, later by its alias alone.
void write_metric(WireWriter& payload, const MqttValue& value, const MqttPoint& point, std::int64_t utc_ms,
                  bool is_birth, bool is_stored) {
  WireWriter metric;
  if (is_birth) {
    metric.bytes(metric_field::name, point.name);
  }
  metric.varint(metric_field::alias, value.point + 1);
  metric.varint(metric_field::timestamp, static_cast<std::uint64_t>(utc_ms));
  metric.varint(metric_field::type, type_of(point.type));
  if (is_stored) {
    metric.varint(metric_field::is_historical, 1);
  }
  const bool is_number = std::isfinite(value.value);
  if (!is_number) {
    metric.varint(metric_field::is_null, 1);
  }
  Properties properties;
  if (is_birth) {
    properties.add("engUnit", point.unit);
  }
  if (is_birth || value.quality != ValueQuality::Good) {
    properties.add("Quality", int32_type, property_field::int_value, quality_code(value.quality));
  }
  properties.write(metric);
  if (is_number) {
    write_value(metric, value.value, point.type);
  }
  payload.bytes(payload_field::metrics, metric.written());
}

void write_connection(WireWriter& payload, std::uint8_t number, std::optional<std::int64_t> now_ms) {
  WireWriter metric;
  metric.bytes(metric_field::name, "bdSeq");
  if (now_ms) {
    metric.varint(metric_field::timestamp, static_cast<std::uint64_t>(*now_ms));
  }
  metric.varint(metric_field::type, int64_type);
  metric.varint(metric_field::long_value, number);
  payload.bytes(payload_field::metrics, metric.written());
}

}  // namespace

SparkplugNode::SparkplugNode(std::string group, std::string node, std::vector<MqttPoint> points)
    : group_(std::move(group)), node_(std::move(node)), points_(std::move(points)) {}

std::string SparkplugNode::topic(const char* kind) const {
  return "spBv1.0/" + group_ + "/" + kind + "/" + node_;
}

std::string SparkplugNode::death() const {
  WireWriter payload;
  write_connection(payload, connection_, std::nullopt);
  return payload.written();
}

MqttMessage SparkplugNode::will() {
  ++connection_;
  return {.topic = topic("NDEATH"), .payload = death(), .qos = 1};
}

MqttMessage SparkplugNode::farewell(std::int64_t /*now_ms*/) {
  return {.topic = topic("NDEATH"), .payload = death(), .qos = 1};
}

MqttMessage SparkplugNode::birth(const MqttRow& whole, std::int64_t now_ms) {
  sequence_ = 1;
  WireWriter payload;
  payload.varint(payload_field::timestamp, static_cast<std::uint64_t>(now_ms));
  write_connection(payload, connection_, now_ms);
  WireWriter control;
  control.bytes(metric_field::name, rebirth);
  control.varint(metric_field::timestamp, static_cast<std::uint64_t>(now_ms));
  control.varint(metric_field::type, boolean_type);
  control.varint(metric_field::boolean_value, 0);
  payload.bytes(payload_field::metrics, control.written());
  for (const MqttValue& value : whole.values) {
    write_metric(payload, value, points_[value.point], whole.utc_ms, true, false);
  }
  payload.varint(payload_field::sequence, 0);
  return {.topic = topic("NBIRTH"), .payload = payload.written()};
}

MqttMessage SparkplugNode::data(const MqttRow& row, bool is_stored, std::int64_t now_ms) {
  WireWriter payload;
  payload.varint(payload_field::timestamp, static_cast<std::uint64_t>(now_ms));
  for (const MqttValue& value : row.values) {
    write_metric(payload, value, points_[value.point], row.utc_ms, false, is_stored);
  }
  payload.varint(payload_field::sequence, sequence_++);
  return {.topic = topic("NDATA"), .payload = payload.written()};
}

bool SparkplugNode::asks_for_birth(std::string_view payload) const {
  WireReader all(payload);
  while (const auto field = all.next()) {
    if (field->number != payload_field::metrics) {
      continue;
    }
    WireReader metric(field->bytes);
    bool is_rebirth = false;
    bool is_true = false;
    while (const auto part = metric.next()) {
      is_rebirth = is_rebirth || (part->number == metric_field::name && part->bytes == rebirth);
      is_true = is_true || (part->number == metric_field::boolean_value && part->value != 0);
    }
    if (is_rebirth && is_true) {
      return true;
    }
  }
  return false;
}

}  // namespace hysteron::runtime
