// Where model and machine differ: how much of the gap a change on each edge of the diagram could explain.
//
// On every edge a set of small signals is added, one at a time: 1, x, x², x³, x', sign(x'), |x'|, a slow copy of x, and
// the time, with x the signal of the edge. Their effect on the outputs spans what a change on this edge can look like;
// the share of the residual in that span, off the known parameters, is the edge's share (a score test). Two edges
// whose best explanations lie within 10° of each other cannot be told apart by the record.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/search.hpp"

namespace hysteron::diagnosis {

/// Edges that reach a measured output, largest share first.
[[nodiscard]] std::vector<EdgeFinding> where(const Task& task, const Explanation& calibrated, const std::string& top,
                                             unsigned threads);

}  // namespace hysteron::diagnosis
