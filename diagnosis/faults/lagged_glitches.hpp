// Glitches that a lag has taken up: spikes ahead of a sensor's filter, or knocks on a slow plant. Each leaps and dies
// away, so that no sample lies far off its neighbours, while its energy is many times that of the leap. In a residual
// they are a sum of `decays`, for the time constant that leaves least.
//
// With enough leaps such a sum follows any slow signal, what an effect that is missing leaves as well. But time has a
// direction: of such glitches the record read backwards, where they would grow and vanish, shows next to nothing, while
// a slow signal is followed as well from either end. They are glitches only where the one direction leaves less than
// the other and little more than noise, and where few leaps lie at a leap of an input or where it is fastest, which an
// effect answers.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "diagnosis/faults/left_out.hpp"

namespace hysteron::diagnosis {

/// Of one output.
struct LaggedGlitches {
  LeftOut finding{};              ///< without rows: none is left out
  std::vector<Signal> removed{};  ///< by record, in the unit of the output
  double left = 0.0;              ///< ½Σr² of all outputs, with what each leap has to gain
};

/// In what one of these explanations leaves, the best first: beside the one that leaves least with them, of several
/// outputs in the one that loses the largest share. What is taken for something else hides them, so that the best
/// without them is often not the best with them.
[[nodiscard]] std::optional<LaggedGlitches> lagged_glitches(const Task& task, std::span<const Explanation> beside,
                                                            unsigned threads);

/// Takes them off the records. Single glitches of the same output are forgotten: some were the leaps of these.
void take_off(Task& task, std::vector<LeftOut>& found, const LaggedGlitches& glitches);

}  // namespace hysteron::diagnosis
