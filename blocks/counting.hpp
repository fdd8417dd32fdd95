// Counting up and down within the whole of DINT but its lowest number, never past an end.
#pragma once

#include "blocks/scalar.hpp"

namespace hysteron {

template <class I>
I one_more(const I& count) {
  return count + select(count < I(2147483647), I(1), I(0));
}
template <class I>
I one_less(const I& count) {
  return count - select(count > I(-2147483647), I(1), I(0));
}

}  // namespace hysteron
