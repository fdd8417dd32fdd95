// The declared keys of a run file: each is read, each default is the one that counts, and the page says so.
#include "runtime/config/run_keys.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <variant>

#include "runtime/config/run_config.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

ProgramShape keyed_plant() {
  return {.name = "PLANT",
          .period = 1'000'000,
          .inputs = {{.name = "X"}},
          .outputs = {{.name = "Y", .low = -10.0, .high = 10.0}}};
}

/// A run file that reads a key, up to the line of that key.
std::string before(const RunTable& table, std::string_view key) {
  const std::string_view name = table.name;
  const bool serial = key == "baud" || key == "parity" || key == "stop_bits" || key == "echo";
  const std::string others = name == "[outputs.NAME]" ? "" : "[outputs.Y]\nsafe = 0.0\n";
  const std::string device = "[devices.stage]\n";
  constexpr std::array<std::string_view, 8> placed{"register", "area",       "type", "scale",
                                                   "offset",   "word_order", "bit",  "on_loss"};
  const bool on_device = std::ranges::find(placed, key) != placed.end();
  if (name == "[outputs.NAME]") {
    return device + "[outputs.Y]\n" + (key == "safe" ? "" : "safe = 0.0\n") + (on_device ? "device = \"stage\"\n" : "");
  }
  if (name == "[inputs.NAME]") {
    return (key == "retain" ? "[retain]\nfolder = \"kept\"\n" : "") + others + device + "[inputs.X]\n" +
           (on_device ? "device = \"stage\"\n" : "");
  }
  if (name == "[devices.NAME]") {
    return others + device + (serial ? "serial = \"/dev/ttyS0\"\n" : "");
  }
  if (name == "[retain]") {
    return others + "[retain]\n" + (key == "folder" ? "" : "folder = \"kept\"\n");
  }
  if (name == "[trace]") {
    return others + "[trace]\n" + (key == "file" ? "" : "file = \"run.trace\"\n") +
           (key == "before" || key == "after" || key == "captures" ? "trigger = \"fault\"\n" : "") +
           (key == "captures" ? "files = 1000\n" : "");
  }
  if (name == "[online_change]") {
    return others + "[online_change]\n" + (key == "socket" ? "" : "socket = \"a.socket\"\n");
  }
  if (name == "[history]") {
    return others + "[history]\n" + (key == "file" ? "" : "file = \"history.sqlite\"\n");
  }
  if (name == "[mqtt]") {
    const bool is_sparkplug = key == "group" || key == "node";
    return others + "[mqtt]\n" + (key == "broker" ? "" : "broker = \"127.0.0.1\"\n") +
           (key == "certificate" || key == "key" ? "ca = \"ca.pem\"\n" : "") +
           (key == "certificate" ? "key = \"a.key\"\n" : "") + (key == "key" ? "certificate = \"a.pem\"\n" : "") +
           (key == "password_file" ? "user = \"stage\"\n" : "") + (is_sparkplug ? "payload = \"sparkplug-b\"\n" : "") +
           (key == "refresh" ? "on_change = true\n" : "");
  }
  if (name == "[dead_bands]") {
    return others + "[mqtt]\nbroker = \"127.0.0.1\"\non_change = true\n[dead_bands]\n";
  }
  if (name == "[tls]" || name == "[roles]") {
    std::string text = others + "[modbus]\n" + (name == "[tls]" ? "[roles]\nR = [\"read\"]\n" : "") + "[tls]\n";
    for (const char* const file : {"certificate", "key", "clients"}) {
      text += key == file ? "" : std::string(file) + " = \"a.pem\"\n";
    }
    return text + (name == "[roles]" ? "[roles]\n" : "");
  }
  if (name == "[modbus_rtu]") {
    return others + "[modbus]\n[modbus_rtu]\n" + (key == "serial" ? "" : "serial = \"/dev/ttyS0\"\n");
  }
  if (name == "[registers.NAME]") {
    return others + "[modbus]\n[registers.X]\n" + (key == "at" ? "" : "at = \"holding 7\"\n");
  }
  return others + (name == "[addresses]" ? "[modbus]\n" : "") + std::string(name) + "\n";
}

/// All that a run file can say.
std::string described(const RunConfig& c) {
  std::string all;
  const auto put = [&](const auto&... values) { ((all += fmt::format("{} ", values)), ...); };
  put(c.task.loop.period, static_cast<int>(c.task.loop.policy), c.task.loop.catch_up, c.task.loop.tolerance,
      static_cast<int>(c.scheduling.scheduling), c.scheduling.priority, c.scheduling.processor,
      c.scheduling.lock_memory, c.task.watchdog.time, c.task.watchdog.sensitivity, c.guard, c.silence,
      c.task.retain_every, c.task.reset_after_lost_client);
  for (const OutputSafety& output : c.task.outputs) {
    put(output.value, output.low, output.high, output.slew, output.ramp, output.hold_cycles,
        static_cast<int>(output.action));
  }
  for (const InputSettings& input : c.task.inputs) {
    put(input.from_device, input.longest_age);
  }
  for (const DeviceInput& input : c.device_inputs) {
    put(input.port, input.link.device, input.link.value, input.link.faults, static_cast<int>(input.tells));
  }
  for (const DeviceOutput& output : c.device_outputs) {
    put(output.port, output.link.device, output.link.value, output.link.faults);
  }
  for (const modbus::DeviceOptions& device : c.devices) {
    if (const auto* const tcp = std::get_if<modbus::TcpLink>(&device.link)) {
      put(tcp->host, tcp->port);
    } else {
      const auto& line = std::get<modbus::SerialLink>(device.link);
      put(line.path, line.baud, line.parity, line.stop_bits, line.has_echo);
    }
    put(device.unit, device.shares_connection, device.period.count(), device.response.count());
    for (const modbus::RemoteValue& value : device.values) {
      put(static_cast<int>(value.at.area), value.at.address, value.at.count, modbus::name_of(value.format.type),
          static_cast<int>(value.format.order), value.format.scale, value.format.offset, value.at.bit,
          value.longest_age.count());
    }
  }
  if (c.retain) {
    put(c.retain->folder, static_cast<int>(c.retain->mismatch));
  }
  if (c.trace) {
    put(c.trace->file.string(), c.trace->trigger.has_value());
    if (c.trace->trigger) {
      put(c.trace->trigger->before, c.trace->trigger->after);
    }
  }
  if (c.history) {
    put(c.history->file, c.history->points.size(), c.history->step, c.history->keep, c.history->bytes);
  }
  if (c.mqtt) {
    const MqttConfig& mqtt = *c.mqtt;
    put(mqtt.broker, mqtt.port, mqtt.ca, mqtt.certificate, mqtt.key, mqtt.user, mqtt.password_file, mqtt.client_id,
        static_cast<int>(mqtt.payload), mqtt.topic, mqtt.qos, mqtt.group, mqtt.node, mqtt.points.size(), mqtt.step,
        mqtt.on_change, mqtt.refresh, mqtt.keep, mqtt.bytes);
  }
  if (c.modbus) {
    put(c.modbus->listen, c.modbus->port, c.modbus->allow.size(), c.modbus->connections, c.modbus->read_only,
        static_cast<int>(c.modbus->word_order), static_cast<int>(c.modbus->placing), c.modbus->lock_file,
        c.modbus->expose.size(), c.modbus->has_discovery, c.modbus->idle.count(), c.modbus->evict.count(),
        static_cast<int>(c.modbus->heartbeat.mode), c.modbus->heartbeat.time.count(), c.modbus->heartbeat.own_writes);
    if (const auto& rtu = c.modbus->rtu) {
      put(rtu->line.path, rtu->line.baud, rtu->line.parity, rtu->line.stop_bits, rtu->line.has_echo, rtu->unit,
          rtu->longest_gap.count(), rtu->read_only);
    }
    for (const modbus::GivenRegister& given : c.modbus->registers) {
      const modbus::GivenFormat format = given.format.value_or(modbus::GivenFormat{});
      put(given.name, given.address, format.scale, format.offset, format.type.has_value(), format.order.has_value());
    }
    if (const auto& tls = c.modbus->tls) {
      const modbus::Rights& rights = tls->without_role;
      put(tls->certificate, tls->key, tls->clients, tls->roles.size(), rights.read, rights.inputs, rights.parameters,
          rights.reset);
    }
  }
  return all;
}

RunConfig parsed(const std::string& text) {
  return parse_run_config("RUN.toml", text, keyed_plant());
}

TEST(RunKeys, EveryDeclaredKeyIsRead) {
  for (const RunTable& table : run_tables()) {
    for (const RunKey& key : table.keys) {
      const std::string start = before(table, key.name);
      const auto line = static_cast<std::uint32_t>(std::ranges::count(start, '\n') + 1);
      try {
        (void)parsed(start + std::string(key.name) + " = 1979-05-27\n");  // a date is no value of any key
        ADD_FAILURE() << table.name << ' ' << key.name << " is not read";
      } catch (const InputError& refused) {
        const auto& all = refused.diagnostics().all();
        EXPECT_TRUE(std::ranges::any_of(
            all, [&](const Diagnostic& one) { return one.number == error::wrong_run_value && one.place.line == line; }))
            << table.name << ' ' << key.name;
      }
    }
  }
}

TEST(RunKeys, EveryDefaultIsTheOneThatCounts) {
  int compared = 0;
  for (const RunTable& table : run_tables()) {
    for (const RunKey& key : table.keys) {
      if (key.otherwise.starts_with('(')) {
        continue;
      }
      const std::string start = before(table, key.name);
      EXPECT_EQ(described(parsed(start)), described(parsed(fmt::format("{}{} = {}\n", start, key.name, key.otherwise))))
          << table.name << ' ' << key.name;
      ++compared;
    }
  }
  EXPECT_GT(compared, 35);
}

TEST(RunKeys, BoundsAreTaken) {
  for (const RunTable& table : run_tables()) {
    for (const RunKey& key : table.keys) {
      if (key.kind != KeyKind::whole) {
        continue;
      }
      const std::string start = before(table, key.name);
      const auto with = [&](double value) { return fmt::format("{}{} = {:.0f}\n", start, key.name, value); };
      EXPECT_THROW((void)parsed(with(key.low - 1.0)), InputError) << table.name << ' ' << key.name;
      EXPECT_THROW((void)parsed(with(key.high + 1.0)), InputError) << table.name << ' ' << key.name;
      EXPECT_NO_THROW((void)parsed(with(key.low))) << table.name << ' ' << key.name;
    }
  }
}

TEST(RunKeys, ThePageIsCurrent) {
  std::ifstream file(HYSTERON_SOURCE_DIR "/docs/reference/run-file.md", std::ios::binary);
  const std::string page{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_EQ(page, run_file_page()) << "put this into docs/reference/run-file.md:\n" << run_file_page();
}

}  // namespace
}  // namespace hysteron::runtime
