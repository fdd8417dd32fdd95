// Inputs and outputs on Modbus devices, each device served by a thread of its own, so that a dead one slows nobody.
//
// The cycle takes the newest values and leaves its outputs, and waits for nothing. On the virtual clock there are no
// threads: each cycle writes and reads in turn, so that a run repeats.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/config/output_claims.hpp"
#include "runtime/config/run_config.hpp"
#include "runtime/modbus/device.hpp"
#include "runtime/task/field_io.hpp"
#include "runtime/task/output_device.hpp"

namespace hysteron::runtime {

/// What is said of each device: its link, and what went wrong on it.
[[nodiscard]] std::vector<Point> device_points(const RunConfig& config);

class DeviceField final : public FieldIo {
 public:
  /// `in_turn`: without threads. `may_write` is asked before every write to a device: a guard that has taken over must
  /// not be written over.
  DeviceField(const RunConfig& config, bool in_turn, const std::function<bool()>& may_write = {});

  /// lost_link where a device has not been reached for as long as a value may be old, stale_input where it was reached
  /// and refuses the value. Before that a value keeps its last number.
  Fault read(std::span<double> inputs) noexcept override;
  [[nodiscard]] bool is_awaited() const noexcept override { return is_awaited_; }
  [[nodiscard]] std::uint64_t not_taken() const noexcept override;
  void count(std::span<double> into) const noexcept override;
  [[nodiscard]] std::size_t faulty_port() const noexcept override { return faulty_port_; }
  [[nodiscard]] std::size_t absent() const noexcept override;
  [[nodiscard]] std::vector<std::string> absent_devices() const override;
  void write(std::span<const double> outputs) noexcept override;
  /// In turn, it is tried once.
  Delivery delivery() noexcept override;

 private:
  [[nodiscard]] modbus::RemoteReading reading_of(const DeviceLink& link) const noexcept;
  [[nodiscard]] Fault fault_of(const DeviceLink& link, const modbus::RemoteReading& reading) const noexcept;
  void rounds() noexcept;
  [[nodiscard]] bool has_answered(std::size_t device) const noexcept;
  /// Whether a value that was never good is still within the time of its first exchange.
  [[nodiscard]] bool has_time(std::size_t device, const modbus::RemoteReading& reading) const noexcept;
  /// Has never answered, and may be left out.
  [[nodiscard]] bool is_absent(std::size_t device) const noexcept;

  std::vector<std::string> names_{};                        ///< of the devices
  std::vector<bool> may_be_absent_{};                       ///< by device
  std::vector<std::chrono::nanoseconds> first_exchange_{};  ///< by device: the time that it has
  std::vector<DeviceInput> inputs_;
  std::vector<DeviceOutput> outputs_;
  std::vector<std::unique_ptr<modbus::Device>> devices_;
  std::size_t input_count_;  ///< of the diagram
  std::size_t faulty_port_ = no_port;
  std::int64_t period_;  ///< of the task
  bool in_turn_;
  bool is_awaited_ = false;
  std::vector<std::vector<std::int64_t>> rounds_since_good_;  ///< in turn, where only rounds count as time
  std::vector<double> written_;                               ///< by output on a device
};

/// The guard's own way to the outputs of all devices. It connects from its own process, and only once it has something
/// to write: a device may have room for one connection alone.
class DeviceOutputs final : public OutputDevice {
 public:
  /// The claims, if any, must outlive it.
  explicit DeviceOutputs(const RunConfig& config, OutputClaims* claims = nullptr);
  void open() override {}
  void task_is_gone() noexcept override;
  /// True once every device has taken these values.
  bool write(std::span<const double> values) override;

 private:
  std::vector<modbus::DeviceOptions> options_;  ///< with what is written alone
  std::vector<DeviceOutput> outputs_;
  std::vector<std::unique_ptr<modbus::Device>> devices_;
  OutputClaims* claims_;
};

}  // namespace hysteron::runtime
