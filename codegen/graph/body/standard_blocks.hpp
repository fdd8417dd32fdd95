// The blocks of IEC 61131-3 as bodies: they may be called under a condition, and more than once.
#pragma once

#include "codegen/language/body.hpp"

namespace hysteron::bodies {

/// R_TRIG, F_TRIG, SR, RS, CTU, CTD, CTUD by the tables of the standard.
const language::body::Library& standard_blocks();

/// TON, TOF and TP where HY_TON and the like cannot stand, since these count the steps that they are called in. The
/// text counts those of the task: CLOCK_STEPS() since its first, each STEP_TIME() long. As in the library, a time up to
/// a sixteenth of a step above n steps counts as n.
const language::body::Library& timers_by_clock();

}  // namespace hysteron::bodies
