// The register map of a task, its lock file, and the Modbus server that shows it.
#pragma once

#include <memory>
#include <string>

#include "runtime/config/run_config.hpp"
#include "runtime/modbus/register_map.hpp"
#include "runtime/modbus/server.hpp"
#include "runtime/modbus/tls_context.hpp"
#include "runtime/task/step_program.hpp"
#include "runtime/task/task.hpp"

namespace hysteron::runtime {

/// The register map of a program that is run so. With a lock file, addresses are as it says, and it is written anew
/// where points came.
[[nodiscard]] modbus::RegisterMap register_map_of(const RunConfig& config, const StepProgram& program);

/// Throws InputError where that map cannot be; writes nothing.
void check_register_map(const RunConfig& config, const StepProgram& program);

/// Serves the map from now on, and writes its lock file. Throws InputError HY820 to HY829 and those of the lock file.
[[nodiscard]] std::unique_ptr<modbus::Server> serve_modbus(const ModbusConfig& config, const std::string& title,
                                                           Task& task,
                                                           const std::shared_ptr<const modbus::TlsContext>& tls);

}  // namespace hysteron::runtime
