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
/// prints a line that begins with `title` and waits for as long as that takes; false where it was asked to stop
/// meanwhile. Throws InputError HY814 where another task writes one of them.
[[nodiscard]] bool claim_outputs(OutputClaims& claims, const RunConfig& config, const std::string& title,
                                 const std::atomic<bool>& stop, const std::function<void(std::string_view)>& print);

}  // namespace hysteron::runtime
