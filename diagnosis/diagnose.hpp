// The diagnosis of the sim-to-real gap: where model and machine differ, which effect causes it, how far it shrinks.
//
//   const Diagnosis found = diagnose({.program = …, .text = …, .file = …, .records = …}, {});
//
// The method, step by step, with its figures: docs/diagnosis.md.
#pragma once

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/model/input.hpp"

namespace hysteron::diagnosis {

/// Deterministic for a seed, but for `seconds` and for a budget that runs out.
/// @throws InputError where the diagram, the parameters and the records do not fit together.
[[nodiscard]] Diagnosis diagnose(const DiagnosisInput& input, const DiagnosisOptions& options);

}  // namespace hysteron::diagnosis
