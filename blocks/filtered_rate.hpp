// The rate of a signal behind a first-order lag, s/(1 + T·s): what HY_LAG, HY_LEAD_LAG and HY_DERIVATIVE_FILTERED
// are made of.
//
// It is ramp-invariant: exact when the signal runs straight between its samples,
//   D(k) = a·D(k−1) + (1 − a)·(x(k) − x(k−1))/TS,   a = exp(−TS/T).
// Then lag = x − T·D and lead-lag = x + (T1 − T2)·D, which are x itself, to the bit, where the time constants are 0,
// and have the right derivative there.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

/// x, or 0 below 1e-36: a decaying state would otherwise end among the denormal numbers, where processors are slow, and
/// stay there. The same bound serves double and float (smallest normal number 1.2e-38). The 0 is (x + 1) − 1 so that a
/// dual number keeps its derivative: a tuner starts from effects that are 0 and whose derivative is not.
template <class S>
S without_denormals(const S& x) {
  return either<S>(
      abs(x) < S(1e-36), [&] { return (x + S(1.0)) - S(1.0); }, [&] { return x; });
}

/// Below this (1 − exp(−u))/u goes through its series, since the difference from 1 would lose digits (of a lag of 1 s
/// at 50 µs in float, 6e-4).
inline constexpr double small_decay = 0.03125;

/// (1 − exp(−u))/u by its series, for 0 ≤ u < small_decay.
template <class S>
S decayed_share(const S& u) {
  return S(1.0) - u * (S(1.0 / 2.0) -
                       u * (S(1.0 / 6.0) -
                            u * (S(1.0 / 24.0) - u * (S(1.0 / 120.0) - u * (S(1.0 / 720.0) - u * S(1.0 / 5040.0))))));
}

/// 1 − exp(−u) for u ≥ 0.
template <class S>
S decayed_part(const S& u) {
  return either<S>(
      u < S(small_decay), [&] { return u * decayed_share(u); }, [&] { return S(1.0) - exp(-u); });
}

/// 1 − exp(−TS/T), the part that one sample forgets; 1 for T up to TS/64.
template <class S>
S forgotten_part(const S& time_constant, const S& ts) {
  return decayed_part(ts / max(time_constant, ts * S(0.015625)));
}

/// What a block with one such rate works out from its time constant and TS alone.
template <class S>
struct RateCoefficients {
  S forgotten;  ///< 1 − a
};

/// D(k) from D(k−1) and the slope (x(k) − x(k−1))/TS.
template <class S>
S filtered_rate(const S& rate, const S& slope, const S& forgotten) {
  return without_denormals(rate + forgotten * (slope - rate));
}

/// The state of a block that keeps such a rate.
template <class S, Label rate>
struct RateState {
  S X1;
  S RATE1;
  Bool<S> STARTED;
  using Self = RateState;
  static constexpr auto fields() {
    return Fields{HY_FIELD(X1).role(FieldRole::PastInput).in("'x").otherwise(0.0).means("input one sample ago"),
                  HY_FIELD(RATE1).in("'x/s").otherwise(0.0).means(rate),
                  HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
  }
};

/// What a filtered rate starts from: at the start either the first sample has stood for ever, or 0 has.
template <class S>
struct RateBefore {
  Bool<S> start;
  Bool<S> settled;
  S rate;   ///< D(k−1)
  S slope;  ///< (x(k) − x(k−1))/TS, 0 at the start
};

/// D(k), also at the start: 0 where settled, else what leaves the lag x − T·D at 0.
template <class S>
S started_rate(const RateBefore<S>& before, const S& x, const S& time_constant, const S& forgotten) {
  const Bool<S> lags = time_constant > S(0.0);
  return either<S>(
      before.start && !before.settled, [&] { return select(lags, x / select(lags, time_constant, S(1.0)), S(0.0)); },
      [&] { return filtered_rate(before.rate, before.slope, forgotten); });
}

/// What follows a signal slowly, or with `wanted` only what has followed since the first step: the state's members
/// STARTED and FIRST tell what it was there.
template <class S, class State>
S since_start(const Bool<S>& wanted, const State& state, const S& followed) {
  return followed - select(wanted, select(state.STARTED, state.FIRST, followed), S(0.0));
}

}  // namespace hysteron
