// A door to values in memory, for tests of servers: counts what it is asked, refuses on request.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/point.hpp"

namespace hysteron::test {

class MemoryDoor : public runtime::PointDoor {
 public:
  explicit MemoryDoor(std::vector<runtime::Point> points) : points_(std::move(points)), values_(points_.size()) {}

  [[nodiscard]] std::span<const runtime::Point> points() const override { return points_; }
  void read(runtime::Snapshot& into) override {
    const std::scoped_lock lock(mutex_);
    into.cycle = ++reads_;
    into.values = values_;
  }
  std::string write(std::span<const runtime::PointWrite> writes) override {
    const std::scoped_lock lock(mutex_);
    if (!refusal_.empty()) {
      return refusal_;
    }
    ++writes_;
    for (const auto& [point, value] : writes) {
      values_[point] = value;
      history_[point].push_back(value);
    }
    return "";
  }

  void read_live(runtime::LiveValues& into) override {
    runtime::Snapshot snapshot;
    read(snapshot);
    into = {.cycle = snapshot.cycle, .values = std::move(snapshot.values)};
  }

  void writes_are_owned(bool are_owned) override { is_owned_ = are_owned; }
  [[nodiscard]] bool is_owned() const { return is_owned_; }

  void set(std::size_t point, double value) {
    const std::scoped_lock lock(mutex_);
    values_[point] = value;
  }
  void refuse(std::string why) {
    const std::scoped_lock lock(mutex_);
    refusal_ = std::move(why);
  }
  [[nodiscard]] double value(std::size_t point) {
    const std::scoped_lock lock(mutex_);
    return values_[point];
  }
  /// Every value that was written there, in order.
  [[nodiscard]] std::vector<double> history(std::size_t point) {
    const std::scoped_lock lock(mutex_);
    return history_[point];
  }
  [[nodiscard]] std::uint64_t writes() {
    const std::scoped_lock lock(mutex_);
    return writes_;
  }

 private:
  std::mutex mutex_;
  std::vector<runtime::Point> points_;
  std::vector<double> values_;
  std::map<std::size_t, std::vector<double>> history_;
  std::string refusal_;
  std::uint64_t reads_ = 0;
  std::uint64_t writes_ = 0;
  std::atomic<bool> is_owned_{false};
};

/// A point of every type, to be read and to be written.
inline std::vector<runtime::Point> points_of_every_type() {
  using runtime::PointKind;
  using runtime::PointType;
  std::vector<runtime::Point> points;
  const auto add = [&](std::string name, PointType type, bool writable, double low, double high) {
    points.push_back({.name = std::move(name),
                      .kind = writable ? PointKind::parameter : PointKind::status,
                      .type = type,
                      .unit = "um/V",
                      .low = low,
                      .high = high,
                      .writable = writable,
                      .meaning = "a value, \"so\" to say"});
  };
  for (const bool writable : {false, true}) {
    const std::string end = writable ? ".W" : ".R";
    add("FLAG" + end, PointType::boolean, writable, 0, 1);
    add("I16" + end, PointType::int16, writable, -1000, 1000);
    add("U16" + end, PointType::uint16, writable, 0, 65535);
    add("I32" + end, PointType::int32, writable, -1e6, 1e6);
    add("U32" + end, PointType::uint32, writable, 0, 4e9);
    add("I64" + end, PointType::int64, writable, -1e15, 1e15);
    add("U64" + end, PointType::uint64, writable, 0, 1e18);
    add("R32" + end, PointType::real32, writable, -1e30, 1e30);
    add("R64" + end, PointType::real64, writable, -1e300, 1e300);
    for (int i = 0; i < 20; ++i) {
      add("B" + std::to_string(i) + end, PointType::boolean, writable, 0, 1);
      add("W" + std::to_string(i) + end, PointType::uint16, writable, 0, 65535);
    }
  }
  return points;
}

}  // namespace hysteron::test
