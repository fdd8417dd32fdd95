#include "runtime/config/device_field.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <new>
#include <string>
#include <utility>

namespace hysteron::runtime {
namespace {

using modbus::DeviceStatus;
using modbus::Quality;
using modbus::RemoteReading;
using std::chrono::nanoseconds;

struct DeviceCount {
  const char* name = "";
  const char* meaning = "";
  std::uint64_t DeviceStatus::*count = nullptr;  ///< none: the state of the link
};

constexpr std::array device_counts{
    DeviceCount{
        "link",
        "0 connecting, 1 running, 2 waiting to connect again, 3 never answered, and the task goes on without it"},
    DeviceCount{"connections", "links that were opened: the first, and one for each reconnect",
                &DeviceStatus::connections},
    DeviceCount{"unreachable", "attempts to open a link that failed", &DeviceStatus::no_link},
    DeviceCount{"closed", "links that the device ended", &DeviceStatus::closed},
    DeviceCount{"answers", "requests that were answered", &DeviceStatus::answers},
    DeviceCount{"exceptions", "requests that the device refused", &DeviceStatus::exceptions},
    DeviceCount{"timeouts", "requests without a whole answer in time", &DeviceStatus::timeouts},
    DeviceCount{"wrong_answers", "answers that were not of their request", &DeviceStatus::wrong_answers},
    DeviceCount{"bad_checksums", "answers with a wrong checksum, on a serial line", &DeviceStatus::bad_checksums},
};

/// A connection and an answer, as long as each may take. Beyond this a fault is told, however long that is.
constexpr std::chrono::milliseconds longest_first_exchange{1000};

double seconds(nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

std::vector<Point> device_points(const RunConfig& config) {
  std::vector<Point> points;
  for (const modbus::DeviceOptions& device : config.devices) {
    for (const DeviceCount& one : device_counts) {
      const bool counts = one.count != nullptr;
      points.push_back({.name = std::string("device.") + device.name + "." + one.name,
                        .kind = PointKind::status,
                        .type = counts ? PointType::uint64 : PointType::uint16,
                        .unit = "1",
                        .meaning = one.meaning,
                        .counts = counts,
                        .comes_last = true});
    }
  }
  return points;
}

DeviceField::DeviceField(const RunConfig& config, bool in_turn, const std::function<bool()>& may_write)
    : inputs_(config.device_inputs),
      outputs_(config.device_outputs),
      input_count_(config.task.inputs.size()),
      period_(config.task.loop.period),
      in_turn_(in_turn),
      written_(outputs_.size()) {
  const auto links = modbus::shared_links(config.devices);
  for (std::size_t i = 0; i < config.devices.size(); ++i) {
    devices_.push_back(std::make_unique<modbus::Device>(
        config.devices[i], modbus::DeviceWork{.own_thread = !in_turn, .may_write = may_write, .link = links[i]}));
    rounds_since_good_.emplace_back(config.devices[i].values.size());
    names_.push_back(config.devices[i].name);
    may_be_absent_.push_back(config.devices[i].may_be_absent);
    first_exchange_.emplace_back(std::min(2 * config.devices[i].response, longest_first_exchange));
  }
}

RemoteReading DeviceField::reading_of(const DeviceLink& link) const noexcept {
  RemoteReading reading = devices_[link.device]->read(link.value);
  if (in_turn_) {
    reading.age = nanoseconds(rounds_since_good_[link.device][link.value] * period_);
    reading.quality = reading.quality == Quality::old ? Quality::good : reading.quality;
  }
  return reading;
}

bool DeviceField::has_answered(std::size_t device) const noexcept {
  const DeviceStatus status = devices_[device]->status();
  return status.answers != 0 || status.exceptions != 0;
}

bool DeviceField::has_time(std::size_t device, const RemoteReading& reading) const noexcept {
  return !in_turn_ && reading.quality == Quality::never && reading.age <= first_exchange_[device];
}

bool DeviceField::is_absent(std::size_t device) const noexcept {
  return may_be_absent_[device] && !has_answered(device);
}

std::size_t DeviceField::absent() const noexcept {
  std::size_t count = 0;
  for (std::size_t device = 0; device < devices_.size(); ++device) {
    // A device without values is never asked.
    const bool is_asked = !rounds_since_good_[device].empty();
    count += is_asked && !has_answered(device) && !has_time(device, devices_[device]->read(0)) ? 1 : 0;
  }
  return count;
}

std::vector<std::string> DeviceField::absent_devices() const {
  std::vector<std::string> names;
  for (std::size_t device = 0; device < devices_.size(); ++device) {
    if (is_absent(device)) {
      names.push_back(names_[device]);
    }
  }
  return names;
}

Fault DeviceField::fault_of(const DeviceLink& link, const RemoteReading& reading) const noexcept {
  if (is_absent(link.device)) {
    return Fault::none;
  }
  // In turn, a value is of this cycle, or there is none.
  const bool is_fresh =
      in_turn_ ? reading.quality == Quality::good
               : reading.quality != Quality::never && reading.age <= devices_[link.device]->longest_age(link.value);
  return is_fresh ? Fault::none : reading.quality == Quality::refused ? Fault::stale_input : Fault::lost_link;
}

void DeviceField::rounds() noexcept {
  for (std::size_t device = 0; device < devices_.size(); ++device) {
    (void)devices_[device]->round();
    for (std::size_t value = 0; value < rounds_since_good_[device].size(); ++value) {
      std::int64_t& rounds = rounds_since_good_[device][value];
      const Quality quality = devices_[device]->read(value).quality;
      rounds = quality == Quality::good || quality == Quality::old ? 0 : rounds + 1;
    }
  }
}

Fault DeviceField::read(std::span<double> inputs) noexcept {
  if (in_turn_) {
    rounds();
  }
  Fault fault = Fault::none;
  is_awaited_ = false;
  const auto note = [&](const DeviceLink& link, const RemoteReading& reading, std::size_t port) {
    const Fault found = fault_of(link, reading);
    const bool is_awaited = has_time(link.device, reading);
    if (found != Fault::none && (fault == Fault::none || (is_awaited_ && !is_awaited))) {
      fault = found;
      faulty_port_ = port;
      is_awaited_ = is_awaited;
    }
  };
  for (const DeviceInput& input : inputs_) {
    const RemoteReading reading = reading_of(input.link);
    switch (input.tells) {
      case Tells::value:
        if (reading.quality != Quality::never) {
          inputs[input.port] = reading.value;
        }
        if (input.link.faults) {
          note(input.link, reading, input.port);
        }
        break;
      case Tells::age:
        inputs[input.port] = seconds(reading.age);
        break;
      case Tells::quality:
        inputs[input.port] = static_cast<double>(reading.quality);
        break;
    }
  }
  for (const DeviceOutput& output : outputs_) {
    const RemoteReading reading = reading_of(output.link);
    // In the first cycle in turn nothing has been written yet.
    if (output.link.faults && !(in_turn_ && reading.quality == Quality::never)) {
      note(output.link, reading, input_count_ + output.port);
    }
  }
  return fault;
}

std::uint64_t DeviceField::not_taken() const noexcept {
  std::uint64_t count = 0;
  for (const auto& device : devices_) {
    count += device->not_taken();
  }
  return count;
}

void DeviceField::count(std::span<double> into) const noexcept {
  auto at = into.begin();
  for (std::size_t device = 0; device < devices_.size(); ++device) {
    const DeviceStatus status = devices_[device]->status();
    const double state = is_absent(device) ? 3.0 : static_cast<double>(status.state);
    for (const DeviceCount& one : device_counts) {
      *at++ = one.count == nullptr ? state : static_cast<double>(status.*one.count);
    }
  }
}

void DeviceField::write(std::span<const double> outputs) noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    written_[i] = outputs[outputs_[i].port];
    devices_[outputs_[i].link.device]->write(outputs_[i].link.value, written_[i]);
  }
}

Delivery DeviceField::delivery() noexcept {
  if (in_turn_) {
    rounds();
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const DeviceLink& link = outputs_[i].link;
    if (is_absent(link.device)) {
      continue;  // it never had a value of this task
    }
    const RemoteReading reading = reading_of(link);
    const bool is_taken = in_turn_ ? reading.quality == Quality::good && reading.value == written_[i]
                                   : devices_[link.device]->has_taken(link.value, written_[i]);
    if (!is_taken) {
      faulty_port_ = input_count_ + outputs_[i].port;
      return in_turn_ ? Delivery::failed : Delivery::pending;
    }
  }
  return Delivery::done;
}

DeviceOutputs::DeviceOutputs(const RunConfig& config, OutputClaims* claims)
    : options_(config.devices), outputs_(config.device_outputs), claims_(claims) {
  for (modbus::DeviceOptions& device : options_) {
    device.values.clear();
  }
  for (DeviceOutput& output : outputs_) {
    auto& values = options_[output.link.device].values;
    values.push_back(config.devices[output.link.device].values[output.link.value]);
    output.link.value = values.size() - 1;
  }
}

void DeviceOutputs::task_is_gone() noexcept {
  if (claims_ != nullptr) {
    try {
      claims_->guard_listens();
    } catch (const std::bad_alloc&) {
      return;  // who starts then takes this guard for a task, and waits
    }
  }
}

bool DeviceOutputs::write(std::span<const double> values) {
  if (devices_.empty()) {
    const auto links = modbus::shared_links(options_);
    for (std::size_t i = 0; i < options_.size(); ++i) {
      devices_.push_back(options_[i].values.empty()
                             ? nullptr
                             : std::make_unique<modbus::Device>(options_[i], modbus::DeviceWork{.link = links[i]}));
    }
  }
  bool all = true;
  for (const DeviceOutput& output : outputs_) {
    modbus::Device& device = *devices_[output.link.device];
    device.write(output.link.value, values[output.port]);
    all = device.has_taken(output.link.value, values[output.port]) && all;
  }
  return all;
}

}  // namespace hysteron::runtime
