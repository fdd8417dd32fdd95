// Records of bytes from one thread to one other, in a ring of fixed size. A record that has no room is refused whole.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace hysteron::runtime {

class ByteRing {
 public:
  explicit ByteRing(std::size_t size) : bytes_(size) {}

  /// From the writer. The parts become one record. False where there is no room; nothing is written then.
  bool push(std::span<const std::span<const std::byte>> parts) noexcept {
    std::size_t length = 0;
    for (const auto& part : parts) {
      length += part.size();
    }
    const std::uint64_t end = end_.load(std::memory_order_relaxed);
    if (bytes_.size() - static_cast<std::size_t>(end - begin_.load(std::memory_order_acquire)) < length) {
      return false;
    }
    std::uint64_t at = end;
    for (const auto& part : parts) {
      copy_in(at, part);
      at += part.size();
    }
    end_.store(at, std::memory_order_release);
    return true;
  }

  /// From the reader: appends everything there is; whole records, since they become visible whole.
  void take(std::vector<std::byte>& into) {
    const std::uint64_t begin = begin_.load(std::memory_order_relaxed);
    const std::uint64_t end = end_.load(std::memory_order_acquire);
    for (std::uint64_t at = begin; at != end;) {
      const auto place = static_cast<std::size_t>(at % bytes_.size());
      const std::size_t count = std::min(bytes_.size() - place, static_cast<std::size_t>(end - at));
      into.insert(into.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(place),
                  bytes_.begin() + static_cast<std::ptrdiff_t>(place + count));
      at += count;
    }
    begin_.store(end, std::memory_order_release);
  }

 private:
  void copy_in(std::uint64_t at, std::span<const std::byte> part) noexcept {
    const auto place = static_cast<std::size_t>(at % bytes_.size());
    const std::size_t first = std::min(bytes_.size() - place, part.size());
    if (first > 0) {
      std::memcpy(bytes_.data() + place, part.data(), first);
    }
    if (part.size() > first) {
      std::memcpy(bytes_.data(), part.data() + first, part.size() - first);
    }
  }

  std::vector<std::byte> bytes_;
  std::atomic<std::uint64_t> begin_{0};
  std::atomic<std::uint64_t> end_{0};
};

}  // namespace hysteron::runtime
