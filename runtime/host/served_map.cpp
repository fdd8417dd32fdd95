#include "runtime/host/served_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include "runtime/host/notices.hpp"
#include "runtime/modbus/address_text.hpp"
#include "support/atomic_file.hpp"
#include "support/byte_order_mark.hpp"
#include "support/text_file.hpp"

namespace hysteron::runtime {
namespace {

/// An error about a file that the run file names is said at the place that names it.
template <class Work>
auto placed(const Place& place, const Work& work) {
  try {
    return work();
  } catch (const DiskTroubleError&) {
    throw;  // it passes, and nobody is refused for it
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
  std::string lock_text{};   ///< empty where the file stays as it is
  bool was_emptied = false;  ///< the file was there, and without an address
};

/// As of a file that something cut off: none is written without an address.
bool has_no_address(const std::string& lock_text) {
  std::istringstream lines(lock_text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos && !line.starts_with('#')) {
      return false;
    }
  }
  return true;
}

modbus::RegisterMap map_with(const ModbusConfig& config, const std::string& title, std::span<const Point> points,
                             std::string lock_text) {
  return modbus::make_register_map(points, {.title = title,
                                            .placing = config.placing,
                                            .order = config.word_order,
                                            .has_discovery = config.has_discovery,
                                            .expose = config.expose,
                                            .expose_place = config.expose_place,
                                            .given = config.registers,
                                            .lock_file = config.lock_file,
                                            .lock_text = std::move(lock_text)});
}

/// At the lock file: whether it is there, and, where it could not be written, whether it can be now.
constexpr std::chrono::seconds between_looks_at_lock{10};

PlannedMap planned_map(const ModbusConfig& config, const std::string& title, std::span<const Point> points) {
  // Where that cannot be told, reading it says why.
  std::error_code unknown;
  const bool has_lock =
      !config.lock_file.empty() && (std::filesystem::exists(config.lock_file, unknown) || unknown != std::error_code{});
  std::string before =
      has_lock ? placed(config.lock_place, [&] { return without_mark(read_text_file(config.lock_file)); }) : "";
  const bool was_emptied = has_lock && has_no_address(before);
  if (!has_lock || was_emptied) {
    before = config.first_addresses;
  }
  PlannedMap planned{.map = map_with(config, title, points, before), .was_emptied = was_emptied};
  if (!config.lock_file.empty()) {
    const auto text = modbus::lock_text(planned.map);
    planned.lock_text = has_lock && !was_emptied && text == before ? "" : text;
  }
  return planned;
}

/// The points of a program that does not run yet.
std::vector<Point> points_of(const RunConfig& config, const StepProgram& program) {
  const TaskDoor door(program, config.task.inputs, config.task.outputs, config.task.field_points);
  return {door.points().begin(), door.points().end()};
}

PlannedMap planned_map(const RunConfig& config, const StepProgram& program) {
  return planned_map(config.modbus.value_or(ModbusConfig{}), program.shape().name, points_of(config, program));
}

void write_lock_file(const ModbusConfig& config, const std::string& text) {
  if (!text.empty()) {
    placed(config.lock_place, [&] { write_file_atomically(config.lock_file, text); });
  }
}

void tell_warnings(std::span<const Diagnostic> warnings) {
  for (const Diagnostic& one : warnings) {
    tell("Modbus", fmt::format("HY{} {}:{}: {} {}", one.number, one.place.file, one.place.line, one.cause, one.mend));
  }
}

void tell_emptied(const PlannedMap& planned, const ModbusConfig& config) {
  if (planned.was_emptied) {
    tell("Modbus",
         fmt::format("{} was there and had no address: registers have them {}, and may not be where clients "
                     "know them. Put the file back from a copy, or hand out what `hysteron map` prints.",
                     config.lock_file, config.first_addresses.empty() ? "anew" : "as the program was generated with"));
  }
}

std::map<std::string, std::string> addresses_in(const modbus::RegisterMap& map) {
  std::map<std::string, std::string> addresses;
  for (const modbus::MapEntry& entry : map.entries()) {
    addresses.emplace(map.point_of(entry).name, modbus::address_text(entry.at));
  }
  return addresses;
}

/// Whether a parameter of a version is this point, and not only one of its name.
bool is_of(const Point& point, std::span<const ProgramSignal> parameters) {
  return std::ranges::any_of(parameters, [&](const ProgramSignal& one) {
    return one.name == point.name && one.type == point.type && (one.unit.empty() ? "1" : one.unit) == point.unit;
  });
}

}  // namespace

ServedMap::ServedMap(const RunConfig& config, std::string title, Task& task,
                     const std::shared_ptr<const modbus::TlsContext>& tls)
    : config_(&config), title_(std::move(title)), door_(&task.door()), first_points_(task.door().points().size()) {
  const ModbusConfig& modbus = *config.modbus;
  const PlannedMap planned = planned_map(modbus, title_, task.door().points());
  server_ = std::make_unique<modbus::Server>(
      planned.map, task.door(),
      modbus::ServerOptions{.listen = modbus.listen,
                            .port = modbus.port,
                            .allow = modbus.allow,
                            .connections = modbus.connections,
                            .connections_per_address = modbus.connections_per_address,
                            .evict = modbus.evict,
                            .read_only = modbus.read_only,
                            .rtu = modbus.rtu,
                            .limits = {.idle = modbus.idle},
                            .heartbeat = modbus.heartbeat,
                            .client_lost = [&task](bool lost) { task.client_lost(lost); },
                            .tls = tls,
                            .tell = [](const std::string& line) { tell("Modbus", line); },
                            .place = modbus.listen_place});
  if (const std::string problem = try_to_write(planned.lock_text); !problem.empty()) {
    // It keeps no task from starting; without another edit, the next start has the same addresses.
    tell("Modbus", problem + " It is tried again every 10 s: edit nothing before.");
  }
  tell_emptied(planned, modbus);
  tell_warnings(planned.map.warnings().all());
}

NextMap ServedMap::next(const std::vector<Point>& points, const StepProgram& version) const {
  const ModbusConfig& modbus = *config_->modbus;
  const auto now = server_->map();
  NextMap next{.map = map_with(modbus, title_, points, modbus::lock_text(*now))};
  const auto served = addresses_in(*now);
  const auto addresses = addresses_in(next.map);
  const std::span<const Point> further = std::span(points).subspan(first_points_);
  for (const Point& point : further) {
    const auto address = addresses.find(point.name);
    const auto first = std::ranges::find(points, point.name, &Point::name);
    if (!is_of(point, version.shape().parameters)) {
      continue;
    }
    if (&*first != &point) {
      next.change.without.push_back(point.name + " (its name has had another type or unit since the start)");
    } else if (address == addresses.end()) {
      next.change.without.push_back(point.name + " (expose does not name it)");
    } else if (!served.contains(point.name)) {
      next.change.added.push_back({.name = point.name, .address = address->second});
    }
  }
  try {
    const auto later = map_with(modbus, version.shape().name, points_of(*config_, version),
                                modbus.lock_file.empty() ? modbus.first_addresses : modbus::lock_text(next.map));
    for (const auto& [name, address] : addresses_in(later)) {
      if (const auto known = addresses.find(name); known != addresses.end() && known->second != address) {
        next.change.until_restart.push_back({.name = name, .address = known->second, .after_restart = address});
      }
    }
  } catch (const InputError&) {
    // Only with an edited run file can the version be started: that says where its registers are then.
  }
  return next;
}

void ServedMap::show(NextMap next) {
  const ModbusConfig& modbus = *config_->modbus;
  const auto before = server_->map();
  server_->show(next.map);
  if (const std::string text = modbus::lock_text(next.map);
      !modbus.lock_file.empty() && text != modbus::lock_text(*before)) {
    std::string problem;
    try {
      problem = try_to_write(text);
    } catch (const InputError& refused) {
      problem = refused.diagnostics().all().front().cause;
    }
    if (!problem.empty()) {
      tell("Modbus", problem + " After a restart, registers that came with the online change may be elsewhere.");
    }
  }
  std::vector<Diagnostic> warnings;
  std::ranges::copy_if(next.map.warnings().all(), std::back_inserter(warnings), [&](const Diagnostic& one) {
    return std::ranges::find(before->warnings().all(), one.cause, &Diagnostic::cause) == before->warnings().all().end();
  });
  tell_warnings(warnings);
}

std::string ServedMap::try_to_write(const std::string& lock_text) {
  std::string problem;
  try {
    write_lock_file(*config_->modbus, lock_text);
  } catch (const DiskTroubleError& trouble) {
    problem = trouble.diagnostics().all().front().cause;
  }
  keep_unwritten(problem.empty() ? "" : lock_text);
  return problem;
}

void ServedMap::keep_unwritten(std::string lock_text) {
  const std::scoped_lock lock(unwritten_mutex_);
  unwritten_ = std::move(lock_text);
  look_at_ = std::chrono::steady_clock::now() + between_looks_at_lock;
  door_->shortage(Shortage::lock, !unwritten_.empty());
}

void ServedMap::look(std::chrono::steady_clock::time_point now) {
  std::string text;
  {
    const std::scoped_lock lock(unwritten_mutex_);
    if (now < look_at_) {
      return;
    }
    look_at_ = now + between_looks_at_lock;
    text = unwritten_;
  }
  const std::string& file = config_->modbus->lock_file;
  std::error_code unknown;
  const bool is_deleted = text.empty() && !file.empty() && !std::filesystem::exists(file, unknown) && !unknown;
  if (is_deleted) {
    text = modbus::lock_text(*server_->map());
  }
  if (text.empty()) {
    return;
  }
  std::string problem;
  try {
    problem = try_to_write(text);
  } catch (const InputError& refused) {
    problem = refused.diagnostics().all().front().cause;
    keep_unwritten(text);
  }
  if (problem.empty()) {
    tell("Modbus",
         is_deleted ? fmt::format("{} was deleted, and is there again: registers keep their addresses. To give them "
                                  "anew, delete it while no task runs.",
                                  file)
                    : fmt::format("the addresses of the registers are in {} now.", file),
         is_deleted ? Weight::warning : Weight::notice);
  } else if (is_deleted) {
    tell("Modbus", fmt::format("{} was deleted. {} It is tried again every 10 s: edit nothing before.", file, problem));
  }
}

void check_register_map(const RunConfig& config, const StepProgram& program) {
  if (config.modbus) {
    (void)planned_map(config, program);
  }
}

modbus::RegisterMap register_map_of(const RunConfig& config, const StepProgram& program) {
  PlannedMap planned = planned_map(config, program);
  const ModbusConfig modbus = config.modbus.value_or(ModbusConfig{});
  write_lock_file(modbus, planned.lock_text);
  tell_emptied(planned, modbus);
  return std::move(planned.map);
}

}  // namespace hysteron::runtime
