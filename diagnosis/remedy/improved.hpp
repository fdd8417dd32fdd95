// The improved diagram and its parameter file, as the user gets them: texts that every command takes as they are.
//
// A friction acts on a force by the velocity that this force makes. Its block takes the velocity of the step before, so
// that the values have an order; the statements have none: its call reads the velocity, which is computed behind the
// force, which reads what the call gives. Such an effect adds to its input what does not depend on it. So it is written
// as a sum, FORCE + FRICTION.XOUT with 0 for the block's own XIN, and FRICTION.XOUT, which then comes from the memory
// alone, is read before the call. The values are the same.
#pragma once

#include <cstddef>
#include <string>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// The reads that stand before their call (HY402): above 0, a text compiles in any order only.
[[nodiscard]] std::size_t hidden_delays(const std::string& text);

/// The diagram with its effects, in the house's layout and in an order that needs no --any-order, where there is one.
[[nodiscard]] std::string improved_text(const Variant& variant, const std::string& path);

/// Whether a change of an unknown, as large as it is or as counts as notable, moves any sample by more than a millionth
/// of the noise.
[[nodiscard]] bool has_influence(const Fit& fit, Index unknown, double typical);

/// The user's parameter file with the fitted values, and those of the effects, which may be fitted further.
[[nodiscard]] parameters::ParameterFile improved_file(const Task& task, parameters::ParameterFile file,
                                                      const Explanation& explanation);

}  // namespace hysteron::diagnosis
