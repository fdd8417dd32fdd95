#include "runtime/host/running_mqtt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <utility>

#include "runtime/host/running_history.hpp"
#include "runtime/modbus/tls_context.hpp"
#include "runtime/mqtt/json_dialect.hpp"
#include "runtime/mqtt/sparkplug.hpp"
#include "support/byte_order_mark.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::size_t longest_password = 1000;

std::string read_password(const MqttConfig& config) {
  if (config.password_file.empty()) {
    return {};
  }
  const std::string file = modbus::credential_path(config.password_file, modbus::mqtt_password_credential);
  if (modbus::is_open_to_others(file)) {
    throw InputError(error::key_open_to_others, config.password_place,
                     fmt::format("Others than its owner may read or change the password file {}.", file),
                     fmt::format("chmod 600 {}; if anybody could have read it, have the password changed.", file));
  }
  std::string text = without_mark(read_text_file(file));
  while (text.ends_with('\n') || text.ends_with('\r')) {
    text.pop_back();
  }
  if (text.empty() || text.size() > longest_password || text.find('\n') != std::string::npos ||
      text.find('\0') != std::string::npos) {
    throw InputError(
        error::wrong_run_value, config.password_place,
        fmt::format("The password file {} does not hold one line of 1 to {} bytes.", file, longest_password),
        "write the password alone into it.");
  }
  return text;
}

/// 20 letters and digits, which every broker takes.
std::string made_up_name() {
  std::random_device random;
  return fmt::format("hyst{:08x}{:08x}", random(), random());
}

MqttLink link_of(const MqttConfig& config) {
  MqttLink link;
  link.broker = config.broker;
  link.port = config.port;
  link.client_id = config.client_id.empty() ? made_up_name() : config.client_id;
  link.user = config.user;
  link.password = read_password(config);
  if (!config.ca.empty()) {
    link.authority = modbus::credential_path(config.ca, modbus::mqtt_ca_credential);
    if (!config.certificate.empty()) {
      link.certificate = modbus::credential_path(config.certificate, modbus::mqtt_certificate_credential);
      link.key = modbus::credential_path(config.key, modbus::mqtt_key_credential);
    }
    modbus::check_client_files({.authority = link.authority,
                                .certificate = link.certificate,
                                .key = link.key,
                                .authority_place = config.ca_place,
                                .certificate_place = config.certificate_place,
                                .key_place = config.key_place});
  }
  return link;
}

/// The input that is told how the device's value of a port is; nothing where there is none, or no device.
std::optional<std::string> quality_input(const RunConfig& config, const ProgramShape& shape, const std::string& name) {
  std::optional<DeviceLink> link;
  for (const DeviceInput& input : config.device_inputs) {
    if (input.tells == Tells::value && shape.inputs[input.port].name == name) {
      link = input.link;
    }
  }
  for (const DeviceOutput& output : config.device_outputs) {
    if (shape.outputs[output.port].name == name) {
      link = output.link;
    }
  }
  for (const DeviceInput& input : config.device_inputs) {
    if (link && input.tells == Tells::quality && input.link.device == link->device && input.link.value == link->value) {
      return shape.inputs[input.port].name;
    }
  }
  return std::nullopt;
}

}  // namespace

RunningMqtt::RunningMqtt(const RunConfig& config, const ProgramShape& shape, Task& task) : door_(&task.door()) {
  const MqttConfig& mqtt = *config.mqtt;
  std::vector<std::string> columns = mqtt.points;
  const auto column_of = [&](const std::string& name) {
    const auto at = std::ranges::find(columns, name);
    const auto column = static_cast<std::size_t>(at - columns.begin());
    if (at == columns.end()) {
      columns.push_back(name);
    }
    return column;
  };
  const auto indices = points_named(mqtt.points, door_->points());
  settings_.rows = {.on_change = mqtt.on_change, .refresh = mqtt.refresh};
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Point& point = door_->points()[indices[i]];
    MqttPoint published{.name = point.name,
                        .unit = point.unit,
                        .type = point.type,
                        .is_port = point.kind == PointKind::input || point.kind == PointKind::output,
                        .dead_band = mqtt.dead_bands[i]};
    if (const auto told = quality_input(config, shape, point.name)) {
      published.quality_column = column_of(*told);
    }
    settings_.rows.points.push_back(std::move(published));
  }
  settings_.rows.fault_column = column_of("task.fault");
  if (config.web && config.web->rights.force) {
    settings_.rows.forced_column = column_of("task.forced");
  }
  settings_.link = link_of(mqtt);
  settings_.period = shape.period;
  settings_.bytes = mqtt.bytes;
  settings_.keep = mqtt.keep;
  settings_.file = mqtt.file;
  if (mqtt.payload == MqttPayload::Json) {
    settings_.owner = fmt::format("{} on topic {}", shape.name, mqtt.topic);
    dialect_ = std::make_unique<JsonDialect>(mqtt.topic, mqtt.qos, settings_.rows.points);
  } else {
    settings_.owner = fmt::format("{} as node {} of group {}", shape.name, mqtt.node, mqtt.group);
    dialect_ = std::make_unique<SparkplugNode>(mqtt.group, mqtt.node, settings_.rows.points);
  }
  tap_.emplace(points_named(columns, door_->points()), mqtt.step, waiting_rows(shape.period, mqtt.step, columns.size()),
               counter_);
}

void RunningMqtt::start() {
  const MqttLink& link = settings_.link;
  const bool is_here = link.broker == "localhost" || link.broker == "::1" || link.broker.starts_with("127.");
  const bool is_readable = !link.password.empty() && link.authority.empty() && !is_here;
  mqtt_ = std::make_unique<Mqtt>(std::move(settings_), std::move(dialect_), *tap_, counter_, clocks_beside(*door_));
  if (is_readable) {
    remarks().say(
        "the password goes over the network in the clear; name who signs the broker's certificate, ca in [mqtt], "
        "and it is encrypted.");
  }
}

}  // namespace hysteron::runtime
