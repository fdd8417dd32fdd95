// Inputs and outputs on Modbus devices, each device served by a thread of its own, so that a dead one slows nobody.
//
// A value is a 64-bit float in four registers, the high word first. A connection that had an error or a late answer is
// closed: a late answer would be taken for that of the next request. It is opened again after a pause that doubles up
// to two seconds. On the virtual clock there are no threads: each cycle writes and reads in turn, so that a run
// repeats.
#pragma once

#include <modbus/modbus.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/task/field_io.hpp"
#include "runtime/task/output_device.hpp"

namespace hysteron::runtime {

/// One connection; every call is bounded by the device's timeout.
class DeviceLine {
 public:
  explicit DeviceLine(DeviceConfig device) : device_(std::move(device)) {}
  [[nodiscard]] bool connect();
  void close() noexcept { context_.reset(); }
  [[nodiscard]] bool connected() const noexcept { return context_ != nullptr; }
  [[nodiscard]] bool write(std::uint16_t address, double value);
  [[nodiscard]] bool read(std::uint16_t address, bool input_register, double& value);
  [[nodiscard]] const DeviceConfig& device() const { return device_; }

 private:
  struct Free {
    void operator()(modbus_t* context) const {
      modbus_close(context);
      modbus_free(context);
    }
  };
  DeviceConfig device_;
  std::unique_ptr<modbus_t, Free> context_;
};

class DeviceField final : public FieldIo {
 public:
  /// `in_turn`: without threads. Inputs are stale beyond their longest age, or where that is none, ten device cycles.
  DeviceField(const RunConfig& config, std::int64_t period, bool in_turn);
  ~DeviceField() override;
  DeviceField(const DeviceField&) = delete;
  DeviceField& operator=(const DeviceField&) = delete;

  Fault read(std::span<double> inputs) noexcept override;
  void write(std::span<const double> outputs) noexcept override;

 private:
  struct Value {
    std::size_t port = 0;
    DeviceLink link{};
    std::int64_t longest_age = 0;
    std::atomic<double> number{0.0};
    std::atomic<std::int64_t> time{0};  ///< of the last good exchange; 0: none yet
  };
  /// One exchange of everything with a device; false closes it.
  bool exchange(std::size_t device);
  void serve(std::size_t device);

  std::vector<std::unique_ptr<DeviceLine>> lines_;
  std::vector<std::unique_ptr<Value>> inputs_;
  std::vector<std::unique_ptr<Value>> outputs_;
  bool in_turn_;
  std::atomic<bool> has_outputs_{false};
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

/// The guard's own way to the outputs of all devices: it connects anew, from its own process.
class DeviceOutputs final : public OutputDevice {
 public:
  explicit DeviceOutputs(const RunConfig& config);
  void open() override {}
  bool write(std::span<const double> values) override;

 private:
  std::vector<std::unique_ptr<DeviceLine>> lines_;
  std::vector<std::optional<DeviceLink>> links_;
};

}  // namespace hysteron::runtime
