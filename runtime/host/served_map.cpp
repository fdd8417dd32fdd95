#include "runtime/host/served_map.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "runtime/host/notices.hpp"
#include "support/atomic_file.hpp"
#include "support/text_file.hpp"

namespace hysteron::runtime {
namespace {

/// An error about a file that the run file names is said at the place that names it.
template <class Work>
auto placed(const Place& place, const Work& work) {
  try {
    return work();
  } catch (const InputError& refused) {
    Diagnostics diagnostics;
    for (Diagnostic one : refused.diagnostics().all()) {
      one.place = one.place.line == 0 ? place : one.place;
      diagnostics.add(std::move(one));
    }
    throw InputError(std::move(diagnostics));
  }
}

/// A register map, and what its lock file has to say from now on.
struct PlannedMap {
  modbus::RegisterMap map{};
  std::string lock_text{};  ///< empty where the file stays as it is
};

PlannedMap planned_map(const ModbusConfig& config, const std::string& title, PointDoor& door) {
  modbus::MapRequest request{.title = title,
                             .placing = config.placing,
                             .order = config.word_order,
                             .has_discovery = config.has_discovery,
                             .expose = config.expose,
                             .expose_place = config.expose_place,
                             .given = config.registers,
                             .lock_file = config.lock_file};
  // Where that cannot be told, reading it says why.
  std::error_code unknown;
  const bool has_lock =
      !config.lock_file.empty() && (std::filesystem::exists(config.lock_file, unknown) || unknown != std::error_code{});
  request.lock_text =
      has_lock ? placed(config.place, [&] { return read_text_file(config.lock_file); }) : config.first_addresses;
  PlannedMap planned{.map = modbus::make_register_map(door.points(), request)};
  if (!config.lock_file.empty()) {
    const auto text = modbus::lock_text(planned.map);
    planned.lock_text = has_lock && text == request.lock_text ? "" : text;
  }
  return planned;
}

/// The map of a program that does not run yet.
PlannedMap planned_map(const RunConfig& config, const StepProgram& program) {
  TaskDoor door(program, config.task.inputs, config.task.outputs, config.task.field_points);
  return planned_map(config.modbus.value_or(ModbusConfig{}), program.shape().name, door);
}

/// `at_start`: a full disk keeps no task from starting; without another edit, the next start has the same addresses.
void write_lock_file(const ModbusConfig& config, const PlannedMap& planned, bool at_start) {
  const auto write = [&] {
    try {
      write_file_atomically(config.lock_file, planned.lock_text);
    } catch (const DiskFullError& full) {
      if (!at_start) {
        throw;
      }
      tell("Modbus", full.diagnostics().all().front().cause + " It is tried at the next start: edit nothing before.");
    }
  };
  if (!planned.lock_text.empty()) {
    placed(config.place, write);
  }
}

}  // namespace

std::unique_ptr<modbus::Server> serve_modbus(const ModbusConfig& config, const std::string& title, Task& task,
                                             const std::shared_ptr<const modbus::TlsContext>& tls) {
  const PlannedMap planned = planned_map(config, title, task.door());
  auto server = std::make_unique<modbus::Server>(
      planned.map, task.door(),
      modbus::ServerOptions{.listen = config.listen,
                            .port = config.port,
                            .allow = config.allow,
                            .connections = config.connections,
                            .connections_per_address = config.connections_per_address,
                            .evict = config.evict,
                            .read_only = config.read_only,
                            .rtu = config.rtu,
                            .limits = {.idle = config.idle},
                            .heartbeat = config.heartbeat,
                            .client_lost = [&task](bool lost) { task.client_lost(lost); },
                            .tls = tls,
                            .tell = [](const std::string& line) { tell("Modbus", line); },
                            .place = config.place});
  write_lock_file(config, planned, true);
  for (const Diagnostic& one : planned.map.warnings().all()) {
    tell("Modbus", fmt::format("HY{} {}:{}: {} {}", one.number, one.place.file, one.place.line, one.cause, one.mend));
  }
  return server;
}

void check_register_map(const RunConfig& config, const StepProgram& program) {
  if (config.modbus) {
    (void)planned_map(config, program);
  }
}

modbus::RegisterMap register_map_of(const RunConfig& config, const StepProgram& program) {
  PlannedMap planned = planned_map(config, program);
  write_lock_file(config.modbus.value_or(ModbusConfig{}), planned, false);
  return std::move(planned.map);
}

}  // namespace hysteron::runtime
