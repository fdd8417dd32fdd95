#include "runtime/config/idle_keys.hpp"

#include <string_view>

#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

class IdleKeys {
 public:
  IdleKeys(const std::string& file, Diagnostics& found) : file_(&file), found_(&found) {}

  /// The key does nothing where `idle`.
  void look(const toml::table& table, std::string_view key, bool idle, const std::string& why,
            const std::string& mend) {
    const auto* const node = table.get(key);
    if (idle && node != nullptr) {
      found_->warning(error::wrong_run_value, place_of(*file_, node->source()),
                      std::string(key) + " does nothing: " + why + ".", mend + ", or remove the key.");
    }
  }

 private:
  const std::string* file_;
  Diagnostics* found_;
};

const toml::table& below(const toml::table& parent, std::string_view name) {
  static const toml::table none;
  const auto* const table = parent[name].as_table();
  return table == nullptr ? none : *table;
}

template <class Look>
void each_table(const toml::table& parent, const Look& look) {
  for (const auto& [name, node] : parent) {
    if (const auto* const table = node.as_table()) {
      look(*table);
    }
  }
}

}  // namespace

void warn_of_idle_keys(const std::string& file, const toml::table& root, const RunConfig& config, Diagnostics& found) {
  IdleKeys keys(file, found);
  const toml::table& task = below(root, "task");
  keys.look(task, "catch_up", config.task.loop.policy != MissedPolicy::catch_up, "missed periods are not made up for",
            "write missed = \"catch_up\"");
  keys.look(task, "priority", config.scheduling.scheduling != Scheduling::fifo, "only fifo has priorities",
            "write scheduling = \"fifo\"");

  const toml::table& watchdog = below(root, "watchdog");
  keys.look(watchdog, "sensitivity", config.task.watchdog.time == 0, "without time there is no watchdog",
            "write the longest time of a cycle, as in time = \"5ms\"");
  const bool is_unguarded = config.device_outputs.empty();
  const std::string no_guard =
      is_unguarded ? "a guard is of outputs on devices, and there is none" : "guard = false, so there is no guard";
  const std::string guarded = is_unguarded ? "put an output on a device" : "write guard = true";
  keys.look(watchdog, "silence", is_unguarded || !config.guard, no_guard, guarded);
  keys.look(watchdog, "guard_wait", is_unguarded, no_guard, guarded);

  each_table(below(root, "outputs"), [&](const toml::table& output) {
    const std::string action = output["on_fault"].value_or(std::string("value"));
    keys.look(output, "ramp", action != "ramp", "on_fault is no ramp", "write on_fault = \"ramp\"");
    keys.look(output, "hold_cycles", action == "hold",
              "with on_fault = \"hold\" it holds for as long as the fault lasts",
              "write on_fault = \"value\" or \"ramp\"");
    keys.look(output, "longest_age", !output.contains("device"), "the output is on no device",
              "name one, as in device = \"stage\"");
    keys.look(output, "bump", !config.online_change, "the diagram does not change while the task runs",
              "add the table [online_change]");
  });
  each_table(below(root, "inputs"), [&](const toml::table& input) {
    keys.look(input, "longest_age", input.contains("age_of") || input.contains("quality_of"),
              "the input is told the age or quality of another value, which has an age of its own",
              "write it at that value");
  });

  if (config.modbus) {
    const toml::table& modbus = below(root, "modbus");
    const bool is_off = config.modbus->heartbeat.mode == modbus::HeartbeatMode::off;
    for (const char* const key : {"heartbeat_time", "after_loss"}) {
      keys.look(modbus, key, is_off, "no client is waited for", "write heartbeat = \"any\" or \"write\"");
    }
    keys.look(modbus, "own_writes", config.modbus->read_only, "read_only refuses all writes",
              "write read_only = false");
    keys.look(modbus, "connections_per_address", config.modbus->connections_per_address > config.modbus->connections,
              "there are " + std::to_string(config.modbus->connections) + " connections in all",
              "write more connections");
    keys.look(modbus, "evict", config.modbus->evict >= config.modbus->idle,
              "a client that is silent for so long has lost its connection by idle", "write a longer idle");
  }
}

}  // namespace hysteron::runtime
