// Linear interpolation in a table of rising X: the bracket of a value, and the line through it.
// Scalar and length are named in the call: bracket<S, 32>(x, count, value).
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

/// TRUE where the first `count` of X rise strictly and count is between 2 and N.
template <class S, std::size_t N>
Bool<S> rises(const Array<S, N>& x, const Int<S>& count) {
  Bool<S> result = count >= Int<S>(2) && count <= Int<S>(static_cast<std::int32_t>(N));
  for (std::int32_t i = 1; i < static_cast<std::int32_t>(N); ++i) {
    result = result && (Int<S>(i) >= count || at(x, Int<S>(i)) > at(x, Int<S>(i - 1)));
  }
  return result;
}

/// The index i, 0 ≤ i ≤ count − 2, of the pair with X[i] ≤ value < X[i+1]; the first pair below the table, the last
/// one above. Bisection over a fixed number of halvings, so that every step takes the same time.
template <class S, std::size_t N>
Int<S> bracket(const Array<S, N>& x, const Int<S>& count, const S& value) {
  std::int32_t stride = 1;
  while (stride * 2 < static_cast<std::int32_t>(N)) {
    stride *= 2;
  }
  Int<S> low = Int<S>(0);
  for (; stride > 0; stride /= 2) {
    const Int<S> middle = low + Int<S>(stride);
    low = select(middle <= count - Int<S>(2) && value >= at(x, middle), middle, low);
  }
  return low;
}

/// The line through the points i and i + 1, at a value. A pair whose X does not rise counts as one of width 1.
template <class S, std::size_t N>
S line(const Array<S, N>& x, const Array<S, N>& y, const Int<S>& i, const S& value) {
  const S x0 = at(x, i);
  const S y0 = at(y, i);
  const S width = at(x, i + Int<S>(1)) - x0;
  return y0 + (value - x0) / select(width > S(0.0), width, S(1.0)) * (at(y, i + Int<S>(1)) - y0);
}

}  // namespace hysteron
