// HY_SECOND_ORDER: T²·XOUT'' + 2·ZETA·T·XOUT' + XOUT = K·XIN
#pragma once

#include "blocks/description.hpp"
#include "blocks/oscillation.hpp"

namespace hysteron {

struct SecondOrder {
  static constexpr About about{
      .name = "HY_SECOND_ORDER",
      .title = "Second-order lag, resonance",
      .group = Group::Dynamics,
      .equation = "T²·XOUT'' + 2·ZETA·T·XOUT' + XOUT = K·XIN, ω = 1/T",
      .meaning =
          "A mass on a spring, a current loop, a resonance: undamped natural frequency ω = 1/T, damping ratio ZETA. "
          "Exact at the samples for an input that runs straight between them (ramp-invariant), for every damping. It "
          "is written with T rather than ω so that T = 0, K = 1 passes the input through. For T below TS/π the "
          "oscillation lies above half the sample rate and cannot be seen: there XOUT = K·(XIN − 2·ZETA·T·XIN'). It "
          "starts as if the first input had stood for ever; with SETTLED FALSE at X0, at rest. R1 loads X0, at rest. "
          "Parts of the state below 1e-36 count as 0, so that no denormal numbers arise.",
      .delay =
          "2·ZETA·T at low frequency; gain K/√((1 − (ωT)²)² + (2·ZETA·ωT)²) up to factors (sin(ωTS/2)/(ωTS/2))² of "
          "the straight line.",
      .source = "ramp-invariant discretisation; K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed.",
      .effect = "resonance",
      .family = Family::LinearDynamics};

  template <class S>
  struct Params {
    S K;
    S T;
    S ZETA;
    Bool<S> SETTLED;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(K).in("'y/'x").otherwise(1.0).neutral_at(1.0).means("gain at rest"),
          HY_FIELD(T).in("s").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("1/ω, of the undamped oscillation"),
          HY_FIELD(ZETA)
              .in("1")
              .within(0.0, 100.0)
              .effect_up_to(0.8)
              .otherwise(0.7)
              .means("damping ratio; 1 is critical"),
          HY_FIELD(SETTLED).otherwise(1.0).means("starts as if the first input had stood for ever; FALSE: at X0")};
    }
  };
  template <class S>
  struct State {
    S X1;
    S DEVIATION1;
    S RATE1;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(X1).role(FieldRole::PastInput).in("'x").otherwise(0.0).means("input one sample ago"),
                    HY_FIELD(DEVIATION1).in("'x").otherwise(0.0).means("deviation one sample ago"),
                    HY_FIELD(RATE1).in("'x/s").otherwise(0.0).means("rate one sample ago"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen")};
    }
  };
  template <class S>
  struct In {
    S XIN;
    Bool<S> R1;
    S X0;
    using Self = In;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XIN).in("'x").means("signal"),
                    HY_FIELD(R1).otherwise(0.0).means("reset: loads X0, at rest"),
                    HY_FIELD(X0)
                        .role(FieldRole::StartValue)
                        .in("'y")
                        .otherwise(0.0)
                        .means("output at a reset, and at the start if not SETTLED")};
    }
  };
  template <class S>
  struct Out {
    S XOUT;
    S DEVIATION;
    S RATE;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'y").means("response"),
                    HY_FIELD(DEVIATION).in("'x").means("how far XOUT/K is from XIN"),
                    HY_FIELD(RATE).role(FieldRole::Rate).in("'x/s").means("rate of change of XOUT/K")};
    }
  };

  template <class S>
  struct Coefficients {
    S delay;   ///< 2·ZETA·T, by which the response to a ramp is late
    S period;  ///< T, but at least TS/π
    OscillationStep<S> step;
  };

  template <class S>
  static Coefficients<S> coefficients(const Params<S>& params, const S& ts) {
    const S period = max(params.T, ts * S(0.31830988618379067));  // TS/π
    return {
        .delay = S(2.0) * params.ZETA * params.T, .period = period, .step = oscillation_step(params.ZETA, ts / period)};
  }
  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.X1 = S(0.0), .DEVIATION1 = S(0.0), .RATE1 = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return output(params, coefficients(params, ts), state, in, ts);
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const Coefficients<S>& coefficients, const State<S>& state,
                       const In<S>& in, const S& ts) {
    const Bool<S> load = in.R1 || (!state.STARTED && !params.SETTLED);
    const Bool<S> has_gain = params.K != S(0.0);

    // While the input runs along the ramp of slope r, the response runs along the same ramp, late by 2·ZETA·T; what
    // deviates from that is a free oscillation.
    const S ramp = (in.XIN - select(state.STARTED, state.X1, in.XIN)) / ts;
    const S late = coefficients.delay * ramp;
    const S& period = coefficients.period;
    const Oscillation<S> before{.position = state.DEVIATION1 + late, .velocity = period * (state.RATE1 - ramp)};
    const Oscillation<S> after = oscillate(before, coefficients.step);
    const Bool<S> visible = params.T >= period;
    const S deviation = either<S>(
        load, [&] { return select(has_gain, in.X0 / select(has_gain, params.K, S(1.0)) - in.XIN, S(0.0)); },
        [&] { return without_denormals(select(visible, after.position, S(0.0)) - late); });
    const S rate = without_denormals(ramp + select(visible, after.velocity, S(0.0)) / period);
    return {.XOUT = select(load, in.X0, params.K * (in.XIN + deviation)),
            .DEVIATION = deviation,
            .RATE = select(load, S(0.0), rate)};
  }
  template <class S>
  static void update(const Params<S>& /*params*/, State<S>& state, const In<S>& in, const Out<S>& out,
                     const S& /*ts*/) {
    state = {.X1 = in.XIN, .DEVIATION1 = out.DEVIATION, .RATE1 = out.RATE, .STARTED = Bool<S>(true)};
  }
};

}  // namespace hysteron
