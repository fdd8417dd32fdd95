// Counting up and down within the whole of DINT but its lowest number, never past an end; the state and the outputs of
// a counter that counts one way: HY_CTU, HY_CTD.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

template <class I>
I one_more(const I& count) {
  return count + select(count < I(2147483647), I(1), I(0));
}
template <class I>
I one_less(const I& count) {
  return count - select(count > I(-2147483647), I(1), I(0));
}

template <class S, Label last>
struct CounterState {
  Int<S> COUNT;
  Bool<S> LAST;
  using Self = CounterState;
  static constexpr auto fields() {
    return Fields{HY_FIELD(COUNT).otherwise(0.0).means("count of the step before"),
                  HY_FIELD(LAST).otherwise(0.0).means(last)};
  }
};

template <class S, Label reached>
struct CounterOut {
  Bool<S> Q;
  Int<S> CV;
  using Self = CounterOut;
  static constexpr auto fields() { return Fields{HY_FIELD(Q).means(reached), HY_FIELD(CV).means("count")}; }
};

}  // namespace hysteron
