// Multiple shooting: the records in stretches, each of which begins in a state of its own.
//
// Where a plant integrates, what a model lacks adds up over the record, and soon the model is at another place than the
// machine: the force of a cogging comes at the wrong time, a friction holds what slides. The cost as a function of the
// parameters then has many minima, and an effect that is in the machine looks no better than one that is not. Over a
// short stretch from the right state little adds up (Bock and Plitt, IFAC 1984; Ribeiro et al., Automatica 121 (2020)
// 109158, on how the length of a simulation roughens its cost). So sets of effects are looked for on stretches, too;
// whether they hold is judged on the whole records, as for all others.
#pragma once

#include <optional>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// The task in stretches, with the states free that show in the outputs. None where no state of the calibrated diagram
/// keeps to the end of a record what it had at its start, and where the records are too short to be cut.
[[nodiscard]] std::optional<Task> in_stretches(const Task& task, const Explanation& calibrated);

/// A set that was fitted on stretches, over the whole records: begun from where it stands, and fitted to the end.
[[nodiscard]] Explanation over_whole_records(const Task& task, const Explanation& on_stretches);

}  // namespace hysteron::diagnosis
