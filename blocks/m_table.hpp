// HY_M_TABLE: XOUT = M(P)·XIN, M(P) read from a table
#pragma once

#include "blocks/m.hpp"
#include "blocks/slope_table.hpp"

namespace hysteron {

struct SlopeMTable : SlopeTable {
  static constexpr About about{
      .name = "HY_M_TABLE",
      .title = "Slope by momentum, from a table",
      .group = Group::Memory,
      .equation = "XOUT = M(P)·XIN, M(P) straight between the points (P_TABLE, M_TABLE), held outside them",
      .meaning =
          "The memory function of a MEM element where no formula fits it: up to 32 measured points, of which the "
          "first COUNT are used. P_TABLE must rise; that is checked at reset, and where it fails XOUT is 0 and ERROR "
          "is TRUE. A table whose M_TABLE rises or falls throughout and stays above 0 is undone by "
          "HY_M_TABLE_INVERSE.",
      .source = "Strijbosch and Oomen, equation (5)"};

  template <class S>
  using In = SlopeM::In<S>;
  template <class S>
  using Out = CheckedSlopeOut<S, "'y", "rate of the output", "TRUE where P_TABLE does not rise",
                              "0 no error, 3 points of the table do not rise">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const S slope = table_slope(params, in.momentum());
    return {.XOUT = select(state.RISING, slope * in.XIN, S(0.0)),  // (5)
            .M = select(state.RISING, slope, S(0.0)),
            .ERROR = !state.RISING,
            .ERRORID = select(state.RISING, Word<S>(std::uint16_t{0}), Word<S>(fault::points_not_rising))};
  }
};

}  // namespace hysteron
