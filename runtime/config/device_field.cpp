#include "runtime/config/device_field.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <ctime>
#include <utility>

#include "runtime/task/clock.hpp"

namespace hysteron::runtime {

bool DeviceLine::connect() {
  std::unique_ptr<modbus_t, Free> context(modbus_new_tcp(device_.host.c_str(), device_.port));
  const auto seconds = static_cast<std::uint32_t>(device_.timeout / 1'000'000'000);
  const auto rest = static_cast<std::uint32_t>(device_.timeout % 1'000'000'000 / 1000);
  if (context == nullptr || modbus_set_response_timeout(context.get(), seconds, rest) != 0 ||
      modbus_set_byte_timeout(context.get(), seconds, rest) != 0 ||
      modbus_set_slave(context.get(), device_.unit) != 0 || modbus_connect(context.get()) != 0) {
    return false;
  }
  context_ = std::move(context);
  return true;
}

bool DeviceLine::write(std::uint16_t address, double value) {
  // The library's own setters of floats fail the round trip with its getters in Debian 12.
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::array<std::uint16_t, 4> words{static_cast<std::uint16_t>(bits >> 48),
                                           static_cast<std::uint16_t>(bits >> 32),
                                           static_cast<std::uint16_t>(bits >> 16), static_cast<std::uint16_t>(bits)};
  return modbus_write_registers(context_.get(), address, 4, words.data()) == 4;
}

bool DeviceLine::read(std::uint16_t address, bool input_register, double& value) {
  std::array<std::uint16_t, 4> words{};
  const int count = input_register ? modbus_read_input_registers(context_.get(), address, 4, words.data())
                                   : modbus_read_registers(context_.get(), address, 4, words.data());
  std::uint64_t bits = 0;
  for (const std::uint16_t word : words) {
    bits = bits << 16 | word;
  }
  value = std::bit_cast<double>(bits);
  return count == 4;
}

DeviceField::DeviceField(const RunConfig& config, std::int64_t period, bool in_turn) : in_turn_(in_turn) {
  for (const DeviceConfig& device : config.devices) {
    lines_.push_back(std::make_unique<DeviceLine>(device));
  }
  const auto add = [&](std::size_t port, const std::optional<DeviceLink>& link, std::uint64_t cycles, auto& into) {
    if (link) {
      into.push_back(std::make_unique<Value>());
      into.back()->port = port;
      into.back()->link = *link;
      into.back()->longest_age =
          cycles > 0 ? static_cast<std::int64_t>(cycles) * period : 10 * config.devices[link->device].cycle;
    }
  };
  for (std::size_t i = 0; i < config.input_links.size(); ++i) {
    add(i, config.input_links[i], config.task.inputs[i].longest_age, inputs_);
  }
  for (std::size_t i = 0; i < config.output_links.size(); ++i) {
    add(i, config.output_links[i], 0, outputs_);
  }
  for (std::size_t i = 0; i < lines_.size() && !in_turn; ++i) {
    threads_.emplace_back([this, i] { serve(i); });
  }
}

DeviceField::~DeviceField() {
  stop_.store(true);
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

bool DeviceField::exchange(std::size_t device) {
  DeviceLine& line = *lines_[device];
  for (const auto& output : outputs_) {
    if (output->link.device == device && has_outputs_.load(std::memory_order_acquire) &&
        !line.write(output->link.address, output->number.load(std::memory_order_relaxed))) {
      return false;
    }
    if (output->link.device == device) {
      output->time.store(monotonic_now(), std::memory_order_relaxed);
    }
  }
  for (const auto& input : inputs_) {
    double value = 0.0;
    if (input->link.device != device) {
      continue;
    }
    if (!line.read(input->link.address, input->link.input_register, value)) {
      return false;
    }
    input->number.store(value, std::memory_order_relaxed);
    input->time.store(monotonic_now(), std::memory_order_release);
  }
  return true;
}

void DeviceField::serve(std::size_t device) {
  constexpr std::int64_t longest_pause = 2'000'000'000;
  DeviceLine& line = *lines_[device];
  const std::int64_t cycle = line.device().cycle;
  std::int64_t pause = 50'000'000;
  std::int64_t next = monotonic_now();
  while (!stop_.load(std::memory_order_relaxed)) {
    if ((line.connected() || line.connect()) && exchange(device)) {
      pause = 50'000'000;
      next = std::max(next + cycle, monotonic_now());
    } else {
      line.close();
      next = monotonic_now() + pause;
      pause = std::min(2 * pause, longest_pause);
    }
    while (!stop_.load(std::memory_order_relaxed) && monotonic_now() < next) {
      std::this_thread::sleep_for(std::chrono::nanoseconds(std::min<std::int64_t>(next - monotonic_now(), 20'000'000)));
    }
  }
  // What the task wrote last, its safe values, still has to arrive.
  if (line.connected()) {
    (void)exchange(device);
  }
}

Fault DeviceField::read(std::span<double> inputs) noexcept {
  Fault fault = Fault::none;
  const std::int64_t now = monotonic_now();
  if (in_turn_) {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!((lines_[i]->connected() || lines_[i]->connect()) && exchange(i))) {
        lines_[i]->close();
        fault = Fault::lost_link;
      }
    }
  }
  for (const auto& input : inputs_) {
    const std::int64_t time = input->time.load(std::memory_order_acquire);
    if (time != 0) {
      inputs[input->port] = input->number.load(std::memory_order_relaxed);
    }
    if (!in_turn_ && (time == 0 || now - time > input->longest_age)) {
      fault = Fault::lost_link;
    }
  }
  for (const auto& output : outputs_) {
    const std::int64_t time = output->time.load(std::memory_order_relaxed);
    if (!in_turn_ && (time == 0 || now - time > output->longest_age)) {
      fault = Fault::lost_link;
    }
  }
  return fault;
}

void DeviceField::write(std::span<const double> outputs) noexcept {
  for (const auto& output : outputs_) {
    output->number.store(outputs[output->port], std::memory_order_relaxed);
  }
  has_outputs_.store(true, std::memory_order_release);
}

DeviceOutputs::DeviceOutputs(const RunConfig& config) : links_(config.output_links) {
  for (const DeviceConfig& device : config.devices) {
    lines_.push_back(std::make_unique<DeviceLine>(device));
  }
}

bool DeviceOutputs::write(std::span<const double> values) {
  bool all = true;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (!links_[i]) {
      continue;
    }
    DeviceLine& line = *lines_[links_[i]->device];
    if (!((line.connected() || line.connect()) && line.write(links_[i]->address, values[i]))) {
      line.close();
      all = false;
    }
  }
  return all;
}

}  // namespace hysteron::runtime
