// A cycle over a position with its harmonics: what HY_CYCLIC_ERROR and HY_CYCLIC_FORCE add.
#pragma once

#include "blocks/ripple.hpp"

namespace hysteron {

/// Four harmonics over a position.
template <class S, Label unit, Label period>
struct CycleParams : RippleParams<S, unit, period> {
  S SINE2;
  S COSINE2;
  S SINE3;
  S COSINE3;
  S SINE4;
  S COSINE4;
  using Self = CycleParams;
  static constexpr auto fields() {
    const auto amplitude = [](auto field, std::string_view meaning) {
      return field.in("'x").otherwise(0.0).neutral_at(0.0).means(meaning);
    };
    return concatenate(RippleParams<S, unit, period>::fields(),
                       Fields{amplitude(HY_FIELD(SINE2), "sine of the second harmonic, two a period"),
                              amplitude(HY_FIELD(COSINE2), "cosine of the second harmonic"),
                              amplitude(HY_FIELD(SINE3), "sine of the third harmonic"),
                              amplitude(HY_FIELD(COSINE3), "cosine of the third harmonic"),
                              amplitude(HY_FIELD(SINE4), "sine of the fourth harmonic"),
                              amplitude(HY_FIELD(COSINE4), "cosine of the fourth harmonic")});
  }
  /// The sum of the harmonics at a place in periods.
  [[nodiscard]] S cycle(const S& turns) const {
    const S first = ripple<S>(this->SINE, this->COSINE, turns);
    const S second = ripple<S>(SINE2, COSINE2, S(2.0) * turns);
    const S third = ripple<S>(SINE3, COSINE3, S(3.0) * turns);
    const S fourth = ripple<S>(SINE4, COSINE4, S(4.0) * turns);
    return ((first + second) + third) + fourth;
  }
};

}  // namespace hysteron
