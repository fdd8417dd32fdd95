// What is published: points, and rows of their values at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/point.hpp"

namespace hysteron::runtime {

/// Of a value, in OPC's three grades.
enum class ValueQuality : std::uint8_t {
  Good,
  Uncertain,  ///< a fault holds in the task, an input is forced, or the value of a device is old
  Bad,        ///< no number, or none that a device gave
};

struct MqttPoint {
  std::string name{};
  std::string unit{};
  PointType type = PointType::real64;
  bool is_port = false;    ///< an input or output: a fault of the task is about it
  double dead_band = 0.0;  ///< a change up to so much is none; in its unit
  /// The column of a sample that tells how the device's value is, as modbus::Quality counts.
  std::optional<std::size_t> quality_column{};
};

struct MqttValue {
  std::size_t point = 0;  ///< index into those that are published
  double value = 0.0;
  ValueQuality quality = ValueQuality::Good;
};

struct MqttRow {
  std::int64_t utc_ms = 0;  ///< of the cycle, not of the sending
  std::uint64_t cycle = 0;
  std::vector<MqttValue> values{};
};

}  // namespace hysteron::runtime
