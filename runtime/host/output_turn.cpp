#include "runtime/host/output_turn.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>

#include "runtime/config/run_keys.hpp"
#include "runtime/host/service_notice.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds pause{10};
constexpr int most_tries = 100;  ///< a task that ends, or whose guard is about to see its end, is given a second

/// The guard is of no use any more: what it could not do, the task goes on trying.
void give_up_waiting(OutputClaims& claims, const std::string& title, const std::string& device,
                     const std::function<void(std::string_view)>& print) {
  if (claims.end_guard()) {
    print(fmt::format("{}: that guard has not reached {} and is ended; the task starts, and goes on trying\n", title,
                      device));
  } else {
    print(
        fmt::format("{}: that guard has not reached {} and cannot be ended; the task waits on. End the process "
                    "hysteron-guard\n",
                    title, device));
  }
}

}  // namespace

bool claim_outputs(OutputClaims& claims, const RunConfig& config, const std::string& title,
                   const std::atomic<bool>& stop, const std::function<void(std::string_view)>& print) {
  std::optional<SteadyClock::time_point> waits_since;
  for (int tries = 0;;) {
    const auto holder = claims.claim();
    if (!holder) {
      return true;
    }
    const DeviceOutput& output = config.device_outputs[holder->output];
    const modbus::DeviceOptions& options = config.devices[output.link.device];
    const std::string& device = options.name;
    const modbus::Area area = options.values[output.link.value].at.area;
    const std::string place =
        fmt::format("{} {} of {}", modbus::holds_bits(area) ? "coil" : "holding register", holder->address, device);
    if (holder->own) {
      const DeviceOutput& other = config.device_outputs[*holder->own];
      throw InputError(
          error::device_register_twice, output.place,
          fmt::format("Two outputs write {}: this one, and one on {}, which leads to the same device.", place,
                      config.devices[other.link.device].name),
          "describe the device once, and give each output a place of its own; a real64 takes four registers.");
    }
    if (holder->guard) {
      tries = 0;
      const auto now = SteadyClock::now();
      if (!waits_since) {
        waits_since = now;
        const std::string process = *holder->guard == 0 ? "" : fmt::format(", process {}", *holder->guard);
        print(
            fmt::format("{}: waits for the guard of an earlier run{}, which brings outputs on {} to their safe values, "
                        "{} at the most\n",
                        title, process, device, time_text(static_cast<double>(config.guard_wait))));
      }
      if (now - *waits_since >= std::chrono::nanoseconds(config.guard_wait)) {
        give_up_waiting(claims, title, device, print);
        waits_since = now;
      }
      // The service manager's time for a start counts from here anew.
      tell_service_manager("EXTEND_TIMEOUT_USEC=30000000");
    } else if (++tries > most_tries && holder->is_foreign) {
      print(
          fmt::format("{}: the name by which {} is claimed is held by another user, or by a program that is no task; "
                      "it starts, and nothing watches that nobody else writes there\n",
                      title, place));
      claims.pass_over_foreign();
      tries = 0;
    } else if (tries > most_tries) {
      throw InputError(
          error::output_of_another_task, output.place,
          fmt::format("Another task that runs on this machine writes {}.", place),
          "end that task first, or give one of the two another register; a run file that is served already is served "
          "once.");
    }
    if (stop.load(std::memory_order_relaxed)) {
      return false;
    }
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace hysteron::runtime
