// The catalogue: every block of the library, one line each. What is derived from blocks is derived over this list.
#pragma once

#include "blocks/gain.hpp"
#include "blocks/integral.hpp"

namespace hysteron {

template <class... Blocks>
struct BlockList {
  static constexpr std::size_t size = sizeof...(Blocks);

  /// Calls visit.template operator()<B>() for each block, in the order of the list.
  template <class Visit>
  static constexpr void for_each(Visit&& visit) {
    (visit.template operator()<Blocks>(), ...);
  }
};

using Catalogue = BlockList<  //
    Gain,                     //
    Integral                  //
    >;

}  // namespace hysteron
