// HY_STATE_SPACE: x⁺ = A·x + B·U, Y = C·x + D·U
#pragma once

#include "blocks/sized.hpp"

namespace hysteron {

struct StateSpace {
  static constexpr About about{
      .name = "HY_STATE_SPACE",
      .title = "State space, discrete",
      .group = Group::Dynamics,
      .equation = "x(k+1) = A·x(k) + B·U(k), Y(k) = C·x(k) + D·U(k)",
      .meaning =
          "A linear system with n states, m inputs and p outputs, from one sample to the next. A, B, C and D stand row "
          "by row; A has n², B n·m, C p·n and D p·m numbers, and D may be left out where nothing passes at once. The "
          "state begins at X0, which is 0 where it is left out; R1 loads X0 before the outputs are computed. Each "
          "number is a sum from the left, the states first and the inputs behind them. Up to 16 states, 32 inputs and "
          "32 outputs; a side of one element is one value. X is the state of this step. Without D the outputs depend "
          "on memory alone but for R1: a loop may be closed where R1 is not wired to it.",
      .source = "K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed., section 2.3"};

  /// An instance for its page.
  static constexpr std::string_view example = "A := [0.9, 0.1, 0.0, 0.8], B := [0.0, 1.0], C := [1.0, 0.0], D := [0.0]";
  static constexpr Sizes example_sizes{.n = 2, .m = 1, .p = 1, .direct = true};

  static constexpr SizeRule size_rule = SizeRule::StateSpace;
  static constexpr auto settings = no_settings;
  static constexpr bool is_discretised = false;

  static constexpr std::array inputs{vector_pin("U", Size::M, "inputs"), flag_pin("R1", "reset, dominant: loads X0")};
  static constexpr std::array params{matrix_parameter("A", Size::N, Size::N, "from state to state, row by row"),
                                     matrix_parameter("B", Size::N, Size::M, "from inputs to the state"),
                                     matrix_parameter("C", Size::P, Size::N, "from the state to outputs"),
                                     direct_parameter("D", Size::P, Size::M, "from inputs to outputs at once"),
                                     matrix_parameter("X0", Size::N, Size::One, "state at the start and at a reset")};
  static constexpr std::array outputs{vector_pin("Y", Size::P, "outputs"),
                                      vector_pin("X", Size::N, "state of this step")};
  static constexpr std::array states{vector_pin("X", Size::N, "state of the next step")};

  static constexpr std::size_t A = 0, B = 1, C = 2, D = 3, X0 = 4;

  /// Row `i` of a matrix times the state and of another times the inputs.
  template <class View>
  static auto row(const Sizes& z, const View& view, std::size_t of_state, std::size_t of_input, std::size_t i) {
    using S = typename View::Real;
    S sum = weighted_sum<S>(
        z.n, [&](std::size_t k) { return view.param(of_state, i * z.n + k); },
        [&](std::size_t k) { return state(view, k); });
    if (of_input != D || z.direct) {
      for (std::size_t k = 0; k < z.m; ++k) {
        sum = sum + view.param(of_input, i * z.m + k) * view.in(0, k);
      }
    }
    return sum;
  }
  template <class View>
  static auto state(const View& view, std::size_t k) {
    return select(view.flag(1), view.param(X0, k), view.state(k));
  }

  template <class View>
  static void initial(const Sizes& z, View& view) {
    for (std::size_t k = 0; k < z.n; ++k) {
      view.set_state(k, view.param(X0, k));
    }
  }
  template <class View>
  static void output(const Sizes& z, View& view) {
    for (std::size_t i = 0; i < z.p; ++i) {
      view.set_out(i, row(z, view, C, D, i));
    }
    for (std::size_t k = 0; k < z.n; ++k) {
      view.set_out(z.p + k, state(view, k));
    }
  }
  template <class View>
  static void update(const Sizes& z, View& view) {
    for (std::size_t i = 0; i < z.n; ++i) {
      view.set_state(i, row(z, view, A, B, i));
    }
  }
};

}  // namespace hysteron
