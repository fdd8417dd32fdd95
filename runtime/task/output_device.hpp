// Where outputs go: a device behind a bus, or a page of memory in a test.
#pragma once

#include <span>

namespace hysteron::runtime {

class OutputDevice {
 public:
  OutputDevice() = default;
  OutputDevice(const OutputDevice&) = delete;
  OutputDevice& operator=(const OutputDevice&) = delete;
  virtual ~OutputDevice() = default;

  /// Called once in the process that will write, before the first write: opens what a fork must not share.
  virtual void open() = 0;
  /// All outputs, in the order of the diagram. False where the device did not take them; it is tried again.
  virtual bool write(std::span<const double> values) = 0;
  /// From the guard, once: the task's process is gone, and nobody else writes.
  virtual void task_is_gone() noexcept {}
};

}  // namespace hysteron::runtime
