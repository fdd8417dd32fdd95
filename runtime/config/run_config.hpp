// The run file beside a diagram: how it is run. Its keys are declared in run_keys.cpp, and docs/reference/run-file.md
// lists them. Every key but the safe values may be left out.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/modbus/device.hpp"
#include "runtime/modbus/heartbeat.hpp"
#include "runtime/modbus/server.hpp"
#include "runtime/modbus/tls_context.hpp"
#include "runtime/task/guard.hpp"
#include "runtime/task/retain.hpp"
#include "runtime/task/scheduling.hpp"
#include "runtime/task/task.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime {

/// Where a value lies: devices[device].values[value].
struct DeviceLink {
  std::size_t device = 0;
  std::size_t value = 0;
  bool faults = true;  ///< its loss is a fault of the task; else the diagram looks after it
};

/// What an input is told: a value of a device, or how that value is.
enum class Tells : std::uint8_t {
  value,
  age,      ///< in seconds
  quality,  ///< as modbus::Quality counts
};

struct DeviceInput {
  std::size_t port = 0;
  DeviceLink link{};
  Tells tells = Tells::value;
};

struct DeviceOutput {
  std::size_t port = 0;
  DeviceLink link{};
  Place place{};
};

struct RetainConfig {
  std::string folder{};
  MismatchPolicy mismatch = MismatchPolicy::carry;
  Place place{};
};

struct ChangeConfig {
  std::string socket{};
  double most_load = 0.8;  ///< of the period, what a step of a new version may take
  Place place{};
};

struct HistoryConfig {
  std::string file{};
  std::vector<std::string> points{};  ///< as the task's door names them
  std::uint64_t step = 1;             ///< periods from row to row
  std::int64_t keep = 30 * std::int64_t{86'400'000'000'000};
  std::uint64_t bytes = 1'000'000'000;
  Place place{};
};

enum class MqttPayload : std::uint8_t { Json, SparkplugB };

struct MqttConfig {
  std::string broker{};
  std::uint16_t port = 1883;
  std::string ca{};           ///< files in PEM; empty: no TLS
  std::string certificate{};  ///< of the client, with its key; both empty where it shows none
  std::string key{};
  Place ca_place{};  ///< for errors
  Place certificate_place{};
  Place key_place{};
  std::string user{};
  std::string password_file{};
  Place password_place{};
  std::string client_id{};  ///< empty: one that is made up
  MqttPayload payload = MqttPayload::Json;
  std::string topic{};  ///< of JSON
  int qos = 1;          ///< of JSON
  std::string group{};  ///< of Sparkplug B
  std::string node{};
  std::vector<std::string> points{};  ///< as the task's door names them
  std::uint64_t step = 1;             ///< periods from row to row
  bool on_change = false;
  std::uint64_t refresh = 60;        ///< on change: periods after which a point is published without one
  std::vector<double> dead_bands{};  ///< on change, by point
  std::int64_t keep = std::int64_t{86'400'000'000'000};
  std::uint64_t bytes = 64'000'000;
  std::string file{};  ///< of the rows that wait; empty: they are in memory alone
  Place file_place{};
};

struct ModbusConfig {
  std::string listen = "127.0.0.1";  ///< empty: a serial line alone
  std::uint16_t port = 1502;
  std::vector<std::string> allow{};
  std::size_t connections = 32;
  std::size_t connections_per_address = 8;
  std::chrono::milliseconds idle = modbus::ConnectionLimits{}.idle;
  std::chrono::milliseconds evict = modbus::ServerOptions{}.evict;
  std::optional<modbus::RtuOptions> rtu{};
  bool read_only = false;
  modbus::WordOrder word_order = modbus::WordOrder::abcd;
  modbus::Placing placing = modbus::Placing::compact;
  std::string lock_file{};
  Place lock_place{};
  std::vector<std::string> expose{};  ///< names, or what they begin with and a star; none: all points
  Place expose_place{};
  bool has_discovery = true;
  std::vector<modbus::GivenRegister> registers{};  ///< of [addresses] and [registers]
  std::string first_addresses{};                   ///< the text that counts where the lock file is not there yet
  modbus::HeartbeatOptions heartbeat{};
  std::optional<modbus::TlsOptions> tls{};
  Place place{};
  Place listen_place{};  ///< of the port, or of what else says where it listens
};

struct WebConfig {
  std::string listen{};  ///< ADDRESS:PORT; empty: where the command line says
  std::string token_file{};
  std::string read_token_file{};
  PageRights rights{};
  Place place{};
};

struct RunConfig {
  TaskSettings task{};  ///< inputs and outputs in the order of the diagram
  SchedulingRequest scheduling{};
  bool guard = true;
  std::int64_t silence = 50'000'000;
  std::int64_t guard_wait = 60'000'000'000;  ///< of a start, for the guard of an earlier run
  std::optional<RetainConfig> retain{};
  std::optional<TraceSettings> trace{};
  Place trace_place{};
  std::optional<ChangeConfig> online_change{};
  std::map<std::size_t, double> bumps{};  ///< by output: how far it may jump at an online change
  std::optional<HistoryConfig> history{};
  std::optional<MqttConfig> mqtt{};
  std::optional<ModbusConfig> modbus{};
  std::optional<WebConfig> web{};  ///< of the live page
  std::vector<modbus::DeviceOptions> devices{};
  std::vector<DeviceInput> device_inputs{};
  std::vector<DeviceOutput> device_outputs{};
  Diagnostics warnings{};
};

/// Reads a run file for a program. Throws InputError with all that is wrong, HY801 to HY810, HY813, HY829, HY835, HY836
/// and HY860;
/// `file` stands in places.
[[nodiscard]] RunConfig parse_run_config(const std::string& file, std::string_view text, const ProgramShape& shape);

/// Of a run file only where its task takes online changes, whatever else it says; nothing where it names no socket.
/// Throws InputError where it is no TOML.
[[nodiscard]] std::optional<ChangeConfig> change_config_of(const std::string& file, std::string_view text);

/// A length of time as "5ms": a number and one of ns, us, ms, s, min, h, d. In nanoseconds; nothing where it is none.
[[nodiscard]] std::optional<std::int64_t> parse_duration(std::string_view text);

/// A trigger as "U > 5.0", "Y_REF < -1", or "fault"; nothing where it is none of the program's.
[[nodiscard]] std::optional<TraceTrigger> parse_trigger(std::string_view text, const ProgramShape& shape);

}  // namespace hysteron::runtime
