// A worker process with instances of an FMU: it is asked to begin and to step, and watched while it works.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <string>

#include "codegen/cosimulation/channel.hpp"
#include "codegen/cosimulation/fmu.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::cosimulation {

/// The FMU itself refused: at these inputs and parameters it cannot go on. Other ones may do.
class FmuRefusal : public InputError {
 public:
  using InputError::InputError;
};

class Session {
 public:
  /// Starts the worker. `instance` is the instance of the diagram, for messages; `step` the communication step in
  /// seconds. Throws InputError HY219, HY750.
  Session(const Fmu& fmu, std::string instance, std::size_t most_lanes, double step);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  Session(Session&&) = delete;
  Session& operator=(Session&&) = delete;

  [[nodiscard]] const ChannelView& values() const { return view_; }

  /// Waits for what an earlier run has left over, however it ends. Values may then be written.
  void settle();
  /// Has the worker begin anew, with so many lanes. Parameters and inputs of each lane are written before.
  void begin(std::size_t lanes);
  /// Has the worker do a step. Inputs of each lane are written before.
  void step();
  /// Waits for what was asked for; does nothing where nothing was. Throws FmuRefusal HY751 (HY750 of a beginning) where
  /// the FMU refuses, InputError HY752 where its process ends, HY753 where it takes too long.
  void wait();

 private:
  void spawn();
  void post(Command command);
  void end_worker() noexcept;
  [[noreturn]] void report_end(int status);
  [[noreturn]] void report_time();
  [[noreturn]] void report_refusal() const;
  [[nodiscard]] std::string doing() const;
  [[nodiscard]] std::string with_log(const std::string& cause) const;

  const Fmu& fmu_;
  std::string instance_;
  std::size_t size_ = 0;
  void* memory_ = nullptr;
  ChannelView view_;
  int memory_file_ = -1;
  int lifeline_ = -1;  ///< our end of a pipe: the worker ends when it is closed
  pid_t worker_ = -1;
  bool posted_ = false;
  Patience patience_;
  std::uint64_t steps_ = 0;
  std::chrono::steady_clock::time_point posted_at_{};
};

}  // namespace hysteron::cosimulation
