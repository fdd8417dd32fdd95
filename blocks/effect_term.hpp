// The term that an effect adds to a signal, so that a term of 0 leaves the signal as it is, to the bit.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

/// x + term, and x itself where the term is 0: 0 − term is +0 for either zero, and x − (+0) keeps even the sign of a
/// zero. A dual number keeps the derivative of the term, which a fit that starts from the neutral setting needs.
template <class S>
S with_term(const S& x, const S& term) {
  return x - (S(0.0) - term);
}

}  // namespace hysteron
