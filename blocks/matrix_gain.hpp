// HY_MATRIX_GAIN: XOUT = K·XIN
#pragma once

#include "blocks/sized.hpp"

namespace hysteron {

struct MatrixGain {
  static constexpr About about{
      .name = "HY_MATRIX_GAIN",
      .title = "Matrix gain",
      .group = Group::Arithmetic,
      .equation = "XOUT = K·XIN",
      .meaning =
          "A matrix times a vector: decoupling of axes, mixing of actuators, a change of coordinates. K stands row by "
          "row, and ROWS says how many rows there are: K := [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], ROWS := 2 takes a vector "
          "of "
          "3 and gives one of 2. A row is added from the left. Up to 32 rows and 32 columns; a side of one element is "
          "one value."};

  /// An instance for its page.
  static constexpr std::string_view example = "K := [1.0, 0.5, 0.25, 0.0, 1.0, -2.0], ROWS := 2";
  static constexpr Sizes example_sizes{.m = 3, .p = 2};

  static constexpr SizeRule size_rule = SizeRule::Matrix;
  static constexpr std::array<std::string_view, 1> settings{"ROWS"};  ///< what an instance says beside its parameters
  static constexpr bool is_discretised = false;  ///< whether settings become parameters at the sample time

  static constexpr std::array inputs{vector_pin("XIN", Size::M, "vector")};
  static constexpr std::array params{matrix_parameter("K", Size::P, Size::M, "matrix, row by row")};
  static constexpr std::array outputs{vector_pin("XOUT", Size::P, "K·XIN")};
  static constexpr std::array<SizedField, 0> states{};

  template <class View>
  static void output(const Sizes& sizes, View& view) {
    using S = typename View::Real;
    for (std::size_t i = 0; i < sizes.p; ++i) {
      view.set_out(i, weighted_sum<S>(
                          sizes.m, [&](std::size_t k) { return view.param(0, i * sizes.m + k); },
                          [&](std::size_t k) { return view.in(0, k); }));
    }
  }
  template <class View>
  static void initial(const Sizes& /*sizes*/, View& /*view*/) {}
  template <class View>
  static void update(const Sizes& /*sizes*/, View& /*view*/) {}
};

}  // namespace hysteron
