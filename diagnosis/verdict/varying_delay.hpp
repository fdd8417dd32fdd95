// Which set of effects a delay that varies belongs to: what its variation leaves of a record hides the effects beside
// it, and shows where in the diagram the delay lies.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/search/search.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

/// A delay and nothing else, fitted to residuals that are whitened of its own variation, where that leaves no more than
/// noise; the known parameters are then those that leave least beside its mean. Else, of the chosen set, the same with
/// its delay on another edge, other sets that have one with no more effects, and sets of a delay and an effect that
/// shows once the residuals are whitened of the delay's variation: the one whose variation leaves least, a larger set's
/// less than 0.6 of a smaller one's energy. It is then the chosen one, where it leaves less than 0.6 of the energy that
/// the chosen set does, or a quarter if it has other effects and as many. A delay that varies by more than 0.7 of its
/// mean is something else; what inputs and outputs foretell of a fit's residual is no jitter, and neither is what does
/// not lie where a variation would be strong. The residuals are those of the set, on each output that the delay moves
/// as large as what is still a surprise.
[[nodiscard]] std::optional<Unrepeatable> with_varying_delay(const Task& task, const std::string& top,
                                                             const Search& search, double floor_cost,
                                                             const SearchOptions& options, Judgement& judgement);

}  // namespace hysteron::diagnosis
