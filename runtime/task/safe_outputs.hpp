// Outputs as they leave: within their limits and slew limits always, and safe when something is wrong.
//
// From the first cycle of a fault an output holds its last value for so many cycles; then it takes its safe value, or
// goes there by a ramp, or goes on holding. After a fault that ends by itself it returns to what the program wants,
// under its slew limit. The state is a few numbers by output, so that a guard can go on where a dead task stopped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace hysteron::runtime {

enum class Fault : std::uint8_t {
  none,
  hang,          ///< the step takes longer than the watchdog allows
  crash,         ///< the process is gone
  not_finite,    ///< an output is infinite or not a number; of that output alone
  stale_input,   ///< an input is older than it may be
  lost_link,     ///< a device does not answer
  missed_cycle,  ///< and the policy is to stop
  stop,          ///< the task ends as asked
  lost_client,   ///< the Modbus client that has to be heard is silent
  not_safe,      ///< at the end: an output cannot reach its safe value, since its ramp is lost in rounding
  lost_guard,    ///< the guard's process is gone, though its work was not done
  overload,      ///< the cyclic thread computes for more of the time than it may, and the policy is a fault
};
[[nodiscard]] std::string_view name_of(Fault fault);

enum class SafeAction : std::uint8_t { value, ramp, hold };

struct OutputSafety {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double slew = std::numeric_limits<double>::infinity();  ///< a second, both ways
  SafeAction action = SafeAction::value;
  std::uint64_t hold_cycles = 0;
  double value = 0.0;
  double ramp = std::numeric_limits<double>::infinity();  ///< a second
};

/// The safe value, or where it is outside of the limits, the limit.
[[nodiscard]] double safe_value(const OutputSafety& output) noexcept;

/// The longest time, in seconds, in which an output is safe from the first cycle of a fault on, from wherever it may
/// be: its hold, then its way at its ramp and slew limit. Infinite where it has a rate and no limits.
[[nodiscard]] double longest_way(const OutputSafety& output, double sample_time) noexcept;

class SafeOutputs {
 public:
  /// Begins at the safe values, or where they are outside of the limits, at the limit.
  SafeOutputs(std::vector<OutputSafety> outputs, double sample_time);

  /// Goes on from these values.
  void start_from(std::span<const double> values) noexcept;

  /// One cycle. With a fault, what is wanted does not count. An output whose wanted value is not finite is in the fault
  /// not_finite by itself.
  void step(std::span<const double> wanted, Fault fault) noexcept;

  [[nodiscard]] std::span<const double> values() const noexcept { return values_; }
  [[nodiscard]] Fault fault(std::size_t output) const noexcept { return faults_[output]; }
  /// Outputs that are not what is wanted, without a fault: low, high or slew holds them back in this cycle.
  [[nodiscard]] std::size_t held_back() const noexcept { return held_back_; }
  /// Any output's fault; none where there is none.
  [[nodiscard]] Fault worst() const noexcept;
  /// The output of that fault; behind the last where there is none.
  [[nodiscard]] std::size_t worst_output() const noexcept;
  /// Whether no output will move any more while the fault lasts.
  [[nodiscard]] bool settled() const noexcept;
  /// Whether an output is not safe and never will be: its next step towards the safe value is lost in rounding.
  [[nodiscard]] bool stuck() const noexcept;
  [[nodiscard]] const std::vector<OutputSafety>& safety() const noexcept { return outputs_; }

 private:
  [[nodiscard]] double target(std::size_t output) const noexcept;
  /// The value of an output in a fault, one cycle on.
  [[nodiscard]] double next(std::size_t output) const noexcept;

  std::vector<OutputSafety> outputs_;
  double sample_time_;
  std::vector<double> values_;
  std::vector<Fault> faults_;
  std::vector<std::uint64_t> since_;  ///< cycles in a fault
  std::size_t held_back_ = 0;
};

}  // namespace hysteron::runtime
