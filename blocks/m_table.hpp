// HY_M_TABLE: XOUT = M(P)·XIN, M(P) read from a table
#pragma once

#include "blocks/m.hpp"
#include "blocks/slope_table.hpp"

namespace hysteron {

struct SlopeMTable {
  static constexpr About about{
      .name = "HY_M_TABLE",
      .title = "Slope by momentum, from a table",
      .group = Group::Memory,
      .equation = "XOUT = M(P)·XIN, M(P) straight between the points (P_TABLE, M_TABLE), held outside them",
      .meaning =
          "The memory function of a MEM element where no formula fits it: up to 32 measured points, of which the "
          "first COUNT count. P_TABLE ascends; where two points share a momentum the slope jumps. A table that "
          "rises or falls throughout and stays above 0 can be inverted by HY_M_TABLE_INVERSE.",
      .source = "Strijbosch and Oomen, equation (5)"};

  template <class S>
  using Params = SlopeTableParams<S>;
  template <class S>
  using State = NoFields<S>;
  template <class S>
  using In = SlopeM::In<S>;
  template <class S>
  using Out = SlopeM::Out<S>;

  template <class S>
  static Out<S> output(const Params<S>& params, const State<S>& /*state*/, const In<S>& in, const S& /*ts*/) {
    const S slope = table_slope(params, in.P);
    return {.XOUT = slope * in.XIN, .M = slope};  // (5)
  }
};

}  // namespace hysteron
