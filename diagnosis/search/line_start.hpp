// A line that stands out of the residual's spectrum, in the size that the spectrum shows.
#pragma once

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// Whether the effect oscillates and was screened at the frequency of such a line.
[[nodiscard]] bool is_line(const Screened& one);

/// That effect beside the known parameters and states of `from`, at the line's frequency, its sizes those at which it
/// takes the line off the residual and nothing else: a fit of all of the residual would have it stand in for whatever
/// is missing besides. The cost is ∞ where the diagram has no value there.
[[nodiscard]] Explanation with_line(const Task& task, const Screened& one, const Explanation& from);

}  // namespace hysteron::diagnosis
