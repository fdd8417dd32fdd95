#include "runtime/config/device_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <utility>

#include "runtime/config/format_reader.hpp"
#include "runtime/config/line_reader.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::runtime {
namespace {

using Words = std::string_view;
constexpr std::array<modbus::Area, 4> areas{modbus::Area::holding_register, modbus::Area::input_register,
                                            modbus::Area::coil, modbus::Area::discrete_input};
constexpr std::array<modbus::Area, 2> written_areas{modbus::Area::holding_register, modbus::Area::coil};
constexpr std::array<Words, 3> network_keys{"host", "port", "connection"};
constexpr std::array<Words, 8> value_keys{"register", "area",       "type", "scale",
                                          "offset",   "word_order", "bit",  "on_loss"};

}  // namespace

void DeviceReader::wrong(Place place, const std::string& cause, const std::string& mend) {
  found_->error(error::wrong_run_value, std::move(place), cause, mend);
}

void DeviceReader::read_device(const std::string& name, TomlReader table) {
  modbus::DeviceOptions device{.name = name};
  const auto is_plain = [](char c) { return c == '_' || c == '-' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
  if (!std::ranges::all_of(name, is_plain)) {
    wrong(table.place(), "The device " + name + " has a name that no register map can list.",
          "name it by letters, digits, _ and -.");
  }
  std::size_t sharing = 0;
  table.read_choice("connection", sharing);
  device.shares_connection = sharing == 1;
  const modbus::SerialLink line = read_line(table, *found_);
  if (line.path.empty()) {
    modbus::TcpLink link;
    table.read("host", link.host);
    table.read_whole("port", link.port);
    device.link = std::move(link);
  } else {
    for (const Words key : network_keys) {
      if (table.has(key)) {
        wrong(table.place(key), "The device is on a serial line and has a " + std::string(key) + " besides.",
              "remove the key, or serial.");
      }
    }
    device.link = line;
  }
  table.read_whole("unit", device.unit);
  const bool is_serial = !line.path.empty();
  if ((device.unit > 247 && device.unit < 255) || (is_serial && (device.unit == 0 || device.unit == 255))) {
    found_->error(error::run_value_out_of_range, table.place("unit"),
                  "No device is the unit " + std::to_string(device.unit) + (is_serial ? " on a serial line." : "."),
                  is_serial ? "choose 1 to 247; 0 is all units, and none answers."
                            : "choose 0 to 247; or 255, of a device that is no gateway.");
  }
  std::size_t order = 0;
  table.read_choice("word_order", order);
  orders_.push_back(modbus::word_orders.at(order));
  std::size_t absence = 0;
  table.read_choice("on_absence", absence);
  device.may_be_absent = absence == 1;
  table.read_duration("cycle", device.period);
  table.read_duration("timeout", device.response);
  config_->devices.push_back(std::move(device));
}

bool DeviceReader::read_place(modbus::RemoteValue& value, modbus::WordOrder usual, TomlReader& table) {
  std::size_t area = 0;
  table.read_choice("area", area);
  value.at.area = value.written ? written_areas.at(area) : areas.at(area);
  value.at.bit = read_bit(table);
  table.read_whole("register", value.at.address);
  const auto given = read_format(table).value_or(modbus::GivenFormat{});
  const bool is_bit = value.at.is_boolean();
  value.format = given.or_else(is_bit ? PointType::boolean : PointType::real64, usual);
  const std::string type = modbus::name_of(value.format.type);
  if (modbus::holds_bits(value.at.area) && value.at.is_bit()) {
    wrong(table.place("bit"), "A coil or discrete input is a bit, and has none.",
          "leave out the bit, or write area = \"holding\".");
    return false;
  }
  if (is_bit != (value.format.type == PointType::boolean)) {
    wrong(table.place(table.has("type") ? "type" : "area"),
          "A boolean lies among coils or discrete inputs or is a bit of a register, and every other value lies among "
          "registers.",
          value.at.is_bit() ? "leave out the type, or the bit."
          : is_bit          ? "leave out the type, or write area = \"holding\"."
                            : "write area = \"coil\", bit = 0, or another type.");
    return false;
  }
  value.at.count = static_cast<std::uint32_t>(modbus::registers_of(value.format.type));
  const std::string of_order = modbus::order_flaw_of(given, value.format.type);
  const std::string flaw = of_order.empty() ? modbus::flaw_of(value.format) : of_order;
  if (!flaw.empty()) {
    found_->error(error::unfit_format, table.place(of_order.empty() ? "scale" : "word_order"),
                  "What lies at register " + std::to_string(value.at.address) + " " + flaw + ".",
                  "choose a type, a scale and an offset in which each value is near a step; leave out what does not "
                  "apply.");
    return false;
  }
  if (value.at.address + value.at.count > 0x10000) {
    found_->error(error::run_value_out_of_range, table.place("register"),
                  "A " + type + " from register " + std::to_string(value.at.address) +
                      " on ends behind the last register, 65535.",
                  "choose register " + std::to_string(0x10000 - value.at.count) + " or a lower one.");
    return false;
  }
  return true;
}

std::optional<DeviceLink> DeviceReader::read_link(const ProgramSignal& port, bool written, std::int64_t longest_age,
                                                  TomlReader& table) {
  std::string name;
  table.read("device", name);
  modbus::RemoteValue value{.of = port.type, .written = written, .longest_age = std::chrono::nanoseconds(longest_age)};
  std::size_t loss = 0;
  table.read_choice("on_loss", loss);
  const auto found = std::ranges::find(config_->devices, name, &modbus::DeviceOptions::name);
  const bool is_known = found != config_->devices.end();
  const auto device = static_cast<std::size_t>(found - config_->devices.begin());
  const bool is_sound = read_place(value, is_known ? orders_[device] : modbus::WordOrder::abcd, table);
  if (name.empty()) {
    for (const Words key : value_keys) {
      if (table.has(key)) {
        found_->error(error::unknown_device, table.place(key),
                      "The key " + std::string(key) + " is of a value on a device, and no device is named.",
                      "name the device: device = \"stage\", and describe it under [devices.stage].");
        break;
      }
    }
    return std::nullopt;
  }
  if (!is_known) {
    found_->error(error::unknown_device, table.place("device"), "There is no device " + name + ".",
                  "describe it under [devices." + name + "].");
    return std::nullopt;
  }
  if (!is_sound) {
    return std::nullopt;
  }
  const DeviceLink link{.device = device, .value = found->values.size(), .faults = loss == 0};
  found->values.push_back(value);
  values_.push_back({.name = port.name,
                     .place = table.place(table.has("register") ? "register" : "device"),
                     .link = link,
                     .written = written});
  return link;
}

void DeviceReader::read_output(std::size_t port, std::int64_t longest_age, TomlReader& table) {
  const auto link = read_link(shape_->outputs[port], true, longest_age, table);
  if (!link) {
    return;
  }
  config_->device_outputs.push_back({.port = port, .link = *link, .place = table.place("device")});
  const modbus::PointFormat& format = config_->devices[link->device].values[link->value].format;
  const auto [low, high] = modbus::limits_of(format);
  OutputSafety& output = config_->task.outputs[port];
  warn_of_range(
      shape_->outputs[port].name, format, output.low, output.high, table,
      "the output is limited to what it reaches: choose a wider type or another scale, or state low and high.");
  output.low = std::max(output.low, low);
  output.high = std::min(output.high, high);
}

void DeviceReader::warn_of_range(const std::string& name, const modbus::PointFormat& format, double low, double high,
                                 const TomlReader& table, const std::string& mend) {
  if (const std::string flaw = modbus::range_flaw_of(format, low, high); !flaw.empty()) {
    found_->warning(error::unfit_format, table.place(table.has("type") ? "type" : "device"), name + " " + flaw + ".",
                    mend);
  }
}

void DeviceReader::read_input(std::size_t port, std::int64_t longest_age, TomlReader& table) {
  InputSettings& settings = config_->task.inputs[port];
  const auto link = read_link(shape_->inputs[port], false, longest_age, table);
  if (link) {
    modbus::RemoteValue& value = config_->devices[link->device].values[link->value];
    value.low = shape_->inputs[port].low;
    value.high = shape_->inputs[port].high;
    warn_of_range(shape_->inputs[port].name, value.format, value.low, value.high, table,
                  "the input never comes near its limit: see in the device's manual whether type and scale are right.");
    config_->device_inputs.push_back({.port = port, .link = *link});
    settings.from_device = true;
  }
  read_told(port, "age_of", Tells::age, table);
  read_told(port, "quality_of", Tells::quality, table);
  table.read("retain", settings.is_retained);
  if (settings.is_retained && settings.from_device) {
    wrong(table.place("retain"), shape_->inputs[port].name + " is given by a device, and each start reads it anew.",
          "remove retain; it is of inputs that clients write.");
  }
  // A device's value has its age from the device; a server's is counted in cycles.
  settings.longest_age = settings.from_device ? 0 : static_cast<std::uint64_t>(longest_age / shape_->period);
}

void DeviceReader::read_told(std::size_t port, std::string_view key, Tells tells, TomlReader& table) {
  std::string of;
  table.read(key, of);
  if (of.empty()) {
    return;
  }
  if (config_->task.inputs[port].from_device) {
    wrong(
        table.place(key),
        shape_->inputs[port].name + " is given by another key already, and " + std::string(key) + " would give it too.",
        "keep one of device, age_of and quality_of; the age and the quality of a value are inputs of their own.");
  }
  config_->task.inputs[port].from_device = true;
  told_.push_back({.port = port, .tells = tells, .of = of, .place = table.place(key)});
}

void DeviceReader::finish() {
  for (const Told& told : told_) {
    const auto found =
        std::ranges::find_if(values_, [&](const Named& value) { return equal_ignoring_case(value.name, told.of); });
    if (found == values_.end()) {
      found_->error(error::unknown_device, told.place, told.of + " is no input or output on a device.",
                    "name one that has a device: its age and its quality are those of its exchange with the device.");
      continue;
    }
    config_->device_inputs.push_back({.port = told.port, .link = found->link, .tells = told.tells});
  }
  refuse_twice();
}

void DeviceReader::refuse_twice() {
  const auto at = [&](const Named& value) -> const modbus::Stretch& {
    return config_->devices[value.link.device].values[value.link.value].at;
  };
  std::ranges::stable_sort(values_, {}, [](const Named& value) { return value.place.line; });
  for (auto second_one = values_.begin(); second_one != values_.end(); ++second_one) {
    for (auto first = values_.begin(); first != second_one; ++first) {
      const modbus::Stretch& a = at(*first);
      const modbus::Stretch& b = at(*second_one);
      if (first->written && second_one->written && first->link.device == second_one->link.device && a.overlaps(b)) {
        found_->error(
            error::device_register_twice, second_one->place,
            second_one->name + " and " + first->name + " write the same register of " +
                config_->devices[first->link.device].name + ", " + std::to_string(std::max(a.address, b.address)) + ".",
            "give each a place of its own; a real64 takes four registers, and a bit has no room beside a whole value.");
      }
    }
  }
}

}  // namespace hysteron::runtime
