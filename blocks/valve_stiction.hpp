// HY_VALVE_STICTION: XOUT(k) = XOUT(k−1) while |XIN − XOUT(k−1)| < (STICK + JUMP)/2, then XIN ∓ (STICK − JUMP)/2
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct ValveStiction {
  static constexpr About about{
      .name = "HY_VALVE_STICTION",
      .title = "Sticking valve",
      .group = Group::Shaping,
      .equation =
          "XOUT(k) = XIN(k) − s·(STICK − JUMP)/2 while the stem moves in the direction s = ±1, else XOUT(k−1); it "
          "moves once |XIN(k) − XOUT(k−1)| >= (STICK + JUMP)/2, and stops where XIN turns back or rests",
      .meaning =
          "The stem of a valve that its packing holds: the command XIN has to move by STICK after a reversal, and by "
          "JUMP after a stop, before the stem slips; it slips by JUMP at once and follows (STICK − JUMP)/2 behind. "
          "With JUMP = 0 it is HY_BACKLASH; with JUMP = STICK it slips onto the command, and with a larger one beyond "
          "it. START says where in the band the first sample lies, as of HY_BACKLASH: 0 in its middle, 1 where a step "
          "downwards and -1 where a step upwards would move the stem at once.",
      .source =
          "M. A. A. S. Choudhury, N. F. Thornhill, S. L. Shah, Control Eng. Pract. 13 (2005) 641, for S and J; Q. P. "
          "He, J. Wang, M. Pottmann, S. J. Qin, Ind. Eng. Chem. Res. 46 (2007) 4549, for the difference that is held",
      .effect = "valve_stiction",
      .family = Family::DryFriction,
      .untried = "a loop with a sticking valve oscillates by itself, and is judged by its shape"};

  template <class S>
  struct Params {
    S STICK;
    S JUMP;
    S START;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{
          HY_FIELD(STICK).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means("command that a reversal takes"),
          HY_FIELD(JUMP).in("'x").at_least(0.0).otherwise(0.0).neutral_at(0.0).means(
              "by how much the stem slips at once"),
          HY_FIELD(START).in("1").within(-1.0, 1.0).otherwise(0.0).means("place of the first sample in the band")};
    }
    /// The difference of command and stem that the static friction holds.
    [[nodiscard]] S held() const { return S(0.5) * (STICK + JUMP); }
    /// The difference while the stem moves.
    [[nodiscard]] S behind() const { return S(0.5) * (STICK - JUMP); }
  };
  template <class S>
  struct State {
    S LAST;
    S X1;
    S WAY;
    Bool<S> STARTED;
    using Self = State;
    static constexpr auto fields() {
      return Fields{HY_FIELD(LAST).in("'x").otherwise(0.0).means("position of the stem in the step before"),
                    HY_FIELD(X1).role(FieldRole::PastInput).in("'x").otherwise(0.0).means("command one sample ago"),
                    HY_FIELD(WAY).in("1").otherwise(0.0).means("1 while the stem moves up, -1 down, 0 at rest"),
                    HY_FIELD(STARTED).otherwise(0.0).means("TRUE after the first step")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "command">;
  template <class S>
  using Out = Xout<S, "'x", "position of the stem">;

  template <class S>
  static State<S> initial(const Params<S>& /*params*/) {
    return {.LAST = S(0.0), .X1 = S(0.0), .WAY = S(0.0), .STARTED = Bool<S>(false)};
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    return {.XOUT = stem(params, state, in).position};
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/,
                     const S& /*ts*/) {
    const Stem<S> now = stem(params, state, in);
    state = {.LAST = now.position, .X1 = in.XIN, .WAY = now.way, .STARTED = Bool<S>(true)};
  }

 private:
  template <class S>
  struct Stem {
    S position;
    S way;
  };
  template <class S>
  static Stem<S> stem(const Params<S>& params, const State<S>& state, const In<S>& in) {
    const S start = with_term<S>(in.XIN, params.START * params.held());
    const S last = select(state.STARTED, state.LAST, start);
    const S difference = in.XIN - last;
    const Bool<S> goes_on = state.WAY * (in.XIN - state.X1) > S(0.0);
    // In the first step too: where nothing is held, the command passes as it is.
    const Bool<S> slips = abs(difference) >= params.held();
    const S way = select(goes_on, state.WAY, select(difference < S(0.0), S(-1.0), S(1.0)));
    const Bool<S> moves = goes_on || slips;
    return {.position = select(moves, with_term<S>(in.XIN, -(way * params.behind())), last),
            .way = select(moves, way, S(0.0))};
  }
};

}  // namespace hysteron
