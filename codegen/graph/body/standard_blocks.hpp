// The blocks of IEC 61131-3 that need no time, as bodies: they may be called under a condition, and more than once.
#pragma once

#include "codegen/language/body.hpp"

namespace hysteron::bodies {

/// R_TRIG, F_TRIG, SR, RS, CTU, CTD, CTUD by the tables of the standard.
const language::body::Library& standard_blocks();

}  // namespace hysteron::bodies
