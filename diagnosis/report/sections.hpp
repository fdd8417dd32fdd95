// The parts of the report that are text, tables and still pictures. Each is empty where it has nothing to say.
#pragma once

#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis::report {

/// The verdict as a sentence, its confidence, refusals and warnings.
[[nodiscard]] std::string verdict_section(const Diagnosis& diagnosis);
/// The missing signal over what it is a function of; nothing where there is no such picture.
[[nodiscard]] std::string missing_section(const Diagnosis& diagnosis);
/// Families with their probabilities; nothing where no evidence was asked for.
[[nodiscard]] std::string families_section(const Diagnosis& diagnosis);
/// The gap by kinds; nothing where there is none.
[[nodiscard]] std::string budget_section(const Diagnosis& diagnosis);
/// Each effect with its edge, its parameters and whether a feedforward can take it back.
[[nodiscard]] std::string effects_section(const Diagnosis& diagnosis);
/// The gap by controller, inputs and outputs, and plant; and on which side of a measured inner signal it lies.
[[nodiscard]] std::string split_section(const Diagnosis& diagnosis);
/// The shrinking gap: nominal, calibrated, improved, against the floor.
[[nodiscard]] std::string gap_section(const Diagnosis& diagnosis);
/// The diagram with the gap on its wires, and the wires as a table.
[[nodiscard]] std::string where_section(const Diagnosis& diagnosis, const Graph& graph);
/// The explanations that the data do not rule out, and what the record cannot tell apart.
[[nodiscard]] std::string rivals_section(const Diagnosis& diagnosis);
/// The command of the next experiment and its steps.
[[nodiscard]] std::string next_section(const Diagnosis& diagnosis);
/// The known parameters before and after the refit.
[[nodiscard]] std::string calibration_section(const Diagnosis& diagnosis);
/// The diagram as improved, as text.
[[nodiscard]] std::string improved_section(const Diagnosis& diagnosis);

}  // namespace hysteron::diagnosis::report
