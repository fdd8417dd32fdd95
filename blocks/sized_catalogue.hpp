// The catalogue of blocks whose pins are vectors, one line each; the others stand in catalogue.hpp.
#pragma once

#include "blocks/matrix_gain.hpp"
#include "blocks/state_space.hpp"
#include "blocks/transfer_function.hpp"
#include "blocks/transfer_function_s.hpp"
#include "blocks/transfer_function_zoh.hpp"

namespace hysteron {

template <class... Blocks>
struct SizedBlockList {
  static constexpr std::size_t size = sizeof...(Blocks);
  template <class Visit>
  static constexpr void for_each(Visit&& visit) {
    (visit.template operator()<Blocks>(), ...);
  }
};

using SizedCatalogue = SizedBlockList<MatrixGain, StateSpace, TransferFunction, TransferFunctionS, TransferFunctionZoh>;

}  // namespace hysteron
