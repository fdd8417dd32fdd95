// The noise of a sensor that a control loop carries on.
//
// The controller of a record did not read y but y + n, with the noise n of its sensor, and so n moved the command and,
// where that is large, how a dead zone or a limit behind it answers: on average over the noise they are smoother than
// their formula. A model that is driven by the reference alone has no n. What refitted parameters leave of a measured
// output,
//
//   r = y_measured − y_model,
//
// is slow where the model is wrong, since the machine is sampled well, and n above a tenth of the sampling rate. Its
// fast part, r less the parabola through ten samples to either side, is given to the model's loop: what reads y in the
// diagram reads y + n. It is the noise that the loop had only if other outputs show it: the fast part of what is left
// of one of them, as the controller's command, has to fall by three tenths. Noise of a logger, which no controller saw,
// makes it grow. What a sensor with coarse steps rounds off is fast as well, and is no noise to an effect that rounds:
// where it is the half of n, n stays out.
#pragma once

#include <string>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// The diagram with the noise of its measured outputs in its loops, and what the user is told of it.
struct LoopNoise {
  Variant base{};
  std::string remark{};  ///< empty: no loop carries noise that shows
};

/// The task gets columns for the noise. `base` has a finite value at the task's start.
[[nodiscard]] LoopNoise with_loop_noise(Task& task, const Variant& base, const std::string& top);

/// The noise anew, from what an effect leaves that explains the record better than refitted parameters do: what is fast
/// of the gap is then no part of it. False where it leaves the effect more than seven tenths of what that left before,
/// in squares; the task is then as it was.
[[nodiscard]] bool renew_loop_noise(Task& task, const Explanation& best);

/// The diagram as it stands in the text, for other inputs than those of the records. The fit is that with the noise.
[[nodiscard]] Explanation without_noise(Explanation one, const std::string& top);

}  // namespace hysteron::diagnosis
