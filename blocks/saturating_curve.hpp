// HY_SATURATING_CURVE: XOUT = CENTRE + d·tanh(z)/z, d = XIN − CENTRE, z = √BEND·d/REFERENCE
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct SaturatingCurve : Stateless {
  static constexpr About about{
      .name = "HY_SATURATING_CURVE",
      .title = "Saturating curve",
      .group = Group::Shaping,
      .equation = "XOUT = CENTRE + d·tanh(z)/z, d = XIN − CENTRE, z = √BEND·d/REFERENCE",
      .meaning =
          "A characteristic of slope 1 at CENTRE that bends towards a limit on both sides and never reaches it: a "
          "magnet that saturates, a steering linkage, a soft amplifier. The limit is REFERENCE/√BEND from CENTRE; at "
          "the distance REFERENCE a small BEND takes the share BEND/3 off. BEND counts by its first power, so that a "
          "fit that starts from 0 has a slope there. HY_LIMIT has sharp edges.",
      .source = "tanh as the power series 1 − z²/3 + 2z⁴/15 − … where z² is small; Abramowitz and Stegun 4.5.64",
      .effect = "saturating_curve",
      .family = Family::StaticCurve,
      .untried = "an odd bend is its twin until a search compares families"};

  template <class S>
  struct Params {
    S BEND;
    S CENTRE;
    S REFERENCE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(BEND).in("1").within(0.0, 1e6).otherwise(0.0).neutral_at(0.0).means(
                        "square of REFERENCE over the limit"),
                    HY_FIELD(CENTRE).role(FieldRole::Centre).in("'x").otherwise(0.0).means("signal without error"),
                    HY_FIELD(REFERENCE)
                        .role(FieldRole::ReferenceSize)
                        .in("'x")
                        .above(0.0)
                        .otherwise(1.0)
                        .means("distance from CENTRE that BEND refers to")};
    }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal, bent towards a limit">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S distance = in.XIN - params.CENTRE;
    const S z = distance / params.REFERENCE;
    return {.XOUT = with_term<S>(in.XIN, distance * lost_share(params.BEND * (z * z)))};
  }

 private:
  /// tanh(z)/z − 1 from z²: by its series below 1/64, where the difference would lose digits.
  template <class S>
  static S lost_share(const S& square) {
    const Bool<S> small = square < S(0.015625);
    const S q = select(small, square, S(0.015625));
    const S series =
        -(q * (S(1.0 / 3.0) -
               q * (S(2.0 / 15.0) -
                    q * (S(17.0 / 315.0) -
                         q * (S(62.0 / 2835.0) - q * (S(1382.0 / 155925.0) - q * (S(21844.0 / 6081075.0) -
                                                                                  q * S(929569.0 / 638512875.0))))))));
    const S z = sqrt(select(small, S(1.0), square));
    const S decay = exp(S(-2.0) * z);
    return select(small, series, (S(1.0) - decay) / ((S(1.0) + decay) * z) - S(1.0));
  }
};

}  // namespace hysteron
