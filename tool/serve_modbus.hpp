// The Modbus server of a served diagram, as the run file asks for it.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "runtime/config/run_config.hpp"
#include "runtime/modbus/register_map.hpp"
#include "runtime/modbus/server.hpp"

namespace hysteron::tool {

/// The map of a door's points. With a lock file, addresses are as it says, and it is written anew where points came.
[[nodiscard]] runtime::modbus::RegisterMap register_map_of(const runtime::ModbusConfig& config,
                                                           const std::string& title, runtime::PointDoor& door);

/// Listens and serves from here on. `client_lost` is called in the server's thread, as the heartbeat says.
[[nodiscard]] std::unique_ptr<runtime::modbus::Server> serve_modbus(const runtime::ModbusConfig& config,
                                                                    const std::string& title, runtime::PointDoor& door,
                                                                    std::function<void(bool)> client_lost);

}  // namespace hysteron::tool
