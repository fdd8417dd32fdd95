// HY_CREEP: after a step of s, XOUT = s·(1 + GAIN·log10(1 + t/T_ONSET))
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/filtered_rate.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct Creep {
  static constexpr About about{
      .name = "HY_CREEP",
      .title = "Logarithmic creep",
      .group = Group::Dynamics,
      .equation =
          "XOUT = XIN + GAIN·Σ w_i·x_i, τ_i·x_i' + x_i = XIN, τ_i = T_ONSET·10^(i/2), i = -1 … 11; "
          "with SINCE_START the sum less what it is in the first step",
      .meaning =
          "Creep of a piezo actuator or of a material: after a step of s the output is s·(1 + GAIN·log10(1 + "
          "t/T_ONSET)), and so for every past input, linearly. It is a sum of 13 first-order lags, two a decade, exact "
          "for an input that runs straight between its samples. The sum is the logarithm to 0.004 of a decade for "
          "times up to 10^5·T_ONSET, and ends at 5.77 decades. SETTLED starts as HY_LAG does: the first input has "
          "stood "
          "for ever and has crept all it can. A logarithm has no end, so that a gain measured on a machine at rest "
          "holds "
          "what has crept by then: SINCE_START counts from there.",
      .source =
          "log(1 + t/T) as an integral of exponentials over ln τ with the weight exp(−T/τ), by the trapezoidal rule; "
          "H. Jung, J. Y. Shim, D. Gweon, Rev. Sci. Instrum. 71 (2000) 3436, for the law",
      .effect = "creep",
      .family = Family::SlowMemory};

  static constexpr std::size_t lags = 13;
  /// τ_i/T_ONSET, two a decade.
  static constexpr std::array<double, lags> times{
      0.31622776601683794, 1.0,     3.1622776601683795, 10.0,     31.622776601683793, 100.0, 316.22776601683796, 1000.0,
      3162.2776601683795,  10000.0, 31622.776601683792, 100000.0, 316227.7660168379};
  /// exp(−T_ONSET/τ_i)/2 in decades. The last stands for all the slower ones, and is as much larger as makes up for
  /// their rates: 10^(1/4)/ln 10.
  static constexpr std::array<double, lags> weights{
      0.021164609811602505, 0.18393972058572117, 0.3644467070550123, 0.45241870901797976, 0.4844359971700377,
      0.49502491687458405,  0.49842135853676645, 0.4995002499166875, 0.49984191111435655, 0.49995000249991667,
      0.49998418886169654,  0.4999950000249999,  0.7722969350620742};

  template <class S>
  struct Params {
    S GAIN;
    S T_ONSET;
    Bool<S> SETTLED;
    Bool<S> SINCE_START;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(GAIN).in("1").otherwise(0.0).neutral_at(0.0).means("share of a step, per decade"),
          HY_FIELD(T_ONSET).in("s").above(0.0).otherwise(0.1).means("time from which it creeps"),
          HY_FIELD(SETTLED).otherwise(1.0).means("starts as if the first input had stood for ever; FALSE: as if 0 had"),
          HY_FIELD(SINCE_START)
              .otherwise(0.0)
              .either_way()
              .means("TRUE: what has crept before the first step is in XIN already, and XOUT starts as "
                     "XIN")};
    }
  };
  template <class S>
  struct State {
    Array<S, lags> RATES;
    S X1;
    Bool<S> STARTED;
    S FIRST;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(RATES).in("'x/s").otherwise(0.0).means("rates of the lags one sample ago"),
                    HY_FIELD(X1).in("'x").otherwise(0.0).means("input one sample ago"),
                    HY_FIELD(STARTED).otherwise(0.0).means("a sample has been seen"),
                    HY_FIELD(FIRST).in("'x").otherwise(0.0).means("the sum in the first step")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal that creeps">;

  /// Of each lag.
  template <class S>
  struct Coefficients {
    std::array<S, lags> time;       ///< τ_i
    std::array<S, lags> forgotten;  ///< 1 − exp(−TS/τ_i)
  };

  template <class S>
  static Coefficients<S> coefficients(const Params<S>& params, const S& ts) {
    Coefficients<S> result{};
    for (std::size_t i = 0; i < lags; ++i) {
      result.time[i] = params.T_ONSET * S(times[i]);
      result.forgotten[i] = forgotten_part(result.time[i], ts);
    }
    return result;
  }

  /// The lags at the present sample.
  template <class S>
  struct Lagged {
    std::array<S, lags> rates;
    S sum;  ///< Σ w_i·x_i
  };
  template <class S>
  static Lagged<S> lagged(const Params<S>& params, const Coefficients<S>& coefficients, const State<S>& state,
                          const In<S>& in, const S& ts) {
    const S slope = (in.XIN - select(state.STARTED, state.X1, in.XIN)) / ts;
    Lagged<S> result{};
    for (std::size_t i = 0; i < lags; ++i) {
      result.rates[i] = started_rate<S>({.start = !state.STARTED,
                                         .settled = params.SETTLED,
                                         .rate = at(state.RATES, Int<S>(static_cast<std::int32_t>(i))),
                                         .slope = slope},
                                        in.XIN, coefficients.time[i], coefficients.forgotten[i]);
    }
    result.sum = S(0.0);
    for (std::size_t i = 0; i < lags; ++i) {
      result.sum = result.sum + S(weights[i]) * (in.XIN - coefficients.time[i] * result.rates[i]);
    }
    return result;
  }

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    State<S> state{};
    fill(state.RATES, S(0.0));
    state.X1 = S(0.0);
    state.STARTED = Bool<S>(false);
    state.FIRST = S(0.0);
    return state;
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return output(params, coefficients(params, ts), state, in, ts);
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const Coefficients<S>& coefficients, const State<S>& state,
                       const In<S>& in, const S& ts) {
    return crept<S>(params, state, in, lagged(params, coefficients, state, in, ts));
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& out, const S& ts) {
    update(params, coefficients(params, ts), state, in, out, ts);
  }
  template <class S>
  static void update(const Params<S>& params, const Coefficients<S>& coefficients, State<S>& state, const In<S>& in,
                     const Out<S>& /*out*/, const S& ts) {
    move_on<S>(state, in, lagged(params, coefficients, state, in, ts));
  }
  template <class S>
  static Out<S> step(const Params<S>& params, const Coefficients<S>& coefficients, State<S>& state, const In<S>& in,
                     const S& ts) {
    const Lagged<S> now = lagged(params, coefficients, state, in, ts);
    const Out<S> out = crept<S>(params, state, in, now);
    move_on<S>(state, in, now);
    return out;
  }
  template <class S>
  static Out<S> step(const Params<S>& params, State<S>& state, const In<S>& in, const S& ts) {
    return step(params, coefficients(params, ts), state, in, ts);
  }

 private:
  template <class S>
  static Out<S> crept(const Params<S>& params, const State<S>& state, const In<S>& in, const Lagged<S>& now) {
    const S whole = since_start(params.SINCE_START, state, now.sum);
    return {.XOUT = with_term<S>(in.XIN, params.GAIN * whole)};
  }
  template <class S>
  static void move_on(State<S>& state, const In<S>& in, const Lagged<S>& now) {
    state.FIRST = select(state.STARTED, state.FIRST, now.sum);
    for (std::size_t i = 0; i < lags; ++i) {
      store(state.RATES, Int<S>(static_cast<std::int32_t>(i)), now.rates[i]);
    }
    state.X1 = in.XIN;
    state.STARTED = Bool<S>(true);
  }
};

}  // namespace hysteron
