#include "runtime/config/mqtt_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/config/sampled_points.hpp"
#include "support/element_name.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::int64_t usual_refresh = 60'000'000'000;
constexpr std::size_t longest_name = 256;

}  // namespace

void MqttReader::read(const toml::table* mqtt, const toml::table* dead_bands) {
  if (mqtt == nullptr) {
    if (dead_bands != nullptr) {
      found_->error(error::wrong_run_value, place_of(*file_, dead_bands->source()),
                    "There is a table [dead_bands], and nothing is published.",
                    "add the table [mqtt], or remove [dead_bands].");
    }
    return;
  }
  TomlReader table(*file_, "[mqtt]", *mqtt, run_table("mqtt").keys, *found_);
  MqttConfig read;  // GCC 12 frees twice what an initialiser holds where a later one throws
  read_broker(table, read);
  read_payload(table, read);
  read_rows(table, read);
  if (dead_bands != nullptr) {
    if (!read.on_change) {
      found_->error(error::wrong_run_value, place_of(*file_, dead_bands->source()),
                    "There is a table [dead_bands], and every row is published whole.",
                    "write on_change = true in [mqtt], or remove [dead_bands].");
    }
    read_dead_bands("", *dead_bands, read);
  }
  config_->mqtt = std::move(read);
}

void MqttReader::useless(const TomlReader& table, std::string_view key, const std::string& why,
                         const std::string& mend) {
  if (table.has(key)) {
    found_->error(error::wrong_run_value, table.place(key), std::string(key) + " does nothing: " + why + ".", mend);
  }
}

void MqttReader::read_broker(TomlReader& table, MqttConfig& mqtt) {
  table.require("broker", "\"192.168.10.5\"");
  table.read("broker", mqtt.broker);
  const std::size_t colon = mqtt.broker.find(':');
  if (mqtt.broker.find('/') != std::string::npos || (colon != std::string::npos && colon == mqtt.broker.rfind(':'))) {
    found_->error(
        error::wrong_run_value, table.place("broker"), "The broker " + mqtt.broker + " is no host name and no address.",
        "write the host alone, as in broker = \"192.168.10.5\"; its port stands in port, and ca asks for TLS.");
  }
  table.read("ca", mqtt.ca);
  table.read("certificate", mqtt.certificate);
  table.read("key", mqtt.key);
  mqtt.ca_place = table.place("ca");
  mqtt.certificate_place = table.place("certificate");
  mqtt.key_place = table.place("key");
  mqtt.port = mqtt.ca.empty() ? mqtt.port : std::uint16_t{8883};
  table.read_whole("port", mqtt.port);
  if (!table.has("ca")) {
    for (const char* const key : {"certificate", "key"}) {
      useless(table, key, "without ca there is no TLS",
              "write who signs the broker's certificate, as in ca = \"ca.pem\", or remove the key.");
    }
  } else if (table.has("certificate") != table.has("key")) {
    const bool has_key = table.has("key");
    found_->error(error::wrong_run_value, table.place(has_key ? "key" : "certificate"),
                  has_key ? "There is a key, and no certificate." : "There is a certificate, and no key.",
                  "write both, as in certificate = \"client.pem\" and key = \"client.key\", or neither.");
  }
  table.read("user", mqtt.user);
  table.read("password_file", mqtt.password_file);
  mqtt.password_place = table.place("password_file");
  if (!table.has("user")) {
    useless(table, "password_file", "a password is a user's, and none is named",
            "write user = \"NAME\", or remove the key.");
  }
  table.read("client_id", mqtt.client_id);
  check_name(table, "client_id", mqtt.client_id, "/");
}

/// `levels`: signs that it may have besides, though they mean something in a topic.
void MqttReader::check_name(const TomlReader& table, std::string_view key, const std::string& name,
                            std::string_view levels) {
  const bool has_others = std::ranges::any_of(name, [&](char sign) {
    return static_cast<unsigned char>(sign) < ' ' || sign == 127 ||
           (std::string_view("+#/").find(sign) != std::string_view::npos &&
            levels.find(sign) == std::string_view::npos);
  });
  if (has_others || name.size() > longest_name) {
    found_->error(error::wrong_run_value, table.place(key),
                  std::string(key) + " has a sign that MQTT keeps for itself, or is too long.",
                  "leave out +, #" + std::string(levels.empty() ? ", /" : "") +
                      " and control characters, and write no more than " + std::to_string(longest_name) + " bytes.");
  }
}

void MqttReader::read_payload(TomlReader& table, MqttConfig& mqtt) {
  std::size_t payload = 0;
  table.read_choice("payload", payload);
  mqtt.payload = static_cast<MqttPayload>(payload);
  mqtt.topic = "hysteron/" + shape_->name;
  mqtt.group = "hysteron";
  mqtt.node = shape_->name;
  table.read("topic", mqtt.topic);
  table.read_whole("qos", mqtt.qos);
  table.read("group", mqtt.group);
  table.read("node", mqtt.node);
  check_name(table, "topic", mqtt.topic, "/");
  if (mqtt.topic.starts_with('$') || mqtt.topic.starts_with('/') || mqtt.topic.ends_with('/')) {
    found_->error(error::wrong_run_value, table.place("topic"),
                  "The topic " + mqtt.topic + " begins with a sign of the broker's own, or has an empty level.",
                  "write levels with / between them, as in topic = \"plant/stage1\".");
  }
  check_name(table, "group", mqtt.group, "");
  check_name(table, "node", mqtt.node, "");
  if (mqtt.payload == MqttPayload::SparkplugB) {
    useless(table, "topic", "Sparkplug B makes topics of group and node", "write group and node instead.");
    useless(table, "qos", "Sparkplug B prescribes the quality of service", "remove the key.");
  } else {
    for (const char* const key : {"group", "node"}) {
      useless(table, key, "it is of Sparkplug B, and payload is json",
              "write topic instead, or payload = \"sparkplug-b\".");
    }
  }
}

void MqttReader::read_rows(TomlReader& table, MqttConfig& mqtt) {
  mqtt.points = read_points(table, *shape_, config_->task.field_points, *found_);
  mqtt.step = read_step(table, *shape_, *found_);
  mqtt.dead_bands.assign(mqtt.points.size(), 0.0);
  table.read("on_change", mqtt.on_change);
  const std::int64_t every = static_cast<std::int64_t>(mqtt.step) * shape_->period;
  std::int64_t refresh = std::max(usual_refresh, every);
  table.read_duration("refresh", refresh, every, std::int64_t{86'400'000'000'000});
  mqtt.refresh = static_cast<std::uint64_t>(refresh / shape_->period);
  if (!mqtt.on_change) {
    useless(table, "refresh", "every row is published whole", "write on_change = true, or remove the key.");
  }
  table.read("file", mqtt.file);
  mqtt.file_place = table.place("file");
  table.read_duration("keep", mqtt.keep);
  std::uint64_t megabytes = mqtt.bytes / 1'000'000;
  table.read_whole("megabytes", megabytes);
  mqtt.bytes = megabytes * 1'000'000;
}

/// A name with a point in it may be quoted, or not: HYST.C1 = 0.1 is a table in TOML.
void MqttReader::read_dead_bands(const std::string& prefix, const toml::table& table, MqttConfig& mqtt) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const Place place = place_of(*file_, node.source());
    if (const auto* const below = node.as_table()) {
      read_dead_bands(name + ".", *below, mqtt);
      continue;
    }
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value) || *value < 0.0) {
      found_->error(error::wrong_run_value, place, name + " must be a number from 0 on.",
                    "write it in the unit of the point, as in " + name + " = 0.1.");
      continue;
    }
    if (std::ranges::none_of(mqtt.points, [&](const std::string& one) { return is_or_is_element_of(one, name); })) {
      const auto near = nearest_name(name, mqtt.points);
      found_->error(error::unknown_port_in_run_file, place, name + " is none of the points that are published.",
                    near.empty() ? "name it among points in [mqtt], or remove the line."
                                 : "did you mean " + std::string(near) + "?");
      continue;
    }
    for (std::size_t i = 0; i < mqtt.points.size(); ++i) {
      if (!is_or_is_element_of(mqtt.points[i], name)) {
        continue;
      }
      if (!banded_.insert(i).second) {
        found_->error(error::run_key_twice, place, "The dead band of " + mqtt.points[i] + " has been given before.",
                      "keep one of the two; case makes no difference.");
      }
      mqtt.dead_bands[i] = *value;
    }
  }
}

}  // namespace hysteron::runtime
