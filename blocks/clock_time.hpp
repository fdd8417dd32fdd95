// The clock time of an effect that depends on it: counted in steps, so that no rounding adds up.
#pragma once

#include "blocks/counting.hpp"
#include "blocks/description.hpp"

namespace hysteron {

/// The steps since the start. The count stands still at 2^31 − 1 steps (29 h at 50 µs).
template <class S>
struct StepCount {
  Int<S> COUNT;
  using Self = StepCount;
  static constexpr auto fields() {
    return Fields{HY_FIELD(COUNT).otherwise(0.0).means("steps since the start; the first step has 0")};
  }
};

/// The time since the start: 0 in the first step.
template <class S>
S clock_time(const StepCount<S>& state, const S& ts) {
  return to_real<S>(state.COUNT) * ts;
}

/// How much of the sample that ends now lies behind a moment: 0 before it, 1 one sample later, and straight between, so
/// that what happens at the moment has a derivative by it.
template <class S>
S passed_part(const S& time, const S& moment, const S& ts) {
  return max(min((time - moment) / ts, S(1.0)), S(0.0));
}

/// What the effects of clock time have in common: a state that counts the steps.
struct OfClockTime {
  template <class S>
  using State = StepCount<S>;

  template <class S>
  static State<S> initial_count() {
    return {.COUNT = Int<S>(0)};
  }
  template <class S>
  static void count(State<S>& state) {
    state.COUNT = one_more(state.COUNT);
  }
  template <class S, class Params, class In, class Out>
  static void update(const Params& /*params*/, State<S>& state, const In& /*in*/, const Out& /*out*/, const S& /*ts*/) {
    count(state);
  }
};

}  // namespace hysteron
