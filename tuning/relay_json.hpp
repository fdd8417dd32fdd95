// A relay experiment for programs: what `hysteron relay` prints as JSON, and the parameter file that it writes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tuning/relay_experiment.hpp"

namespace hysteron {

/// docs/reference/schemas/relay.json.
[[nodiscard]] nlohmann::json relay_json(const RelayExperiment& relay);

/// The values of a PID to begin with, free within a decade or so, as a file for `hysteron tune`. `controller` is its
/// instance in the diagram, `file` the record. Throws InputError HY730 where the controller is no name.
[[nodiscard]] std::string relay_parameters(const RelayExperiment& relay, const std::string& controller,
                                           const std::string& file);

}  // namespace hysteron
