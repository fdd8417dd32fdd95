// Simpler formulas for what a chosen set holds, weighed once it is whole.
//
// While a line of a cogging is still missing, the speed-dependent part of a friction fits some of it; with all lines in
// place that part has nothing to do, and the friction is a Coulomb one.
#pragma once

#include <optional>

#include "diagnosis/search/sets.hpp"

namespace hysteron::diagnosis {

/// A set with simpler formulas in place of its effects, while that is the better explanation by support_of on `samples`
/// samples; nothing where none is.
[[nodiscard]] std::optional<Explanation> with_simpler_formulas(const Sets& sets, const Variant& bare,
                                                               const Explanation& one, double samples);

}  // namespace hysteron::diagnosis
