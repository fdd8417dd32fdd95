// Diagnosis in rounds: what one round leaves, improved.st and improved.toml, is the model of the next.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "diagnosis/diagnose.hpp"
#include "records/record.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::examples {

/// The model after a round.
struct Round {
  Program program{};
  parameters::ParameterFile file{};
  diagnosis::Diagnosis found{};  ///< of the tuned model, which no round has changed yet: nothing

  [[nodiscard]] bool named() const { return !found.effects.empty(); }
  /// "lag at U"
  [[nodiscard]] std::string effect() const;
  /// Other effects that the record does not rule out in its place.
  [[nodiscard]] std::vector<std::string> rivals() const;
};

/// A diagram and settings of the examples, "06_piezo_diagnosis/plant.st", tuned to a record.
[[nodiscard]] Round tuned_model(const std::string& diagram, const std::string& settings, const records::Record& record);

/// Diagnoses a model for one effect more, of those given, and leaves improved.st and improved.toml in the folder. A
/// round that names none has the model calibrated.
[[nodiscard]] Round next_round(const Round& before, const records::Record& record,
                               const std::vector<std::string>& effects, const std::filesystem::path& folder);

/// Model less measured, of each measured output of the diagram.
[[nodiscard]] std::vector<std::vector<double>> residuals_of(const Round& round, const records::Record& record);

}  // namespace hysteron::examples
