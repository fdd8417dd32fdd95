// What HY_EVEN_NONLINEARITY and HY_ODD_NONLINEARITY share: all but the power.
#pragma once

#include "blocks/effect_term.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

struct Nonlinearity : Stateless {
  template <class S>
  struct Params {
    S SIZE;
    S CENTRE;
    S REFERENCE;
    using Self = Params;
    static constexpr auto fields() {
      return Fields{HY_FIELD(SIZE).in("'x").otherwise(0.0).neutral_at(0.0).means("error at the distance REFERENCE"),
                    HY_FIELD(CENTRE).role(FieldRole::Centre).in("'x").otherwise(0.0).means("signal without error"),
                    HY_FIELD(REFERENCE)
                        .role(FieldRole::ReferenceSize)
                        .in("'x")
                        .above(0.0)
                        .otherwise(1.0)
                        .means("distance from CENTRE at which the error is SIZE")};
    }
    /// The distance from CENTRE, in REFERENCE.
    [[nodiscard]] S distance(const S& x) const { return (x - CENTRE) / REFERENCE; }
  };
  template <class S>
  using In = Xin<S, "'x", "signal">;
  template <class S>
  using Out = Xout<S, "'x", "signal with the error">;
};

}  // namespace hysteron
