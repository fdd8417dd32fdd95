// Who writes an output of a device: one task at a time, and the guard of a task that is gone comes before the next one.
//
// A claim is a socket bound to a name, one for each register or coil that an output covers. The name follows from the
// device's address, however the run file spells it, unit, area and register. Task and guard share it, so the system
// frees it when the last of them is gone, however they end; no file is left over. A task listens on its claims, so that
// it can be asked whose it is: a name that another user has taken, who is not root, is no claim. A guard whose task is
// gone listens on names of its own: so a new task knows that it has to wait, and for which process. Names count within
// one network namespace, where such tasks reach the same devices.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime {

class OutputClaims {
 public:
  explicit OutputClaims(const RunConfig& config);

  struct Holder {
    std::size_t output = 0;            ///< in RunConfig::device_outputs: the first that is claimed by another
    std::uint32_t address = 0;         ///< of the register or coil
    std::optional<pid_t> guard{};      ///< the process of the guard that works there alone, 0 where it is not known;
                                       ///< none: a task
    bool is_foreign = false;           ///< the name is held by another user, or by who does not say whose he is
    std::optional<std::size_t> own{};  ///< another output of the same run file, which covers the same register
  };
  /// Claims all outputs on devices, or none, and then says who has one of them. Throws std::system_error where the
  /// system gives no socket.
  [[nodiscard]] std::optional<Holder> claim();
  /// From now on, a name that is no task's is passed over: its output has no claim.
  void pass_over_foreign() { passes_over_foreign_ = true; }
  /// Ends the guard that claim() gave last; false where that cannot be.
  [[nodiscard]] bool end_guard();
  /// From the guard's process: its task is gone.
  void guard_listens();
  /// To be called now and then: connections of those who asked leave the queue.
  void drain() const noexcept;

 private:
  struct Claim {
    std::string name{};
    std::size_t output = 0;
    std::uint32_t address = 0;
  };
  [[nodiscard]] std::optional<pid_t> guard_of(const Claim& claim);
  [[nodiscard]] static bool is_of_a_task(const Claim& claim);

  std::vector<Claim> claims_{};
  std::optional<Holder> own_{};        ///< where two outputs of the run file meet
  std::vector<Descriptor> sockets_{};  ///< as claims_, where claimed
  std::vector<Descriptor> guards_{};   ///< in the guard's process, once its task is gone
  bool passes_over_foreign_ = false;
  /// To the guard that is waited for: it ends with the guard, so that each start asks once and not in each try.
  struct Asked {
    std::string name{};
    Descriptor socket;
    pid_t guard = 0;
  };
  std::optional<Asked> asked_{};
};

/// Finds the addresses of all hosts of devices, as far as they answer in time: claims and links begin with them. To be
/// called while the process has one thread, before OutputClaims is made.
void look_up_hosts(RunConfig& config, std::chrono::milliseconds patience);

}  // namespace hysteron::runtime
