// HY_HYSTERESIS_GENERAL: HY_HYSTERESIS_RO with asymmetry, dependence on rate and bias, shape, return-point memory
#pragma once

#include "blocks/bouc_wen.hpp"
#include "blocks/effect_term.hpp"
#include "blocks/hysteresis_ro.hpp"
#include "blocks/return_points.hpp"
#include "blocks/rich_loop.hpp"

namespace hysteron {

struct HysteresisGeneral {
  static constexpr About about{
      .name = "HY_HYSTERESIS_GENERAL",
      .title = "Ramberg-Osgood hysteresis with the effects it lacks",
      .group = Group::Memory,
      .equation =
          "XOUT = y_i + (C1·d + (1 ± ASYMMETRY)·G(d) + B(d))·(1 + BIAS·(m − U0)/BIAS_REFERENCE) + D + R + W; d = XIN − "
          "u_i, p = |d|, e = ±ASYMMETRY_EXPONENT, G = d·C2·p^C3·(p/ASYMMETRY_REFERENCE)^e/(C3+e+1), B = "
          "SHAPE·C1·d·(1 − (1 − exp(−z))/z), z = p/SHAPE_DEPTH, m = (u_i + XIN)/2; D is the integral of "
          "(M(p)·DUHEM/DUHEM_REFERENCE + C2·p^C3·HARDENING/HARDENING_REFERENCE)·(u − U0) along the branch; R collects "
          "G's increments times RATE·log10(1 + |XIN'|/RATE_REFERENCE); W = BOUC_WEN·C1·z, "
          "z' = XIN' − β|XIN'|z − γXIN'|z|, β + γ = 1/BOUC_WEN_TRAVEL, 2γ/(β + γ) = BOUC_WEN_SKEW; on the skeleton p = "
          "2|d|",
      .meaning =
          "HY_HYSTERESIS_RO, to the bit, where all its further parameters are 0. ASYMMETRY makes C2 larger upwards "
          "and smaller downwards, ASYMMETRY_EXPONENT does so with C3; a loop then no longer closes, and wanders by "
          "the difference in each cycle. RATE lets the growth depend on the rate within each sample. BIAS changes the "
          "slopes with the middle m of the branch, so that equal loops differ with their bias, and each closes. DUHEM "
          "does so by Duhem's form: the slope follows the input itself, and a loop wanders as it does with an "
          "asymmetry; HARDENING is the same of the part C2*p^C3 alone. SHAPE changes the slope from C1 at the "
          "branching point by SHAPE·C1 within the momentum SHAPE_DEPTH: C1, C2 and C3 have no such bend. "
          "BOUC_WEN adds Bouc and Wen's element in parallel, whose z goes on from where it stood at a reversal, and so "
          "remembers more than the last branching point. "
          "RETURN_POINT blends the output with that of a hysteresis which, when a loop closes, resumes the branch "
          "before it: 0 is the paper's memory of the last branching point, 1 full return-point memory of 8 "
          "interrupted branches; a deeper nesting forgets the innermost loop. Where a loop closes that way R begins "
          "anew at 0, and an asymmetry gives a jump. P, SLOPE and Q are those of the memory of the last branching "
          "point.",
      .delay = "None.",
      .source =
          "Strijbosch and Oomen, equations (2), (3) and (17); E. Madelung, Ann. Phys. 17 (1905) 861, for return "
          "points; Y. K. Wen, J. Eng. Mech. Div. 102 (1976) 249, with n = 1",
      .enriches = "HY_HYSTERESIS_RO"};

  template <class S>
  using Rich = RichParams<S, HysteresisRo::Params<S>, "'x/s", "the rate of XIN", "'x", "U0", "'x">;
  template <class S>
  struct Params : Rich<S> {
    S BOUC_WEN;
    S BOUC_WEN_TRAVEL;
    S BOUC_WEN_SKEW;
    S RETURN_POINT;
    using Self = Params;
    static constexpr auto fields() {
      return concatenate(
          Rich<S>::fields(),
          Fields{HY_FIELD(BOUC_WEN)
                     .in("1")
                     .within(-1.0, 1.0)
                     .otherwise(0.0)
                     .neutral_at(0.0)
                     .effect("curve_shape", Family::Hysteresis)
                     .means("slope of Bouc and Wen's element where it begins, over C1"),
                 HY_FIELD(BOUC_WEN_TRAVEL)
                     .shapes("BOUC_WEN")
                     .in("'x")
                     .above(0.0)
                     .otherwise(1.0)
                     .means("what that element reaches at most, and over which it does so"),
                 HY_FIELD(BOUC_WEN_SKEW)
                     .shapes("BOUC_WEN")
                     .in("1")
                     .within(0.0, 0.9)
                     .otherwise(0.5)
                     .means("share by which it bends less while it is undone; 0 for Dahl's element"),
                 HY_FIELD(RETURN_POINT)
                     .in("1")
                     .within(0.0, 1.0)
                     .otherwise(0.0)
                     .neutral_at(0.0)
                     .effect("return_point_memory", Family::Hysteresis)
                     .means("0: remembers the last branching point; 1: resumes a branch when the loop in it closes")});
    }
  };
  template <class S>
  struct State : BranchMemory<S> {
    S LAST_X;
    S RATE_PART;
    S EXTREME_W;
    S START_X;
    S START_Y;
    S RATE_PART_W;
    Bool<S> ON_SKELETON;
    Bool<S> VIRGIN;
    Int<S> STARTS;
    ReturnPoints<S> STARTS_X;
    ReturnPoints<S> STARTS_Y;
    Bool<S> MOVING;
    S BOUC_WEN_Z;
    using Self = State;
    static constexpr auto fields() {
      return concatenate(
          BranchMemory<S>::fields(),
          Fields{HY_FIELD(LAST_X).in("'x").otherwise(0.0).means("input one sample ago"),
                 HY_FIELD(RATE_PART).in("'y").otherwise(0.0).means("R on this branch"),
                 HY_FIELD(EXTREME_W).in("'y").otherwise(0.0).means("output at the extreme, with return points"),
                 HY_FIELD(START_X).in("'x").otherwise(0.0).means("start of the branch, with return points"),
                 HY_FIELD(START_Y).in("'y").otherwise(0.0).means("output there"),
                 HY_FIELD(RATE_PART_W).in("'y").otherwise(0.0).means("R on that branch"),
                 HY_FIELD(ON_SKELETON).otherwise(1.0).means("that branch is the skeleton"),
                 HY_FIELD(VIRGIN).otherwise(1.0).means("the motion began on the skeleton"),
                 HY_FIELD(STARTS).otherwise(0.0).means("interrupted branches below that one"),
                 HY_FIELD(STARTS_X).in("'x").otherwise(0.0).means("their starts, the innermost last"),
                 HY_FIELD(STARTS_Y).in("'y").otherwise(0.0).means("outputs there"),
                 HY_FIELD(MOVING).otherwise(0.0).means("a sample has been seen, so that there is a rate"),
                 HY_FIELD(BOUC_WEN_Z).in("'x").otherwise(0.0).means("z of Bouc and Wen's element")});
    }
  };
  template <class S>
  using In = HysteresisRo::In<S>;
  template <class S>
  using Out = HysteresisRo::Out<S>;

  /// Where one memory puts a sample.
  template <class S>
  struct Place {
    S y;
    S slope;
    S momentum;
    S rate_part;
  };
  /// What the present sample is in both memories.
  template <class S>
  struct Sample {
    BranchOfSample<S> branch;
    ResumedBranch<S> resumed;
    Place<S> last;     ///< with the memory of the last branching point
    Place<S> returns;  ///< with return points
    BoucWenPlace<S> parallel;
  };

  template <class S>
  static State<S> initial(const Params<S>& params) {
    State<S> state{};
    begin(params, state);
    fill(state.STARTS_X, S(0.0));
    fill(state.STARTS_Y, S(0.0));
    return state;
  }
  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& ts) {
    return placed(params, find(params, held(params, state, in), in, ts));
  }
  template <class S>
  static void update(const Params<S>& params, State<S>& state, const In<S>& in, const Out<S>& /*out*/, const S& ts) {
    const State<S> before = held(params, state, in);
    move_on(state, before, find(params, before, in, ts), in);
  }
  template <class S>
  static Out<S> step(const Params<S>& params, State<S>& state, const In<S>& in, const S& ts) {
    const State<S> before = held(params, state, in);
    const Sample<S> sample = find(params, before, in, ts);
    move_on(state, before, sample, in);
    return placed(params, sample);
  }

 private:
  template <class S>
  static Out<S> placed(const Params<S>& params, const Sample<S>& sample) {
    const S part = params.BOUC_WEN * params.C1;
    const S loops = with_term<S>(sample.last.y, params.RETURN_POINT * (sample.returns.y - sample.last.y));
    return {.XOUT = with_term<S>(loops, part * sample.parallel.z),
            .P = sample.last.momentum,
            .SLOPE = with_term<S>(sample.last.slope, part * sample.parallel.slope),
            .Q = sample.branch.course.turned};
  }
  template <class S>
  static void move_on(State<S>& state, const State<S>& before, const Sample<S>& sample, const In<S>& in) {
    const ResumedBranch<S>& resumed = sample.resumed;
    // The start of an interrupted branch goes on the stack at a reversal; a ninth replaces the innermost loop.
    const Int<S> place = before.STARTS;
    store(state.STARTS_X, place, select(pushes(before, sample), before.START_X, at(state.STARTS_X, place)));
    store(state.STARTS_Y, place, select(pushes(before, sample), before.START_Y, at(state.STARTS_Y, place)));
    const BranchMemory<S> memory = remember<S>(before, sample.branch, in.XIN, sample.last.y);
    state.HEADING = memory.HEADING;
    state.EXTREME_X = memory.EXTREME_X;
    state.EXTREME_Y = memory.EXTREME_Y;
    state.BRANCH_X = memory.BRANCH_X;
    state.BRANCH_Y = memory.BRANCH_Y;
    state.SKELETON = memory.SKELETON;
    state.LAST_X = in.XIN;
    state.RATE_PART = sample.last.rate_part;
    state.EXTREME_W = select(sample.branch.course.advanced, sample.returns.y, before.EXTREME_W);
    state.START_X = resumed.x;
    state.START_Y = resumed.y;
    state.RATE_PART_W = sample.returns.rate_part;
    state.ON_SKELETON = resumed.skeleton;
    state.VIRGIN = resumed.virgin;
    state.STARTS = resumed.count;
    state.MOVING = Bool<S>(true);
    state.BOUC_WEN_Z = sample.parallel.z;
  }
  /// Sets all but the starts on the stack, which count for nothing while STARTS is 0.
  template <class S>
  static void begin(const Params<S>& params, State<S>& state) {
    static_cast<BranchMemory<S>&>(state) = begin_branch<S>(params.START, params.U0, params.Y0);
    state.LAST_X = params.U0;
    state.RATE_PART = S(0.0);
    state.EXTREME_W = params.Y0;
    state.START_X = params.U0;
    state.START_Y = params.Y0;
    state.RATE_PART_W = S(0.0);
    state.ON_SKELETON = params.START == Int<S>(0);
    state.VIRGIN = params.START == Int<S>(0);
    state.STARTS = Int<S>(0);
    state.MOVING = Bool<S>(false);
    state.BOUC_WEN_Z = S(0.0);
  }
  /// What is remembered before the present sample.
  template <class S>
  static State<S> held(const Params<S>& params, const State<S>& state, const In<S>& in) {
    if constexpr (is_number<S>) {
      if (!in.R1) {
        return state;  // as below, without a dozen choices
      }
    }
    State<S> fresh = state;
    begin(params, fresh);
    State<S> result = state;
    static_cast<BranchMemory<S>&>(result) = select_memory<S>(in.R1, fresh, state);
    result.LAST_X = select(in.R1, fresh.LAST_X, state.LAST_X);
    result.RATE_PART = select(in.R1, fresh.RATE_PART, state.RATE_PART);
    result.EXTREME_W = select(in.R1, fresh.EXTREME_W, state.EXTREME_W);
    result.START_X = select(in.R1, fresh.START_X, state.START_X);
    result.START_Y = select(in.R1, fresh.START_Y, state.START_Y);
    result.RATE_PART_W = select(in.R1, fresh.RATE_PART_W, state.RATE_PART_W);
    result.ON_SKELETON = select(in.R1, fresh.ON_SKELETON, state.ON_SKELETON);
    result.VIRGIN = select(in.R1, fresh.VIRGIN, state.VIRGIN);
    result.STARTS = select(in.R1, fresh.STARTS, state.STARTS);
    result.MOVING = select(in.R1, fresh.MOVING, state.MOVING);
    result.BOUC_WEN_Z = select(in.R1, fresh.BOUC_WEN_Z, state.BOUC_WEN_Z);
    return result;
  }
  /// Whether the sample interrupts a branch that has a start.
  template <class S>
  static Bool<S> pushes(const State<S>& before, const Sample<S>& sample) {
    return sample.branch.course.turned && !before.ON_SKELETON;
  }

  /// The sample on a branch from (x, y): `from` is where the sample before lay on the same branch.
  template <class S>
  static Place<S> place(const Params<S>& params, const S& x, const S& y, const Bool<S>& skeleton, const S& from,
                        const S& input, const S& share, const S& rate_part) {
    const LoopConstants<S> loop = params.loop();
    const LoopEffects<S> effects = params.effects(params.U0);
    const S twice = select(skeleton, S(2.0), S(1.0));
    const S distance = input - x;
    const S momentum = abs(distance) * twice;
    const S travelled = from - x;
    const RichRise<S> here = rich_rise<S>(loop, effects, x, distance, momentum, distance < S(0.0));
    const S by_rate = rate_part + unless_zero(share, S(0.0), [&] {
                        const RichGrowth<S> there =
                            rich_growth<S>(loop, effects, x, travelled, abs(travelled) * twice, travelled < S(0.0));
                        return share * (here.growth - there.whole());
                      });
    return {.y = with_term<S>(y + here.plain, here.excess + by_rate),
            .slope = with_term<S>(here.plain_slope, here.slope + share * here.growth_slope),
            .momentum = momentum,
            .rate_part = by_rate};
  }

  template <class S>
  static Sample<S> find(const Params<S>& params, const State<S>& before, const In<S>& in, const S& ts) {
    const BranchOfSample<S> branch = find_branch<S>(before, in.XIN, params.EPS);
    const Bool<S> turned = branch.course.turned;
    const S rate = select(before.MOVING, (in.XIN - before.LAST_X) / ts, S(0.0));
    const S share = rate_share<S>(params.RATE, rate, params.RATE_REFERENCE);
    const Place<S> last = place<S>(params, branch.x, branch.y, branch.skeleton, select(turned, branch.x, before.LAST_X),
                                   in.XIN, share, select(turned, S(0.0), before.RATE_PART));

    const Bool<S> pushed = turned && !before.ON_SKELETON;
    constexpr auto most = static_cast<std::int32_t>(return_points);
    const Int<S> more = select(before.STARTS < Int<S>(most), before.STARTS + Int<S>(1), Int<S>(most - 1));
    const ResumedBranch<S> begun{.x = select(turned, before.EXTREME_X, before.START_X),
                                 .y = select(turned, before.EXTREME_W, before.START_Y),
                                 .skeleton = before.ON_SKELETON && !turned,
                                 .virgin = before.VIRGIN,
                                 .count = select(pushed, more, before.STARTS),
                                 .closed = Bool<S>(false)};
    const InterruptedStarts<S> starts{.x = before.STARTS_X,
                                      .y = before.STARTS_Y,
                                      .pushed = pushed,
                                      .place = before.STARTS,
                                      .pushed_x = before.START_X,
                                      .pushed_y = before.START_Y};
    const ResumedBranch<S> resumed =
        close_loops<S>(starts, begun, params.U0, params.Y0, in.XIN, branch.course.heading < Int<S>(0));
    const S from = select(resumed.closed, in.XIN, select(turned, resumed.x, before.LAST_X));
    const Place<S> returns = place<S>(params, resumed.x, resumed.y, resumed.skeleton, from, in.XIN, share,
                                      select(turned || resumed.closed, S(0.0), before.RATE_PART_W));
    const BoucWenPlace<S> parallel =
        bouc_wen<S>({.travel = params.BOUC_WEN_TRAVEL, .skew = params.BOUC_WEN_SKEW}, before.BOUC_WEN_Z,
                    in.XIN - before.LAST_X, branch.course.heading < Int<S>(0));
    return {.branch = branch, .resumed = resumed, .last = last, .returns = returns, .parallel = parallel};
  }
};

}  // namespace hysteron
