// A process that retains as fast as it can and is killed at any moment: what can be recovered afterwards. And every
// damage to a slot.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "runtime/task/retain.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/killed_writer.hpp"

namespace hysteron::runtime::test {

/// The newest number that the child has seen on the disk, and what was recovered.
struct KillResult {
  std::uint64_t confirmed = 0;
  std::uint64_t recovered = 0;
  bool consistent = false;  ///< state and parameters of one moment
};

/// Each state that is retained is its own sequence number, so that what comes back can be judged.
inline KillResult kill_while_retaining(const std::filesystem::path& folder, std::int64_t after) {
  const auto write = [&](const auto& tell) {
    RetainFolder files(folder);
    const Recovery start = recover(files, "accumulator", MismatchPolicy::refuse);
    std::uint64_t number = start.sequence;
    std::size_t slot = start.next_slot;
    for (;;) {
      ++number;
      RetainedValues values{.sequence = number, .layout = "accumulator"};
      values.parameters = {static_cast<double>(number), -static_cast<double>(number)};
      values.state.assign(20'000, static_cast<std::byte>(number & 0xFF));
      if (!files.write(slot, encode_slot(values)).empty()) {
        return;
      }
      tell(number);
      slot = 1 - slot;
    }
  };
  // From the first slot on, so that a slow machine kills no child that has not begun.
  KillResult result;
  result.confirmed = told_before_kill<std::uint64_t>(1, std::chrono::nanoseconds(after), write).value_or(0);
  RetainFolder files(folder);
  const Recovery recovery = recover(files, "accumulator", MismatchPolicy::refuse);
  result.recovered = recovery.sequence;
  result.consistent = recovery.refused.empty() && (recovery.sequence == 0 || recovery.values.has_value());
  if (recovery.values) {
    const auto& values = *recovery.values;
    result.consistent = values.parameters[0] == static_cast<double>(values.sequence) &&
                        values.parameters[1] == -values.parameters[0] &&
                        values.state == std::vector<std::byte>(20'000, static_cast<std::byte>(values.sequence & 0xFF));
  }
  return result;
}

struct Damage {
  std::uint64_t tried = 0;
  std::uint64_t taken = 0;  ///< damaged slots that were taken for whole ones
};

/// Every truncation and every single-bit flip of a slot.
inline Damage damage(const std::vector<std::byte>& slot) {
  Damage result;
  const auto look = [&](std::span<const std::byte> bytes) {
    ++result.tried;
    result.taken += decode_slot(bytes).status == SlotStatus::broken ? 0 : 1;
  };
  for (std::size_t length = 0; length < slot.size(); ++length) {
    look(std::span(slot).first(length));
  }
  for (std::size_t bit = 0; bit < 8 * slot.size(); ++bit) {
    auto flipped = slot;
    flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    look(flipped);
  }
  return result;
}

}  // namespace hysteron::runtime::test
