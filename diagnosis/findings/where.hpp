// Where model and machine differ: how much of the gap a change on each edge of the diagram could explain.
//
// On every edge a set of small signals is added, one at a time: 1, x, x², x³, x', sign(x'), |x'|, a slow copy of x, and
// the time, with x the signal of the edge; then every column of the record that can couple there, an input or one that
// the diagram does not use, and a slow copy of it. The share of the residual that their effect on the outputs spans,
// off the known parameters, is the edge's share (a score test). It is no bound: a jump, or a memory of another kind,
// lies outside of that span, so an edge has at least the share that an effect fitted there closes.
//
// A measured output is none of the columns: with it the residual itself would be among the signals of the output's
// wire. Two edges whose best explanations lie within 10° of each other cannot be told apart by the record.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/search/search.hpp"

namespace hysteron::diagnosis {

/// Edges that reach a measured output, largest share first. `columns` are those that the diagram does not use,
/// `effects` those of the verdict.
[[nodiscard]] std::vector<EdgeFinding> where(const Task& task, const Search& found, const std::string& top,
                                             const std::vector<std::string>& columns,
                                             const std::vector<EffectFinding>& effects, unsigned threads);

}  // namespace hysteron::diagnosis
