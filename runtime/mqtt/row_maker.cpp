#include "runtime/mqtt/row_maker.hpp"

#include <cmath>
#include <utility>

#include "runtime/modbus/device.hpp"

namespace hysteron::runtime {
namespace {

/// What the run file's `quality_of` tells an input.
ValueQuality device_quality(double told) {
  if (told == static_cast<double>(modbus::Quality::good)) {
    return ValueQuality::Good;
  }
  return told == static_cast<double>(modbus::Quality::old) ? ValueQuality::Uncertain : ValueQuality::Bad;
}

}  // namespace

RowMaker::RowMaker(RowPlan plan) : plan_(std::move(plan)), last_(plan_.points.size()) {}

ValueQuality RowMaker::quality_of(const MqttPoint& point, const Sample& sample, double value) const {
  if (!std::isfinite(value)) {
    return ValueQuality::Bad;
  }
  if (point.quality_column) {
    const ValueQuality told = device_quality(sample.values[*point.quality_column]);
    if (told != ValueQuality::Good) {
      return told;
    }
  }
  const bool is_doubtful =
      sample.values[plan_.fault_column] != 0.0 || (plan_.forced_column && sample.values[*plan_.forced_column] != 0.0);
  return point.is_port && is_doubtful ? ValueQuality::Uncertain : ValueQuality::Good;
}

MqttRow RowMaker::whole(const Sample& sample, std::int64_t utc_ms) const {
  MqttRow row{.utc_ms = utc_ms, .cycle = sample.cycle};
  row.values.reserve(plan_.points.size());
  for (std::size_t i = 0; i < plan_.points.size(); ++i) {
    const double value = sample.values[i];
    row.values.push_back({.point = i, .value = value, .quality = quality_of(plan_.points[i], sample, value)});
  }
  return row;
}

bool RowMaker::is_due(const MqttPoint& point, const Last& last, const MqttValue& now, std::uint64_t elapsed) const {
  if (!last.is_known || now.quality != last.quality || elapsed - last.elapsed >= plan_.refresh) {
    return true;
  }
  if (!std::isfinite(now.value) || !std::isfinite(last.value)) {
    // Two that are no number are the same to whoever reads them.
    return std::isfinite(now.value) != std::isfinite(last.value);
  }
  return std::abs(now.value - last.value) > point.dead_band;
}

std::optional<MqttRow> RowMaker::row(const Sample& sample, std::int64_t utc_ms) {
  MqttRow row = whole(sample, utc_ms);
  if (!plan_.on_change) {
    return row;
  }
  std::vector<MqttValue> due;
  for (const MqttValue& value : row.values) {
    Last& last = last_[value.point];
    if (is_due(plan_.points[value.point], last, value, sample.elapsed)) {
      last = {.is_known = true, .value = value.value, .quality = value.quality, .elapsed = sample.elapsed};
      due.push_back(value);
    }
  }
  if (due.empty()) {
    return std::nullopt;
  }
  row.values.assign(due.begin(), due.end());
  row.values.shrink_to_fit();  // it may wait for long
  return row;
}

void RowMaker::forget() {
  last_.assign(plan_.points.size(), {});
}

}  // namespace hysteron::runtime
