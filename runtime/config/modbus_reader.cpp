#include "runtime/config/modbus_reader.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "runtime/config/format_reader.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {

void ModbusReader::read(const toml::table* modbus, bool over_tls) {
  if (modbus != nullptr) {
    read_server({*file_, "[modbus]", *modbus, run_table("modbus").keys, *found_}, over_tls);
  }
}

void ModbusReader::read_points(const toml::table* addresses, const toml::table* registers) {
  if (addresses != nullptr) {
    read_addresses("", *addresses);
  }
  if (registers != nullptr) {
    read_registers("", *registers);
  }
}

void ModbusReader::read_server(TomlReader table, bool over_tls) {
  ModbusConfig modbus;
  modbus.place = table.place();
  table.read("listen", modbus.listen);
  modbus.port = over_tls ? 802 : modbus.port;
  table.read_whole("port", modbus.port);
  table.read("allow", modbus.allow);
  table.read_whole("connections", modbus.connections);
  modbus.connections_per_address = std::max<std::size_t>(1, modbus.connections / 4);
  table.read_whole("connections_per_address", modbus.connections_per_address);
  table.read("read_only", modbus.read_only);
  std::size_t order = 0;
  table.read_choice("word_order", order);
  modbus.word_order = modbus::word_orders[order];
  std::size_t placing = 0;
  table.read_choice("map", placing);
  modbus.placing = static_cast<modbus::Placing>(placing);
  table.read("lock_file", modbus.lock_file);
  table.read("expose", modbus.expose);
  modbus.expose_place = table.place("expose");
  if (table.has("expose") && modbus.expose.empty()) {
    found_->error(error::wrong_run_value, table.place("expose"), "expose names no point, and a server has to have one.",
                 "name points as in expose = [\"U\", \"task.*\"], or leave the key out.");
  }
  table.read("discovery", modbus.has_discovery);
  read_heartbeat(table, modbus);
  config_->modbus = std::move(modbus);
}

/// A name with a point in it may be quoted, or not: HYST.C1 = "%ML3" is a table in TOML.
void ModbusReader::read_addresses(const std::string& prefix, const toml::table& table) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const Place place = place_of(*file_, node.source());
    if (const auto* const below = node.as_table()) {
      read_addresses(name + ".", *below);
    } else if (!node.is_string()) {
      found_->error(error::wrong_run_value, place, name + " must be an address, a text.",
                   "write it as in " + name + " = \"%QW5\".");
    } else if (!config_->modbus) {
      found_->error(error::wrong_run_value, place, name + " has an address, and there is no server.",
                   "add the table [modbus], or remove [addresses].");
    } else {
      config_->modbus->registers.push_back({.name = name, .address = node.as_string()->get(), .place = place});
    }
  }
}

/// [registers.HYST.C1] is the table of HYST.C1: a table of tables alone is a part of names.
void ModbusReader::read_registers(const std::string& prefix, const toml::table& table) {
  for (const auto& [key, node] : table) {
    const auto* const own = node.as_table();
    if (own == nullptr) {
      found_->error(error::wrong_run_value, place_of(*file_, node.source()), std::string(key.str()) + " must be a table.",
                    "write it as [registers." + prefix + std::string(key.str()) + "], and its keys below.");
      continue;
    }
    const std::string name = prefix + std::string(key.str());
    if (!own->empty() && std::ranges::all_of(*own, [](const auto& one) { return one.second.is_table(); })) {
      read_registers(name + ".", *own);
    } else {
      read_register(name, {*file_, "[registers." + name + "]", *own, run_table("registers").keys, *found_});
    }
  }
}

void ModbusReader::read_register(const std::string& name, TomlReader table) {
  modbus::GivenRegister given{.name = name, .place = table.place()};
  table.read("at", given.address);
  given.format = read_format(table);
  if (!config_->modbus) {
    found_->error(error::wrong_run_value, table.place(), name + " has a place on the server, and there is no server.",
                 "add the table [modbus], or remove [registers].");
  } else if (given.address.empty() && !given.format) {
    found_->error(error::wrong_run_value, table.place(), table.name() + " says nothing.",
                 "write an address or a format, as in type = \"int16\", or remove the table.");
  } else {
    config_->modbus->registers.push_back(std::move(given));
  }
}

void ModbusReader::read_heartbeat(TomlReader& table, ModbusConfig& modbus) {
  std::size_t mode = 0;
  table.read_choice("heartbeat", mode);
  modbus.heartbeat.mode = static_cast<modbus::HeartbeatMode>(mode);
  std::int64_t time = std::chrono::nanoseconds(modbus.heartbeat.time).count();
  table.read_duration("heartbeat_time", time);
  modbus.heartbeat.time = std::chrono::ceil<std::chrono::milliseconds>(std::chrono::nanoseconds(time));
  std::size_t after = 0;
  table.read_choice("after_loss", after);
  config_->task.reset_after_lost_client = after == 1;
  table.read("own_writes", modbus.heartbeat.own_writes);
  if (modbus.read_only && (modbus.heartbeat.mode == modbus::HeartbeatMode::write_telegram || after == 1)) {
    found_->error(error::wrong_run_value, table.place(after == 1 ? "after_loss" : "heartbeat"),
                 "Writes of a client are waited for, and read_only refuses them.",
                 "write heartbeat = \"any\" and after_loss = \"resume\", or read_only = false.");
  }
}

}  // namespace hysteron::runtime
