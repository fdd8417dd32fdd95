// Which two effects may be a pair: those whose changes, each as it was screened alone, add up to the residual.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/search/screening.hpp"
#include "diagnosis/search/superposition.hpp"

namespace hysteron::diagnosis {

/// So many pairs of different effects that would explain most if what each of them does simply added up: neither need
/// be among the best by itself. Places in `singles`; `known` are the known parameters and states of the bare diagram.
[[nodiscard]] std::vector<Superposition::Pair> pairs_that_add_up(const Task& task, const std::vector<Screened>& singles,
                                                                 const VectorXd& known, const Background& background,
                                                                 std::size_t count, unsigned threads);

/// Of pairs, best first, so many of which no two have the same effects, and none is in more than three: what goes with
/// one that is best by itself is seen when that one gets a second effect. `effects`: names, by place in `singles`.
[[nodiscard]] std::vector<Superposition::Pair> different_pairs(const std::vector<Superposition::Pair>& ranked,
                                                               const std::vector<std::string>& effects,
                                                               std::size_t count);

}  // namespace hysteron::diagnosis
