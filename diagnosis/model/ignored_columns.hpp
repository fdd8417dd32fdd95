// Columns of the records that the user has declared to drive nothing: a set point beside a loop, a reading that the
// machine itself causes.
#pragma once

#include "diagnosis/model/input.hpp"

namespace hysteron::diagnosis {

/// Takes the columns that [diagnose] of the parameter file ignores out of the records: nothing is a driver, rests, cuts
/// the diagram or is warned of that is not there.
/// @throws InputError HY502 for a name that no record has, HY603 for an input or output of the diagram.
void ignore_columns(DiagnosisInput& input);

}  // namespace hysteron::diagnosis
