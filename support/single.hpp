// The nearest number of 32 bits, as a double.
#pragma once

namespace hysteron {

/// Through memory: where two such numbers stand side by side, GCC 12 makes one vector of both from -O2 on, takes the
/// conversion there and back for none at all, and leaves them unrounded. Write it nowhere else as two conversions.
[[nodiscard]] inline double nearest_single(double x) {
  volatile auto nearest = static_cast<float>(x);
  return static_cast<double>(nearest);
}

}  // namespace hysteron
