// The swing of a control loop, and what it says of the valve.
//
// Where a controller sets the input, a run of the plant alone is a poor judge: what disturbs the output comes back in
// the input, and any model has a part of it. How fast the loop swings tells more. A valve that sticks waits until the
// integral part of the controller has wound up, so that it swings below the corner 1/(2πT_i) of the controller; a loop
// that is tuned too tightly swings above it. Below the corner, input and output are a quarter of a period apart, and
// their cross-correlation is odd about lag 0; above it they are half of one apart, and it is even.
//
// That the one is odd and the other even was found by A. Horch (A simple method for detection of stiction in control
// valves, Control Engineering Practice 7 (1999) 1221), who measures it at the first changes of sign.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/rules.hpp"

namespace hysteron::diagnosis {

/// Of what the input's own past does not tell of it, in squares, the share that follows from the output now and
/// before: near 1 where a controller without noise sets it. By linear regression on five samples, in the middle one of
/// eight stretches: a single step of the input, and what it does, is no controller. 0 where a signal stands still, or
/// its own past tells all.
[[nodiscard]] double feedback_share(std::span<const double> input, std::span<const double> output);

/// Of the energy of the cross-correlation the share that is odd about lag 0, by the cross-spectrum S of both signals:
///
///   Σ (Im S)² / Σ |S|²,
///
/// over what comes again four times or more. For one frequency it is sin² of the phase between them, and under a PI
/// controller 1/(1 + (ω T_i)²). One half, which says nothing, where a signal stands still.
[[nodiscard]] double oddness(std::span<const double> input, std::span<const double> output);

/// Of a diagram with one measured output and one input that moves, where the record shows that the one sets the other.
/// A plant that answers within the sample looks the same: nothing is said where the diagram's own answer would make up
/// a notable part of that share (`at once` in policy.hpp), or where the output follows from the past of the input
/// more than the input from the output.
[[nodiscard]] std::optional<LoopFinding> control_loop(const Task& task, const Program& program, Rules& rules);

/// Whether a family is what makes a loop swing oddly: dry friction, or the play that is a stiction without its jump
/// (M. A. A. S. Choudhury, N. F. Thornhill, S. L. Shah, Control Engineering Practice 13 (2005) 641).
[[nodiscard]] bool is_sticking(std::string_view family);

/// A probability of what sticks, or of what does not, with the odds that the loop gives it: oddness to evenness.
[[nodiscard]] double with_loop(const LoopFinding& loop, double probability, bool sticks);

/// "OP follows PV as a controller sets it, …": what a user reads of it.
[[nodiscard]] std::string sentence_of(const LoopFinding& loop);

}  // namespace hysteron::diagnosis
