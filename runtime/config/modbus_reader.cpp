#include "runtime/config/modbus_reader.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <variant>

#include "runtime/config/format_reader.hpp"
#include "runtime/config/line_reader.hpp"
#include "runtime/modbus/allow_list.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::runtime {

void ModbusReader::read(const toml::table* modbus, bool over_tls) {
  if (modbus != nullptr) {
    read_server({*file_, "[modbus]", *modbus, run_table("modbus").keys, *found_}, over_tls);
  }
}

void ModbusReader::read_line_of(const toml::table* rtu) {
  const bool is_off = config_->modbus && config_->modbus->listen.empty();
  if (rtu == nullptr) {
    if (is_off) {
      found_->error(error::wrong_run_value, config_->modbus->place,
                    "The server listens on no address and no serial line.",
                    "describe the line under [modbus_rtu], or write an address as in listen = \"127.0.0.1\".");
    }
    return;
  }
  TomlReader table(*file_, "[modbus_rtu]", *rtu, run_table("modbus_rtu").keys, *found_);
  modbus::RtuOptions options;
  options.line = read_line(table, *found_);
  table.read_whole("unit", options.unit);
  table.read_duration("longest_gap", options.longest_gap);
  table.read("read_only", options.read_only);
  table.require("serial", "\"/dev/ttyUSB0\"");
  const bool is_device = std::ranges::any_of(config_->devices, [&](const modbus::DeviceOptions& device) {
    const auto* const line = std::get_if<modbus::SerialLink>(&device.link);
    return line != nullptr && line->path == options.line.path;
  });
  if (is_device) {
    found_->error(
        error::wrong_run_value, table.place("serial"),
        options.line.path + " is the line of a device, whose master the task is; it cannot be a station there.",
        "name another line, or remove the table.");
  }
  if (!config_->modbus) {
    found_->error(error::wrong_run_value, table.place(), "[modbus_rtu] has no map, for there is no table [modbus].",
                  "add [modbus]; with listen = \"off\" it serves the serial line alone.");
    return;
  }
  config_->modbus->rtu = std::move(options);
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
  if (modbus.listen == "off") {
    modbus.listen.clear();
    if (over_tls) {
      found_->error(error::wrong_run_value, table.place("listen"), "[tls] has no connections to guard.",
                    "remove [tls], or write an address for listen.");
    }
    for (const std::string_view key : {"port", "allow", "connections", "connections_per_address", "idle", "evict"}) {
      if (table.has(key)) {
        found_->error(error::wrong_run_value, table.place(key),
                      std::string(key) + " is of a server that listens, and this one does not.",
                      "remove the key, or write an address for listen.");
      }
    }
  }
  if (!modbus.listen.empty() && !modbus::address_bytes(modbus.listen)) {
    const bool is_off = edit_distance(modbus.listen, "off", 1) <= 1;
    found_->error(error::unusable_listen_address, table.place("listen"), modbus.listen + " is no numeric address.",
                  is_off ? "did you mean \"off\"? It serves the line of [modbus_rtu] alone."
                         : "name an address of this machine: 127.0.0.1 for this machine alone, 0.0.0.0 for all "
                           "networks; \"off\" with [modbus_rtu] serves a serial line alone.");
  }
  modbus.port = over_tls ? 802 : modbus.port;
  table.read_whole("port", modbus.port);
  table.read("allow", modbus.allow, R"(["192.168.10.0/24"])");
  for (std::size_t i = 0; i < modbus.allow.size(); ++i) {
    try {
      (void)modbus::networks_of({modbus.allow[i]}, table.place("allow", i));
    } catch (const InputError& refused) {
      found_->add_all(refused.diagnostics());
    }
  }
  modbus.listen_place = table.place(table.has("port") ? "port" : "listen");
  refuse_open_to_all(table, modbus, over_tls);
  table.read_whole("connections", modbus.connections);
  modbus.connections_per_address = std::max<std::size_t>(1, modbus.connections / 4);
  table.read_whole("connections_per_address", modbus.connections_per_address);
  table.read_duration("idle", modbus.idle);
  table.read_duration("evict", modbus.evict);
  table.read("read_only", modbus.read_only);
  std::size_t order = 0;
  table.read_choice("word_order", order);
  modbus.word_order = modbus::word_orders[order];
  std::size_t placing = 0;
  table.read_choice("map", placing);
  modbus.placing = static_cast<modbus::Placing>(placing);
  table.read("lock_file", modbus.lock_file);
  modbus.lock_place = table.place("lock_file");
  table.read("expose", modbus.expose, R"(["NAME", "LOOP.*"])");
  modbus.expose_place = table.place("expose");
  if (table.has("expose") && modbus.expose.empty()) {
    found_->error(error::wrong_run_value, table.place("expose"), "expose names no point, and a server has to have one.",
                  "name points as in expose = [\"U\", \"task.*\"], or leave the key out.");
  }
  table.read("discovery", modbus.has_discovery);
  read_heartbeat(table, modbus);
  config_->modbus = std::move(modbus);
}

/// The same as the live page asks for: who opens a server to all networks says so.
void ModbusReader::refuse_open_to_all(const TomlReader& table, const ModbusConfig& modbus, bool over_tls) {
  const auto bytes = modbus::address_bytes(modbus.listen);
  const bool is_any = bytes && (bytes == modbus::address_bytes("0.0.0.0") || bytes == modbus::address_bytes("::"));
  if (is_any && modbus.allow.empty() && !over_tls) {
    found_->error(
        error::unusable_listen_address, table.place("listen"),
        modbus.listen + " is each network of this machine, and whoever reaches one may read and write.",
        "write which networks are served, as in allow = [\"192.168.10.0/24\"], or add [tls]; for all of them, "
        "allow = [\"0.0.0.0/0\", \"::/0\"].");
  }
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
      config_->modbus->registers.push_back(
          {.name = name, .address = node.as_string()->get(), .place = place, .address_place = place});
    }
  }
}

/// [registers.HYST.C1] is the table of HYST.C1: a table of tables alone is a part of names.
void ModbusReader::read_registers(const std::string& prefix, const toml::table& table) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const auto* const own = node.as_table();
    if (own == nullptr) {
      found_->error(error::wrong_run_value, place_of(*file_, node.source()),
                    std::string(key.str()) + " must be a table.",
                    "write it as [registers." + name + "], and its keys below.");
    } else if (!own->empty() && std::ranges::all_of(*own, [](const auto& one) { return one.second.is_table(); })) {
      read_registers(name + ".", *own);
    } else {
      read_register(name, {*file_, "[registers." + name + "]", *own, run_table("registers").keys, *found_});
    }
  }
}

void ModbusReader::read_register(const std::string& name, TomlReader table) {
  modbus::GivenRegister given{.name = name, .place = table.place(), .address_place = table.place("at")};
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
  table.read_duration("heartbeat_time", modbus.heartbeat.time);
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
