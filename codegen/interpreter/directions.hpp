// The directions of a scalar with derivatives, and how far an FMU is moved along each.
//
// An FMU gives no derivative of a whole run: what it offers (getDirectionalDerivative) holds at one instant, with its
// states fixed. So it runs once more for each direction, with inputs and parameters moved by ε·d, and the derivative of
// an output is the difference over ε.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "blocks/description.hpp"
#include "blocks/scalar.hpp"

namespace hysteron {

/// The number of derivatives that a scalar carries; 0 for one without.
template <class S>
constexpr std::size_t direction_count() {
  if constexpr (requires { typename S::Gradient; }) {
    return std::tuple_size_v<typename S::Gradient>;
  } else {
    return 0;
  }
}

struct Directions {
  static constexpr std::size_t most = 8;
  /// Relative to the number along which the direction goes. The error of the difference is about this times the
  /// curvature, plus the noise of the FMU's solver over this: 10⁻⁵ keeps both small for tolerances from 10⁻¹⁰ on.
  static constexpr double relative_step = 1e-5;

  std::size_t used = most;
  std::array<double, most> step = filled(relative_step);  ///< ε by direction

  /// A parameter that is varied along a direction says how large a move is small.
  template <class S>
  void note(const S& value, const Field& field) {
    if constexpr (direction_count<S>() > 0) {
      static_assert(direction_count<S>() <= most);
      for (std::size_t i = 0; i < direction_count<S>(); ++i) {
        const double slope = std::abs(value.derivative(static_cast<int>(i)));
        if (slope > 0.0) {
          step[i] = relative_step * size_of(value_of(value), field) / slope;
        }
      }
    }
  }

 private:
  static double size_of(double value, const Field& field) {
    const double range = field.maximum - field.minimum;
    return value != 0.0                                                     ? std::abs(value)
           : range < std::numeric_limits<double>::infinity() && range > 0.0 ? range
                                                                            : 1.0;
  }
  static constexpr std::array<double, most> filled(double number) {
    std::array<double, most> all{};
    all.fill(number);
    return all;
  }
};

}  // namespace hysteron
