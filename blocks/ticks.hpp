// Time as a whole number of steps, so that no rounding adds up and a timer is exact however long it runs.
#pragma once

#include "blocks/counting.hpp"
#include "blocks/rounding.hpp"

namespace hysteron {

/// The number of steps of length ts after which a duration has passed: the smallest n with n·ts ≥ duration, 0 for a
/// duration that is not positive. A duration up to a sixteenth of a step above n·ts counts as n steps, so that one
/// written as n·ts is n steps although n·ts rounds: in LREAL for every n, in REAL up to n = 300 000. It saturates at
/// 2^31 − 1 steps (29 h at 50 µs).
template <class S>
Int<S> steps_in(const S& duration, const S& ts) {
  return max(ceiling(duration / ts - S(0.0625)), Int<S>(0));
}

/// The time that `count` steps take, up to `duration`, which it reaches exactly; 0 for a count below zero.
template <class S>
S elapsed_time(const Int<S>& count, const Int<S>& steps, const S& duration, const S& ts) {
  const S elapsed = to_real<S>(max(count, Int<S>(0))) * ts;
  return select(count >= steps, max(duration, S(0.0)), min(elapsed, max(duration, S(0.0))));
}

}  // namespace hysteron
