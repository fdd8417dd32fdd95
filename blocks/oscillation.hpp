// The free damped oscillation, q'' + 2ζ·q' + q = 0, for every damping: what HY_SECOND_ORDER is made of.
#pragma once

#include "blocks/filtered_rate.hpp"

namespace hysteron {

/// Position q and velocity q', in the time of the undamped oscillation (one radian is one unit).
template <class S>
struct Oscillation {
  S position;
  S velocity;
};

/// What position and velocity become of each other in a time τ ≥ 0:
///   q(τ)  = kept·q + passed·q'       kept   = e^(−ζτ)·(c + ζτ·s),  passed = e^(−ζτ)·τ·s
///   q'(τ) = damped·q' − passed·q     damped = e^(−ζτ)·(c − ζτ·s)
/// where, with δ = (1 − ζ²)·τ², c = cos√δ and s = sin√δ/√δ; for δ < 0 the hyperbolic functions of √−δ. About δ = 0 both
/// are taken from their series, so that critical damping is an ordinary point, with derivatives.
template <class S>
struct OscillationStep {
  S kept;
  S passed;
  S damped;
};

template <class S>
OscillationStep<S> oscillation_step(const S& zeta, const S& tau) {
  const S damping = zeta * tau;
  const S delta = (S(1.0) - zeta) * (S(1.0) + zeta) * tau * tau;
  const S size = abs(delta);
  const Bool<S> near_critical = size < S(1e-3);
  const Bool<S> periodic = delta > S(0.0);
  const S root = sqrt(max(size, S(1e-3)));
  const S decay = exp(-damping);

  // δ < 0: e^(−ζτ)·cosh and sinh from two exponentials, neither of which can overflow; ζτ − √−δ = τ²/(ζτ + √−δ)
  const S slow = exp(-(tau * tau) / (damping + root));
  const S fast = exp(-(damping + root));
  const S c_series =
      decay *
      (S(1.0) - delta / S(2.0) * (S(1.0) - delta / S(12.0) * (S(1.0) - delta / S(30.0) * (S(1.0) - delta / S(56.0)))));
  const S s_series =
      decay *
      (S(1.0) - delta / S(6.0) * (S(1.0) - delta / S(20.0) * (S(1.0) - delta / S(42.0) * (S(1.0) - delta / S(72.0)))));
  const S c = select(near_critical, c_series, select(periodic, decay * cos(root), S(0.5) * (slow + fast)));
  const S s =
      select(near_critical, s_series, select(periodic, decay * sin(root) / root, S(0.5) * (slow - fast) / root));
  return {.kept = c + damping * s, .passed = tau * s, .damped = c - damping * s};
}

/// The oscillation after that time.
template <class S>
Oscillation<S> oscillate(const Oscillation<S>& start, const OscillationStep<S>& step) {
  return {.position = step.kept * start.position + step.passed * start.velocity,
          .velocity = step.damped * start.velocity - step.passed * start.position};
}

}  // namespace hysteron
