// A diagnosis with all its parts filled by formulas, for the tests of the report.
#pragma once

#include "diagnosis/diagnosis.hpp"

namespace hysteron::diagnosis::fixture {

/// A piezo axis in a loop, with the effects of `rich_diagnosis` in it: a nested block, feedback, expressions.
[[nodiscard]] Program rich_program();

/// Three effects, four rivals, eight maps, two outputs, two records of which the first has `samples` samples.
[[nodiscard]] Diagnosis rich_diagnosis(std::size_t samples = 5000);

/// Nothing but reasons why a record was refused.
[[nodiscard]] Diagnosis refused_diagnosis();

}  // namespace hysteron::diagnosis::fixture
