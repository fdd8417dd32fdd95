// A gap that is not the same everywhere: the mean of three like it, with the widths W·(1 − s), W and W·(1 + s). Shared
// by HY_BACKLASH and HY_DEAD_BAND: contacts that are soft, or that close one after the other.
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

/// Something for each of the three.
template <class S>
struct OfThree {
  S middle;
  S narrow;
  S wide;

  /// Their mean; the middle one itself where they are equal, infinite ones too.
  [[nodiscard]] S mean() const {
    const S other = ((narrow - middle) + (wide - middle)) * S(1.0 / 3.0);
    return with_term<S>(middle, select(narrow == middle && wide == middle, S(0.0), other));
  }
};

/// The parameters of such a gap.
template <class S>
struct GapParams {
  S WIDTH;
  S SPREAD;
  using Self = GapParams;
  static constexpr auto fields() {
    return Fields{
        HY_FIELD(WIDTH).in("'x").otherwise(0.0).at_least(0.0).neutral_at(0.0).means(
            "whole width of the gap, half of it on either side"),
        HY_FIELD(SPREAD)
            .role(FieldRole::Softness)
            .in("1")
            .within(0.0, 1.0)
            .otherwise(0.0)
            .means("share of WIDTH by which a third of the gap is narrower and a third wider; 0 for sharp edges")};
  }
  [[nodiscard]] OfThree<S> widths() const {
    return {.middle = WIDTH, .narrow = WIDTH * (S(1.0) - SPREAD), .wide = WIDTH * (S(1.0) + SPREAD)};
  }
};

}  // namespace hysteron
