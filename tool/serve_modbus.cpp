#include "tool/serve_modbus.hpp"

#include <filesystem>
#include <utility>

#include "support/atomic_file.hpp"
#include "support/text_file.hpp"

namespace hysteron::tool {

using runtime::modbus::RegisterMap;
using runtime::modbus::Server;
using runtime::modbus::WordOrder;

RegisterMap register_map_of(const runtime::ModbusConfig& config, const std::string& title, runtime::PointDoor& door) {
  runtime::modbus::MapRequest request{.title = title, .lock_file = config.lock_file};
  request.order = config.word_order == "badc"   ? WordOrder::badc
                  : config.word_order == "cdab" ? WordOrder::cdab
                  : config.word_order == "dcba" ? WordOrder::dcba
                                                : WordOrder::abcd;
  if (!config.lock_file.empty() && std::filesystem::exists(config.lock_file)) {
    request.lock_text = read_text_file(config.lock_file);
  }
  RegisterMap map = runtime::modbus::make_register_map(door.points(), request);
  if (!config.lock_file.empty()) {
    if (const auto text = runtime::modbus::lock_text(map); text != request.lock_text) {
      write_file_atomically(config.lock_file, text);
    }
  }
  return map;
}

std::unique_ptr<Server> serve_modbus(const runtime::ModbusConfig& config, const std::string& title,
                                     runtime::PointDoor& door, std::function<void(bool)> client_lost) {
  return std::make_unique<Server>(register_map_of(config, title, door), door,
                                  runtime::modbus::ServerOptions{.listen = config.listen,
                                                                 .port = config.port,
                                                                 .allow = config.allow,
                                                                 .connections = config.connections,
                                                                 .read_only = config.read_only,
                                                                 .heartbeat = config.heartbeat,
                                                                 .client_lost = std::move(client_lost),
                                                                 .place = config.place});
}

}  // namespace hysteron::tool
