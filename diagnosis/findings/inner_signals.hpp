// Measured inner signals: a log that holds a column H1 or LEVEL1.XOUT, signals inside the diagram, cuts it there.
//
// Each becomes an output of its own, H1_MEASURED or LEVEL1_XOUT_MEASURED, which the diagnosis holds against its column
// like the others: what the diagram does before the cut must then explain that column, and what it does behind it the
// rest. A signal that agrees with its column puts the gap behind it, one that does not before it.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/model/input.hpp"
#include "diagnosis/noise/materiality.hpp"

namespace hysteron::diagnosis {

/// The input with a name of the language for each column with a dot that may drive something, HALL_TEMP for Hall.Temp:
/// its first part is no block of the diagram, and all records have it and see it move. `remarks` say the names, and the
/// parameter file has them as names of columns.
[[nodiscard]] DiagnosisInput with_named_drivers(const DiagnosisInput& input, std::vector<std::string>& remarks);

/// The input with an output for each inner signal that all records hold, under the name that the column then has too.
/// As it was where there is none. Adds the names of these outputs to `signals`.
[[nodiscard]] DiagnosisInput with_inner_signals(const DiagnosisInput& input, std::vector<std::string>& signals);

/// Of the outputs of those names, whether the cut agrees: it does where the diagram before it, with its parameters
/// refitted to this signal alone, explains it.
[[nodiscard]] std::vector<CutFinding> cuts_at(const std::vector<std::string>& signals, const Task& task,
                                              const Program& program, const Materiality& materiality);

/// A sentence for each column that is named as a signal inside the diagram, with a dot, and cuts it nowhere.
[[nodiscard]] std::vector<std::string> unmatched_columns(const DiagnosisInput& input);

}  // namespace hysteron::diagnosis
