// The run file beside a diagram: how it is run. Every key but the safe values may be left out.
//
//   [task]
//   period = "1ms"             # must be the diagram's; for the reader
//   missed = "skip"            # or "catch_up", "stop"
//   catch_up = 3
//   tolerance = "100us"        # a start later than this is late
//   scheduling = "fifo"        # or "deadline", "other"
//   priority = 80
//   processor = 1
//   lock_memory = true
//
//   [watchdog]
//   time = "5ms"
//   sensitivity = 2
//   guard = true               # a process of its own holds the outputs safe
//   silence = "50ms"
//
//   [outputs.U]                # one for each output
//   safe = 0.0
//   on_fault = "ramp"          # or "value", "hold"
//   hold_cycles = 10
//   ramp = 20.0                # a second
//   low = -10.0
//   high = 10.0
//   slew = 1000.0              # a second
//   device = "stage"           # where it goes, as a name in [devices]
//   register = 0
//   area = "holding"           # or "coil"
//   type = "real64"            # or "int16", "uint16", "int32", "uint32", "int64", "uint64", "real32"; a coil:
//   "boolean" on_loss = "fault"          # or "keep": the diagram looks after it
//
//   [inputs.Y]
//   device = "stage"
//   register = 4
//   area = "input"             # or "holding", "coil", "discrete"
//   type = "real64"
//   on_loss = "fault"
//   longest_age = "20ms"
//
//   [inputs.Y_AGE]
//   age_of = "Y"               # seconds since Y came from its device; or quality_of
//
//   [devices.stage]
//   host = "127.0.0.1"
//   port = 1502
//   unit = 1
//   word_order = "abcd"
//   cycle = "5ms"
//   timeout = "200ms"
//
//   [devices.drive]
//   serial = "/dev/ttyUSB0"    # Modbus RTU
//   baud = 19200
//   parity = "even"            # or "odd", "none"
//   stop_bits = 1
//
//   [retain]
//   folder = "/var/lib/piezo"
//   every = 1000               # cycles
//   mismatch = "refuse"        # or "cold"
//
//   [trace]
//   file = "run.trace"
//   trigger = "U > 5.0"        # or "fault"
//   before = 1000              # cycles
//   after = 1000
//
//   [modbus]
//   listen = "127.0.0.1"
//   port = 1502
//   allow = ["192.168.10.0/24"]
//   connections = 32
//   read_only = false
//   word_order = "abcd"        # or "badc", "cdab", "dcba"
//   lock_file = "piezo.lock"
//   heartbeat = "write"        # or "any", "off": the telegrams that show that the client lives
//   heartbeat_time = "1s"      # without one for so long after the first, the outputs become safe
//   after_loss = "resume"      # when the client is back; or "reset": when it then writes task.reset
//   own_writes = true          # while a client that writes is there, no other may
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/modbus/device.hpp"
#include "runtime/modbus/heartbeat.hpp"
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
};

struct RetainConfig {
  std::string folder{};
  MismatchPolicy mismatch = MismatchPolicy::refuse;
  Place place{};
};

struct ModbusConfig {
  std::string listen = "127.0.0.1";
  std::uint16_t port = 1502;
  std::vector<std::string> allow{};
  std::size_t connections = 32;
  bool read_only = false;
  modbus::WordOrder word_order = modbus::WordOrder::abcd;
  std::string lock_file{};
  modbus::HeartbeatOptions heartbeat{};
  Place place{};
};

struct RunConfig {
  TaskSettings task{};  ///< inputs and outputs in the order of the diagram
  SchedulingRequest scheduling{};
  bool guard = true;
  std::int64_t silence = 50'000'000;
  std::optional<RetainConfig> retain{};
  std::optional<TraceSettings> trace{};
  Place trace_place{};
  std::optional<ModbusConfig> modbus{};
  std::vector<modbus::DeviceOptions> devices{};
  std::vector<DeviceInput> device_inputs{};
  std::vector<DeviceOutput> device_outputs{};
};

/// As modbus::word_orders.
inline constexpr std::array<std::string_view, 4> word_order_words{"abcd", "cdab", "badc", "dcba"};

/// Reads a run file for a program. Throws InputError with all that is wrong, HY801 to HY810 and HY813; `file` stands in
/// places.
[[nodiscard]] RunConfig parse_run_config(const std::string& file, std::string_view text, const ProgramShape& shape);

/// A length of time as "5ms": a number and one of ns, us, ms, s. In nanoseconds; nothing where it is none.
[[nodiscard]] std::optional<std::int64_t> parse_duration(std::string_view text);

/// A trigger as "U > 5.0", "Y_REF < -1", or "fault"; nothing where it is none of the program's.
[[nodiscard]] std::optional<TraceTrigger> parse_trigger(std::string_view text, const ProgramShape& shape);

}  // namespace hysteron::runtime
