// How near a loop is to settling too slowly for its test: a bound of the search, of which the state of the loop alone
// would say only on which side it is.
//
//   h decays as the envelope of its peaks: σ = (ln|h(k₁)| − ln|h(k₂)|)/(k₂ − k₁),  k₁, k₂ the peaks of two quarters
//   too slow where  ln|h(k₂)| − σ·(¾·N − k₂) > ln(10⁻⁷·max|h|),                   N the steps that are watched
#pragma once

#include <cstddef>

#include "tuning/goal/loop_run.hpp"
#include "tuning/goal/margins.hpp"

namespace hysteron {

/// The excess, with its derivatives where the response has them, as a share of the decay that is asked for: above 0 the
/// loop is too slow. −1, with no direction, where it is far from that.
[[nodiscard]] Margin slowness(const LoopResponse& response, std::size_t watched);

}  // namespace hysteron
