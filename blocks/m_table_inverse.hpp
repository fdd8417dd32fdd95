// HY_M_TABLE_INVERSE: XOUT = XIN/M(P), M(P) read from a table
#pragma once

#include "blocks/m_inverse.hpp"
#include "blocks/slope_table.hpp"

namespace hysteron {

struct SlopeMTableInverse {
  static constexpr About about{
      .name = "HY_M_TABLE_INVERSE",
      .title = "Inverse of the slope by momentum, from a table",
      .group = Group::Memory,
      .equation = "XOUT = XIN/M(P), M(P) straight between the points (P_TABLE, M_TABLE); 0 where M(P) is not above 0",
      .meaning =
          "The rate of the input that gives a wanted rate of the output, with the table of HY_M_TABLE. Where the "
          "table gives no slope above 0 there is no inverse: ERROR is TRUE and XOUT is 0.",
      .source = "Strijbosch and Oomen, equation (13)"};

  template <class S>
  using Params = SlopeTableParams<S>;
  template <class S>
  using State = NoFields<S>;
  template <class S>
  using In = SlopeMInverse::In<S>;
  template <class S>
  using Out = SlopeMInverse::Out<S>;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const InverseOfSlope<S> inverse = invert_slope(table_slope(params, in.P), in.XIN);  // (13)
    return {.XOUT = inverse.input, .M = inverse.slope, .ERROR = inverse.failed, .ERRORID = inverse.reason};
  }
};

}  // namespace hysteron
