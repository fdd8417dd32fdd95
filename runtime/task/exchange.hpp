// Values handed between the cyclic thread and others, whole, without either side waiting for the other.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace hysteron::runtime {

/// The newest of a row of values, from one thread to one other: three buffers, of which each side owns one, and the
/// third changes hands. What is not taken before the next is published is lost.
template <class T>
class Latest {
 public:
  /// All three buffers begin as this; publishing and taking then allocate nothing that T does not.
  explicit Latest(const T& initial) : buffers_{initial, initial, initial} {}

  /// The writer's own buffer, to be filled.
  [[nodiscard]] T& filling() noexcept { return buffers_[writer_]; }
  /// Makes it the newest.
  void publish() noexcept {
    writer_ = middle_.exchange(static_cast<std::uint8_t>(writer_ | fresh), std::memory_order_acq_rel) & index;
  }
  /// Takes the newest; null where nothing came since the last time. Valid until the next call.
  [[nodiscard]] const T* take() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & fresh) == 0) {
      return nullptr;
    }
    reader_ = middle_.exchange(reader_, std::memory_order_acq_rel) & index;
    return &buffers_[reader_];
  }

 private:
  static constexpr std::uint8_t fresh = 4;
  static constexpr std::uint8_t index = 3;
  std::array<T, 3> buffers_;
  std::uint8_t writer_ = 0;
  std::atomic<std::uint8_t> middle_{1};
  std::uint8_t reader_ = 2;
};

/// Rows of numbers from one thread to any number of readers. A reader copies the newest and looks whether it was
/// overwritten meanwhile; there are several rows, so that it would have to sleep through as many cycles for that.
class SnapshotRing {
 public:
  explicit SnapshotRing(std::size_t width) : width_(width) {
    for (Row& row : rows_) {
      row.values = std::vector<std::atomic<double>>(width);
    }
  }

  void publish(std::uint64_t cycle, std::span<const double> values) noexcept {
    const std::uint64_t number = newest_.load(std::memory_order_relaxed) + 1;
    Row& row = rows_[number % rows_.size()];
    row.sequence.store(2 * number - 1, std::memory_order_relaxed);  // odd: being written
    std::atomic_thread_fence(std::memory_order_release);
    row.cycle.store(cycle, std::memory_order_relaxed);
    for (std::size_t i = 0; i < width_; ++i) {
      row.values[i].store(values[i], std::memory_order_relaxed);
    }
    row.sequence.store(2 * number, std::memory_order_release);
    newest_.store(number, std::memory_order_release);
  }

  /// The first values of the newest row, as many as asked for. False where nothing was published yet.
  bool read(std::uint64_t& cycle, std::span<double> values) const noexcept {
    for (;;) {
      const std::uint64_t number = newest_.load(std::memory_order_acquire);
      if (number == 0) {
        return false;
      }
      const Row& row = rows_[number % rows_.size()];
      const std::uint64_t before = row.sequence.load(std::memory_order_acquire);
      cycle = row.cycle.load(std::memory_order_relaxed);
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = row.values[i].load(std::memory_order_relaxed);
      }
      std::atomic_thread_fence(std::memory_order_acquire);
      if (before == 2 * number && row.sequence.load(std::memory_order_relaxed) == before) {
        return true;
      }
    }
  }

 private:
  struct Row {
    std::atomic<std::uint64_t> sequence{0};
    std::atomic<std::uint64_t> cycle{0};
    std::vector<std::atomic<double>> values{};
  };
  std::size_t width_;
  std::array<Row, 8> rows_{};
  std::atomic<std::uint64_t> newest_{0};
};

}  // namespace hysteron::runtime
