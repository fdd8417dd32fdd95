// The faults of a task as they come and go: counted, and the newest kept with what it is of. For readers of any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "runtime/task/exchange.hpp"
#include "runtime/task/safe_outputs.hpp"

namespace hysteron::runtime {

/// Of a fault that is not of one input or output.
inline constexpr std::size_t no_port = std::numeric_limits<std::uint32_t>::max();

struct FaultReport {
  Fault fault = Fault::none;   ///< that holds
  Fault last = Fault::none;    ///< the newest that began, over or not
  std::size_t port = no_port;  ///< that the newest is of: of the inputs, and then of the outputs
  std::uint64_t count = 0;     ///< that began
  friend bool operator==(const FaultReport&, const FaultReport&) = default;
};

class FaultLog {
 public:
  /// From the cyclic thread: what holds now. Another fault, or the same of another port, has begun.
  void note(Fault fault, std::size_t port = no_port) noexcept {
    if (fault == newest_.fault && (fault == Fault::none || port == newest_.port)) {
      return;
    }
    newest_.fault = fault;
    if (fault != Fault::none) {
      newest_ = {.fault = fault, .last = fault, .port = port, .count = newest_.count + 1};
    }
    told_.publish(newest_.count, std::array{static_cast<double>(newest_.fault), static_cast<double>(newest_.last),
                                            static_cast<double>(newest_.port)});
  }
  /// For the cyclic thread.
  [[nodiscard]] const FaultReport& newest() const noexcept { return newest_; }
  /// From any thread.
  [[nodiscard]] FaultReport report() const noexcept {
    FaultReport report;
    std::array<double, 3> told{};
    if (told_.read(report.count, told)) {
      report.fault = static_cast<Fault>(told[0]);
      report.last = static_cast<Fault>(told[1]);
      report.port = static_cast<std::size_t>(told[2]);
    }
    return report;
  }

 private:
  FaultReport newest_{};
  SnapshotRing told_{3};
};

}  // namespace hysteron::runtime
