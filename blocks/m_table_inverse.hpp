// HY_M_TABLE_INVERSE: XOUT = XIN/M(P), M(P) read from a table
#pragma once

#include "blocks/m_inverse.hpp"
#include "blocks/slope_table.hpp"

namespace hysteron {

struct SlopeMTableInverse : SlopeTable {
  static constexpr About about{
      .name = "HY_M_TABLE_INVERSE",
      .title = "Inverse of the slope by momentum, from a table",
      .group = Group::Memory,
      .equation = "XOUT = XIN/M(P), M(P) straight between the points (P_TABLE, M_TABLE); 0 where M(P) is not above 0",
      .meaning =
          "The rate of the input that gives a wanted rate of the output, with the table of HY_M_TABLE. Where the "
          "table gives no slope above 0, or its P_TABLE does not rise, ERROR is TRUE and XOUT is 0.",
      .source = "Strijbosch and Oomen, equation (13)"};

  template <class S>
  using In = SlopeMInverse::In<S>;
  template <class S>
  using Out = CheckedSlopeOut<S, "'u", "rate of the input", "TRUE where there is no inverse",
                              "0 no error, 3 points of the table do not rise, 4 slope not above 0">;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& state, const In<S>& in, const S& /*ts*/) {
    const S slope = select(state.RISING, table_slope(params, in.momentum()), S(0.0));
    const InverseOfSlope<S> inverse = invert_slope(slope, in.XIN);  // (13)
    return {.XOUT = inverse.input,
            .M = slope,
            .ERROR = inverse.failed,
            .ERRORID = select(state.RISING, inverse.reason, Word<S>(fault::points_not_rising))};
  }
};

}  // namespace hysteron
