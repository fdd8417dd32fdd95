// M(p) as a table: shared by HY_M_TABLE and HY_M_TABLE_INVERSE.
#pragma once

#include "blocks/description.hpp"

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
    return std::tuple{HY_FIELD(P_TABLE).in("'p").otherwise(0.0).means("momentum of each point, ascending"),
                      HY_FIELD(M_TABLE).in("'y/'u").otherwise(1.0).means("slope at each point"),
                      HY_FIELD(COUNT)
                          .within(1.0, static_cast<double>(slope_table_capacity))
                          .otherwise(1.0)
                          .means("number of points used")};
  }
};

/// The slope at a momentum: straight between the points, held at both ends. Bisection of a fixed number of steps; where
/// two points share a momentum the slope jumps.
template <class S>
S table_slope(const SlopeTableParams<S>& table, const S& p) {
  constexpr auto capacity = static_cast<std::int32_t>(slope_table_capacity);
  Int<S> below = Int<S>(0);
  Int<S> above = max(min(table.COUNT, Int<S>(capacity)), Int<S>(1)) - Int<S>(1);
  for (std::int32_t interval = capacity; interval > 1; interval /= 2) {
    const Int<S> middle = (below + above) / Int<S>(2);
    const Bool<S> right = at(table.P_TABLE, middle) <= p;
    below = select(right, middle, below);
    above = select(right, above, middle);
  }
  const S p_below = at(table.P_TABLE, below);
  const S p_above = at(table.P_TABLE, above);
  const S m_below = at(table.M_TABLE, below);
  const S m_above = at(table.M_TABLE, above);
  const S width = p_above - p_below;
  const S share = (p - p_below) / select(width > S(0.0), width, S(1.0));
  const S between = m_below + share * (m_above - m_below);
  return select(p >= p_above, m_above, select(p > p_below, between, m_below));
}

}  // namespace hysteron
