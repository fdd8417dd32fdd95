#include "runtime/host/output_turn.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "runtime/host/service_notice.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::chrono::milliseconds pause{10};
constexpr int most_tries = 100;  ///< a task that ends, or whose guard is about to see its end, is given a second

}  // namespace

bool claim_outputs(OutputClaims& claims, const RunConfig& config, const std::string& title,
                   const std::atomic<bool>& stop, const std::function<void(std::string_view)>& print) {
  bool told = false;
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
      if (!told) {
        const std::string process = *holder->guard == 0 ? "" : fmt::format(", process {}", *holder->guard);
        print(fmt::format(
            "{}: waits for the guard of an earlier run{}, which brings outputs on {} to their safe values\n", title,
            process, device));
        told = true;
      }
      // The service manager's time for a start counts from here anew.
      tell_service_manager("EXTEND_TIMEOUT_USEC=30000000");
    } else if (++tries > most_tries) {
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
