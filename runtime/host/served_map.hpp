// The register map of a task, its lock file, and the Modbus server that shows it, through online changes too.
//
// Clients know addresses. So an online change moves none: what has one keeps it, also while the version that runs does
// not have it, and parameters that are new get free ones behind them.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

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

/// Where a point lies, as a lock file writes it: holding 16.
struct PointRegister {
  std::string name{};
  std::string address{};
  std::string after_restart{};  ///< where that is known to be another one
};

/// What an online change does to the registers.
struct RegisterChange {
  std::vector<PointRegister> added{};          ///< of parameters that came with it
  std::vector<std::string> without{};          ///< parameters that came with it and have none: NAME (why)
  std::vector<PointRegister> until_restart{};  ///< that a restart of this version moves
};

/// A map for another version of the diagram, before it counts.
struct NextMap {
  modbus::RegisterMap map{};
  RegisterChange change{};
};

class ServedMap {
 public:
  /// Serves the map of the task's points from now on, and writes its lock file. Configuration and task must outlive it.
  /// Throws InputError HY820 to HY829 and those of the lock file.
  ServedMap(const RunConfig& config, std::string title, Task& task,
            const std::shared_ptr<const modbus::TlsContext>& tls);

  [[nodiscard]] modbus::Server& server() noexcept { return *server_; }
  /// The map with the points that the task has with another version. Throws InputError where it cannot be.
  [[nodiscard]] NextMap next(const std::vector<Point>& points, const StepProgram& version) const;
  /// Serves that map from the next request on, and writes the lock file. Where that cannot be written, a line says so.
  void show(NextMap next);
  /// To be called as time goes by, from a thread that is not the task's: a lock file that could not be written is tried
  /// again, and one that somebody deleted is written again.
  void look(std::chrono::steady_clock::time_point now);

 private:
  /// Empty, or why it is not written; then it is tried again.
  std::string try_to_write(const std::string& lock_text);
  void keep_unwritten(std::string lock_text);

  const RunConfig* config_;
  std::string title_;
  TaskDoor* door_;
  std::size_t first_points_;  ///< so many points there are without an online change
  std::mutex unwritten_mutex_{};
  std::string unwritten_{};  ///< the text of the lock file; empty where it is on the disk
  std::chrono::steady_clock::time_point look_at_{};
  std::unique_ptr<modbus::Server> server_;
};

}  // namespace hysteron::runtime
