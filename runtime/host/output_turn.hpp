// The turn of a task at the outputs of its devices: after the guard of an earlier run, and never beside another task.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

#include "runtime/config/output_claims.hpp"
#include "runtime/config/run_config.hpp"

namespace hysteron::runtime {

/// Claims the outputs on devices. Where the guard of an earlier run still brings one of them to its safe value, it
/// prints a line that begins with `title` and waits, for RunConfig::guard_wait at the most: a device that is gone for
/// good keeps no task down. Then that guard is ended, and the task brings its outputs to their safe values itself as
/// soon as the device answers. False where it was asked to stop meanwhile. A name that another user holds is passed
/// over, and a line says so. Throws InputError HY814 where another task writes one of the outputs.
[[nodiscard]] bool claim_outputs(OutputClaims& claims, const RunConfig& config, const std::string& title,
                                 const std::atomic<bool>& stop, const std::function<void(std::string_view)>& print);

}  // namespace hysteron::runtime
