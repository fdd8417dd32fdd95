// M(p) as a table: shared by HY_M_TABLE and HY_M_TABLE_INVERSE.
#pragma once

#include "blocks/interpolation.hpp"
#include "blocks/ports.hpp"

namespace hysteron {

/// The largest number of points of a slope table.
inline constexpr std::size_t slope_table_capacity = 32;

template <class S>
struct SlopeTableParams {
  Array<S, slope_table_capacity> P_TABLE;
  Array<S, slope_table_capacity> M_TABLE;
  Int<S> COUNT;
  using Self = SlopeTableParams;
  static constexpr auto fields() {
    return Fields{
        HY_FIELD(P_TABLE).in("'p").means("momentum of each point, rising"),
        HY_FIELD(M_TABLE).in("'y/'u").means("slope at each point"),
        HY_FIELD(COUNT).role(FieldRole::PointCount).within(2, slope_table_capacity).means("number of points")};
  }
};

template <class S>
struct SlopeTableState {
  Bool<S> RISING;
  using Self = SlopeTableState;
  static constexpr auto fields() {
    return Fields{HY_FIELD(RISING).otherwise(0.0).means("TRUE where P_TABLE rose at reset")};
  }
};

/// A block whose table is checked at reset, once.
struct SlopeTable {
  template <class S>
  using Params = SlopeTableParams<S>;
  template <class S>
  using State = SlopeTableState<S>;

  template <class S>
  static State<S> initial(const Params<S>& params) {
    return {.RISING = rises<S, slope_table_capacity>(params.P_TABLE, params.COUNT)};
  }
  template <class S, class In, class Out>
  static void update(const Params<S>& /*params*/, State<S>& /*state*/, const In& /*in*/, const Out& /*out*/,
                     const S& /*ts*/) {}
};

/// The slope at a momentum: straight between the points, held at both ends.
template <class S>
S table_slope(const SlopeTableParams<S>& table, const S& p) {
  const Int<S> i = bracket<S, slope_table_capacity>(table.P_TABLE, table.COUNT, p);
  const Int<S> next = i + Int<S>(1);
  const S between = line<S, slope_table_capacity>(table.P_TABLE, table.M_TABLE, i, p);
  const S from_first = select(p <= at(table.P_TABLE, i), at(table.M_TABLE, i), between);
  return select(p >= at(table.P_TABLE, next), at(table.M_TABLE, next), from_first);
}

}  // namespace hysteron
