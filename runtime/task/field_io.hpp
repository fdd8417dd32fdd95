// The field as the task sees it: inputs that devices give, outputs that devices take.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/task/fault_log.hpp"
#include "runtime/task/safe_outputs.hpp"

namespace hysteron::runtime {

enum class Delivery : std::uint8_t { pending, done, failed };

/// read() and write() wait for no device: they hand over to a thread that does.
class FieldIo {
 public:
  FieldIo() = default;
  FieldIo(const FieldIo&) = delete;
  FieldIo& operator=(const FieldIo&) = delete;
  virtual ~FieldIo() = default;

  /// Sets the inputs that devices give, and no others. A lost link or an old value is said by the fault.
  virtual Fault read(std::span<double> inputs) noexcept = 0;
  /// Whether the fault that read() gave last is of values alone whose first exchange still has time: outputs are safe
  /// meanwhile, and no fault has begun.
  [[nodiscard]] virtual bool is_awaited() const noexcept { return false; }
  /// Values that devices gave and that were not taken, since the start.
  [[nodiscard]] virtual std::uint64_t not_taken() const noexcept { return 0; }
  /// The values of the points of TaskSettings::field_points.
  virtual void count(std::span<double> /*into*/) const noexcept {}
  /// Whose value the fault is that read() or delivery() gave last: of the inputs, and then of the outputs.
  [[nodiscard]] virtual std::size_t faulty_port() const noexcept { return no_port; }
  /// From any thread: devices that have never answered, and have had the time to.
  [[nodiscard]] virtual std::size_t absent() const noexcept { return 0; }
  /// By name, those that have never answered and that the task goes on without. Not for the cyclic thread.
  [[nodiscard]] virtual std::vector<std::string> absent_devices() const { return {}; }
  virtual void write(std::span<const double> outputs) noexcept = 0;
  /// Whether the devices have taken what was written last. Asked at the end, when nobody tries on.
  virtual Delivery delivery() noexcept { return Delivery::done; }
};

}  // namespace hysteron::runtime
