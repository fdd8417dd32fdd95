// What the process of a task and its plant write down while they live, in memory that outlives them.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "tests/soak/year/plan.hpp"

namespace hysteron::soak {

struct Ledger {
  // Of this life.
  std::int64_t now = 0;
  std::int64_t first_due = 0;      ///< of the first cycle; 0: there was none
  std::uint64_t cycles = 0;        ///< that the plant saw
  std::uint64_t skipped = 0;       ///< periods that passed without one, as they were brought about
  std::uint64_t history_rows = 0;  ///< said to be on the disk
  bool has_begun = false;
  bool ends_orderly = false;  ///< was asked to, with nothing wrong
  bool was_full = false;      ///< the disk
  Happening end{};            ///< what is to end it

  // Of all lives.
  std::array<std::uint64_t, happening_count> happened{};
  std::uint64_t skipped_late = 0;
  std::uint64_t skipped_overload = 0;
  std::uint64_t proposed = 0;   ///< the newest set of parameters that was asked for
  std::uint64_t confirmed = 0;  ///< the newest that was said to be on the disk
  std::uint64_t confirmations = 0;
  double uptime = 0.0;        ///< seconds of cycles, newest
  bool knows_uptime = false;  ///< by the life before
  double uptime_kept = 0.0;   ///< that must come back after a power cut
  std::uint64_t version = 0;  ///< of the diagram on the disk
  std::uint64_t changed = 0;
  std::uint64_t not_changed = 0;  ///< online changes that should have been and were not
  std::uint64_t jumps_refused = 0;
  std::uint64_t jumps_taken = 0;
  std::uint64_t begun_full = 0;    ///< starts while the disk was full
  std::uint64_t full_noticed = 0;  ///< times of a full disk in which a write failed
  std::uint64_t certificate_ends = 0;
  std::int64_t longest_to_safety = 0;

  // What must not be: how often.
  std::uint64_t lost_sets = 0;
  std::uint64_t torn_sets = 0;
  std::uint64_t lost_uptime = 0;
  std::uint64_t unsafe = 0;         ///< cycles in which an output was unsafe for longer than it may
  std::uint64_t out_of_range = 0;   ///< outputs beyond their limits, or no number
  std::uint64_t not_back = 0;       ///< times that the control did not come back after a fault
  std::uint64_t wrong_account = 0;  ///< looks at which the task's counts were not those of the plant
  std::uint64_t wrong_certificate = 0;
  std::uint64_t confirmed_in_vain = 0;  ///< sets confirmed while no byte could be written
};

}  // namespace hysteron::soak
