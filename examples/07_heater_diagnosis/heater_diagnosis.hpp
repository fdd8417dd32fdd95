// Example 7: two heaters that warm each other. A slow lag draws a wide loop, which is no hysteresis.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "examples/06_piezo_diagnosis/rounds.hpp"

namespace hysteron::examples {

/// Every fifth sample of the measured record, from 400 s on: by then the board rests, and 20 s later the first step
/// comes. Nothing where it is not at hand.
[[nodiscard]] std::optional<records::Record> heater_record();

/// What heaters may have, and what makes loops: hysteresis, friction, backlash.
[[nodiscard]] const std::vector<std::string>& effects_of_heaters();

/// Effects of that list that would be a hysteresis.
[[nodiscard]] const std::vector<std::string>& hysteretic_effects();

/// RMSE of each output without the first sample, in which a coupling does not count yet, degC.
[[nodiscard]] std::vector<double> heater_gaps(const Round& round, const records::Record& record);

/// What a straight line from an input leaves of an output, RMSE over its range: how wide a loop the record draws.
[[nodiscard]] double left_by_a_line(const records::Record& record, const std::string& input, const std::string& output);

}  // namespace hysteron::examples
