// HY_PERIODIC_DISTURBANCE: XOUT = XIN + SINE·sin(2π·FREQUENCY·t) + COSINE·cos(2π·FREQUENCY·t)
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/periodic.hpp"
#include "blocks/ports.hpp"
#include "blocks/ripple.hpp"

namespace hysteron {

struct PeriodicDisturbance {
  static constexpr About about{.name = "HY_PERIODIC_DISTURBANCE",
                               .title = "Periodic disturbance",
                               .group = Group::Dynamics,
                               .equation = "XOUT = XIN + SINE·sin(2π·FREQUENCY·t) + COSINE·cos(2π·FREQUENCY·t)",
                               .meaning =
                                   "A line in the spectrum that does not depend on the motion: mains hum, an "
                                   "unbalanced spindle, a pump. It goes on while the machine rests. The phase is kept "
                                   "in twice the working precision and does not drift. t is 0 in the first step.",

                               .effect = "periodic_disturbance",
                               .family = Family::PeriodicInTime};

  template <class S>
  struct Params {
    S SINE;
    S COSINE;
    S FREQUENCY;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(SINE).in("'x").otherwise(0.0).neutral_at(0.0).means("amplitude of the sine"),
                    HY_FIELD(COSINE).in("'x").otherwise(0.0).neutral_at(0.0).means("amplitude of the cosine"),
                    HY_FIELD(FREQUENCY).in("Hz").at_least(0.0).otherwise(50.0).means("periods a second")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    using Self = In;
    static constexpr auto fields() { return Fields{HY_FIELD(XIN).in("'x").means("signal")}; }
  };
  template <class S>
  using Out = Xout<S, "'x", "signal with the disturbance">;

  template <class S>
  using State = Periodic::State<S>;

  template <class S>
  static State<S> initial(const Params<S>& params) {
    return Periodic::initial(source(params));
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = with_term<S>(in.XIN, ripple<S>(params.SINE, params.COSINE, state.TURN))};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& /*in*/, const Out<S>& /*out*/,
                     const S& ts) {
    Periodic::update<S>(source(params), state, {.RUN = Bool<S>(true)}, {.XOUT = S(0.0)}, ts);
  }

  /// The reference that keeps the phase.
  template <class S>
  static Periodic::Params<S> source(const Params<S>& params) {
    return {.AMPLITUDE = S(1.0), .FREQUENCY = params.FREQUENCY, .PHASE = S(0.0), .OFFSET = S(0.0)};
  }
};

}  // namespace hysteron
