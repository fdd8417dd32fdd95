// Chosen values of the cycles that were published, on their way to a thread that keeps or sends them; and what that
// thread says of its work. The cyclic thread copies them, waits for nothing, and counts what has no room.
//
// A row is due once for every `step` periods by the clock: where elapsed / step is another than before. So rows lie on
// an even grid however late the thread is that takes them, and also where a cycle was skipped.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/task/byte_ring.hpp"

namespace hysteron::runtime {

/// What is written or sent beside the task.
struct KeptCount {
  std::uint64_t done = 0;
  std::uint64_t lost = 0;
  std::uint16_t fault = 0;    ///< that holds now; 0: none
  std::uint64_t waiting = 0;  ///< of what is sent: rows that nobody has confirmed
  bool is_connected = false;  ///< of what is sent
};

/// The same, told by one thread to any other.
class KeptCounter {
 public:
  void add_done(std::uint64_t count) noexcept { done_.fetch_add(count, std::memory_order_relaxed); }
  void add_lost(std::uint64_t count) noexcept { lost_.fetch_add(count, std::memory_order_relaxed); }
  void set_fault(std::uint16_t fault) noexcept { fault_.store(fault, std::memory_order_relaxed); }
  void set_waiting(std::uint64_t count) noexcept { waiting_.store(count, std::memory_order_relaxed); }
  void set_connected(bool is_connected) noexcept { connected_.store(is_connected, std::memory_order_relaxed); }
  [[nodiscard]] KeptCount read() const noexcept {
    return {.done = done_.load(std::memory_order_relaxed),
            .lost = lost_.load(std::memory_order_relaxed),
            .fault = fault_.load(std::memory_order_relaxed),
            .waiting = waiting_.load(std::memory_order_relaxed),
            .is_connected = connected_.load(std::memory_order_relaxed)};
  }

 private:
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint16_t> fault_{0};
  std::atomic<std::uint64_t> waiting_{0};
  std::atomic<bool> connected_{false};
};

/// One row.
struct Sample {
  std::uint64_t cycle = 0;
  std::uint64_t elapsed = 0;  ///< periods by the clock since the start
  std::vector<double> values{};
};

class SampleTap {
 public:
  /// `points`, by index into those of the door. `rows`: how many it holds. `counter` is told of rows that are lost.
  SampleTap(std::vector<std::size_t> points, std::uint64_t step, std::size_t rows, KeptCounter& counter)
      : points_(std::move(points)),
        step_(step),
        row_(points_.size()),
        ring_(rows * (sizeof(std::uint64_t) * 2 + sizeof(double) * points_.size())),
        counter_(&counter) {}

  /// On a virtual clock nothing is lost by a thread that is slower than the steps: they wait for it.
  void wait_for_reader(bool waits) noexcept { waits_.store(waits, std::memory_order_relaxed); }

  /// From the cyclic thread.
  void offer(std::uint64_t cycle, std::uint64_t elapsed, std::span<const double> published) noexcept {
    const std::uint64_t slot = elapsed / step_;
    if (slot == slot_) {
      return;
    }
    slot_ = slot;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      row_[i] = published[points_[i]];
    }
    const std::array<std::uint64_t, 2> head{cycle, elapsed};
    const std::array<std::span<const std::byte>, 2> parts{std::as_bytes(std::span(head)),
                                                          std::as_bytes(std::span(row_))};
    while (!ring_.push(parts)) {
      if (!waits_.load(std::memory_order_relaxed)) {
        counter_->add_lost(1);
        return;
      }
      std::this_thread::yield();
    }
  }

  /// From the reader: all rows that there are, behind those of `into`.
  void take(std::vector<Sample>& into) {
    taken_.clear();
    ring_.take(taken_);
    const std::size_t width = sizeof(double) * points_.size();
    for (std::size_t at = 0; at < taken_.size();) {
      Sample& row = into.emplace_back();
      row.values.resize(points_.size());
      for (void* const part : {static_cast<void*>(&row.cycle), static_cast<void*>(&row.elapsed)}) {
        std::memcpy(part, &taken_[at], sizeof(std::uint64_t));
        at += sizeof(std::uint64_t);
      }
      if (width > 0) {
        std::memcpy(row.values.data(), &taken_[at], width);
      }
      at += width;
    }
  }

  [[nodiscard]] std::span<const std::size_t> points() const noexcept { return points_; }
  [[nodiscard]] std::uint64_t step() const noexcept { return step_; }

 private:
  std::vector<std::size_t> points_;
  std::uint64_t step_;
  std::uint64_t slot_ = std::numeric_limits<std::uint64_t>::max();
  std::vector<double> row_;
  ByteRing ring_;
  std::vector<std::byte> taken_{};
  KeptCounter* counter_;
  std::atomic<bool> waits_{false};
};

}  // namespace hysteron::runtime
