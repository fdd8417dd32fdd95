// Maps of the residual: how large it is over amplitude, rate, direction, depth of the branch, time since the branch,
// frequency and run time. Each sample falls into one bin of a map; the share is what the means of the bins explain.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/search/search.hpp"

namespace hysteron::diagnosis {

/// Of one measured output, over the input that moves most.
[[nodiscard]] std::vector<MapFinding> maps_of(const Task& task, const Explanation& calibrated,
                                              const Explanation& improved, std::size_t output);

}  // namespace hysteron::diagnosis
