// The state that the machine was in when the record began, where it is not the one that the model is reset to.
//
// A record may begin in mid-motion. What the model then lacks decays at the plant's own rate, and an effect that decays
// or drifts would be named for it. So the start is no effect but a nuisance: when a search is done, the best sets are
// fitted once more with the states of the diagram's dynamic blocks free at the start, the chosen set also without each
// of its effects. Where such a fit is the better one by the likelihood of verdict.hpp, each state being a parameter
// more, the search begins anew with the states free in all of its fits.
//
// A state whose trace in the outputs is nearly a constant or a straight line, as that of an integral, is not freed: it
// would take up an offset or a drift. Nor are the states of a hysteresis, which are those of its history.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/search/search.hpp"
#include "diagnosis/search/start_states.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

/// The states of a fitted diagram whose start shows in its outputs, by path; at most a few.
[[nodiscard]] std::vector<std::string> visible_states(const Task& task, const Explanation& calibrated);

/// The task with states free at the start, and their values there as the file's; none where the start is the model's.
[[nodiscard]] std::optional<Task> with_free_start(const Task& task, const Search& search, const Judgement& judgement,
                                                  double floor_cost, unsigned threads);

/// What the user is told of the states that were freed: their values at the start of each record.
[[nodiscard]] std::string words_of_start(const Task& task, const Explanation& chosen);

/// Where a fit misses the begin of a record by far more than the rest: what to say of it, else empty.
[[nodiscard]] std::string unexplained_start(const Task& task, const Explanation& chosen);

}  // namespace hysteron::diagnosis
