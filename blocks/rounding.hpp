// Rounding to whole numbers, from the truncation that every target has.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

/// The nearest whole number, halves away from zero; saturates at the ends of DINT.
template <class S>
Int<S> nearest(const S& x) {
  const Int<S> whole = to_int(x);
  const S rest = x - to_real<S>(whole);
  return to_int(to_real<S>(whole) + select(rest >= S(0.5), S(1.0), select(rest <= S(-0.5), S(-1.0), S(0.0))));
}

/// The smallest whole number not below x; saturates at the ends of DINT.
template <class S>
Int<S> ceiling(const S& x) {
  const Int<S> whole = to_int(x);
  return to_int(to_real<S>(whole) + select(x > to_real<S>(whole), S(1.0), S(0.0)));
}

}  // namespace hysteron
