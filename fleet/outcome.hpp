// What a unit's command found, read from the file that it wrote.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fleet/command.hpp"
#include "support/numbers.hpp"

namespace hysteron::fleet {

struct FoundEffect {
  std::string effect{};
  std::string family{};
  std::string edge{};
  double probability = not_a_number;
  double share = not_a_number;  ///< of the gap that calibration leaves
  bool named = false;  ///< in the verdict; else the likeliest member of a family that was weighed and not named
};

struct FoundParameter {
  std::string source{};  ///< calibration, effect, fit, initial state, goal
  std::string name{};    ///< AMP.K; `lag at U: T1` where it is that of an effect
  double value = not_a_number;
  double standard_error = not_a_number;
  double low = not_a_number;  ///< of the 95 % interval
  double high = not_a_number;
  std::string unit{};
  std::string at_bound{};
};

struct Outcome {
  /// Of a diagnosis; converged or nearly converged of a fit; tuned of a goal; no errors of a check.
  std::string verdict{};
  std::vector<FoundEffect> effects{};
  std::vector<FoundParameter> parameters{};
  /// The probability of each by the record alone, without a prior; where none was weighed, the confidence of the
  /// verdict.
  std::map<std::string, double> families{};
  double confidence = not_a_number;
  double nominal_rms = not_a_number;   ///< of the gap, or of a fit's residual at its start, in `unit_of_gap`
  double improved_rms = not_a_number;  ///< with the effects; after the fit, in train
  std::string unit_of_gap{};
};

/// `hysteresis-ro at U + lag at Y`: the effects that are named; empty where none is.
[[nodiscard]] std::string effects_text(const Outcome& outcome);

/// Reads the product of a command in the folder of its unit. Throws InputError where it cannot be read, and
/// nlohmann::json::exception where it is not what the command writes.
[[nodiscard]] Outcome read_outcome(Command command, const std::filesystem::path& folder);

}  // namespace hysteron::fleet
