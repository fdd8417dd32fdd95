// The next experiment: of a catalogue of excitations, the one after which two rivals can be told apart best.
//
// Both rivals, with their fitted parameters, are simulated under each excitation. What counts is what is left between
// their outputs once the known parameters and the effects of either one are refitted to the other, to first order:
//
//   separation = min over A, B of ‖P_A (y_A − y_B)‖ / (√N σ),   P_A = projection off the sensitivities of A
//
// Where there is one rival only, it is the excitation that leaves the most of its own effect's sensitivity after the
// same projection, and so shrinks its interval most. Where even the best leaves too little to tell, none is
// recommended.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/search/search.hpp"

namespace hysteron::diagnosis {

/// `rivals` best first; the first two with different effects are told apart. `limits` are those of the user, by name
/// without regard to case: "U" the largest |value| of the input U, "U.low", "U.high" its range, "U.rate" its largest
/// |rate| a second; where there is none, the range and the largest rate of the records count. `noise_rms` is that of
/// the first measured output, in its unit. Deterministic. Without a title where no input moves in the records, and
/// where no excitation would tell; `reason` then says so.
[[nodiscard]] NextExperiment next_experiment(const Task& task, std::span<const Explanation> rivals,
                                             const std::vector<std::pair<std::string, double>>& limits,
                                             double noise_rms);

/// The program of an explanation with its fitted values: parameters, and the initial states of the first record.
[[nodiscard]] Program fitted_program(const Task& task, const Explanation& explanation);

}  // namespace hysteron::diagnosis
