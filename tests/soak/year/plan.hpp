// What happens to the plant in its time, and when: drawn by a seed before the first cycle.
#pragma once

#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace hysteron::soak {

enum class Happening : std::uint8_t {
  PowerCut,        ///< at a byte of what is written next
  CutWithCommit,   ///< the same, while a client commits
  Kill,            ///< of the process alone: what it wrote is the system's
  Restart,         ///< an orderly stop, and a start with an edited diagram
  OnlineChange,    ///< to an edited diagram
  RefusedChange,   ///< to one with which an output would jump
  Commit,          ///< of two parameters that belong together
  DeviceLost,      ///< for a while
  SensorBroken,    ///< gives no number for a while
  LateWake,        ///< of the cyclic thread
  Overload,        ///< a cycle computes for too long
  DiskFull,        ///< for a while
  ClockStep,       ///< the wall clock is wrong for a while
  NewCertificate,  ///< the operator writes one
};
constexpr std::size_t happening_count = 14;

struct Event {
  std::int64_t at = 0;  ///< in nanoseconds from the begin of the span
  Happening what{};
  std::int64_t lasts = 0;
  std::uint64_t number = 0;  ///< whatever the event draws
};

struct PlanSettings {
  std::int64_t span = 0;
  std::int64_t period = 0;
  std::uint64_t seed = 0;
  double density = 1.0;  ///< 1: as in docs/runtime-results.md for a year
};

struct Certificate {
  std::int64_t from = 0;  ///< on the wall clock, from the begin of the span
  std::int64_t until = 0;
  std::int64_t written = 0;  ///< when the operator writes it
};

struct Plan {
  PlanSettings settings{};
  std::vector<Event> events{};  ///< by time
  std::vector<Certificate> certificates{};
};

[[nodiscard]] Plan make_plan(const PlanSettings& settings);
[[nodiscard]] std::string_view name_of(Happening what);

}  // namespace hysteron::soak
