// One life of the task: from a start of the host until what the plan has for its end.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/task/step_program.hpp"
#include "tests/soak/year/ledger.hpp"
#include "tests/soak/year/plan.hpp"
#include "tests/soak/year/plant.hpp"

namespace hysteron::soak {

struct CertificateFiles {
  std::string certificate{};
  std::string key{};
};

struct Stage {
  Plan plan{};
  PlantFiles files{};
  std::int64_t quantum = 0;  ///< see SimulatedTime
  std::vector<CertificateFiles> certificates{};
  /// The diagram in one of its versions.
  std::function<std::unique_ptr<runtime::StepProgram>(std::uint64_t version)> program{};
  std::string how{};
};

/// What the clocks of the plant say at its begin: monotonic time, and UTC beyond it.
constexpr std::int64_t monotonic_begin = 1'000'000'000'000;
constexpr std::int64_t utc_ahead = 1'798'761'600'000'000'000 - monotonic_begin;  // 2027-01-01

/// From a time of the plan on, in a process that may die of it. True where it ended as it was asked to.
[[nodiscard]] bool live(const Stage& stage, Ledger& ledger, std::int64_t from);

}  // namespace hysteron::soak
