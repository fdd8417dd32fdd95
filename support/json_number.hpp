// Numbers in JSON, which has no sign for those that are not finite.
#pragma once

#include <cmath>

namespace hysteron {

/// A number, of a zero without its sign; null where it is infinite or not a number, as for an open end or a value that
/// is not known.
template <class Json>
[[nodiscard]] Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value + 0.0) : Json(nullptr);
}

}  // namespace hysteron
