// HY_TRANSFER_FUNCTION_ZOH: XOUT/XIN = (NUM_0·s^m + … + NUM_m)/(DEN_0·s^n + … + DEN_n), m ≤ n, for an input that is
// held
#pragma once

#include "blocks/transfer_function.hpp"

namespace hysteron {

struct TransferFunctionZoh {
  static constexpr About about{
      .name = "HY_TRANSFER_FUNCTION_ZOH",
      .title = "Transfer function in s, zero-order hold",
      .group = Group::Dynamics,
      .equation = "XOUT/XIN = (NUM_0·s^m + … + NUM_m)/(DEN_0·s^n + … + DEN_n), m <= n, XIN held over a sample",
      .meaning =
          "A continuous transfer function by its coefficients, the highest power of s first, exact at the samples for "
          "an "
          "input that is held from one sample to the next, as a digital output holds it: a plant behind a controller. "
          "NUM and DEN are constants of the text. When the diagram is read, they become the matrices of x(k+1) = "
          "PHI·x(k) + GAMMA·XIN(k), XOUT(k) = C·x(k) + D·XIN(k) by a matrix exponential at the sample time, and these "
          "are "
          "the parameters of the block. It starts at rest; R1 brings it to rest. With m < n the output depends on "
          "memory "
          "alone but for R1, so that a loop may be closed. Up to 16 poles.",
      .source =
          "C. F. Van Loan, IEEE Trans. Automatic Control 23 (1978) 395; K. J. Åström and B. Wittenmark, "
          "Computer-Controlled Systems, 3rd ed., section 2.3"};

  static constexpr SizeRule size_rule = SizeRule::TransferFunction;
  static constexpr std::array<std::string_view, 2> settings{"NUM", "DEN"};
  static constexpr bool is_discretised = true;

  static constexpr auto inputs = TransferFunctionPins::inputs;
  static constexpr std::array params{
      matrix_parameter("PHI", Size::N, Size::N, "from state to state, row by row"),
      matrix_parameter("GAMMA", Size::N, Size::One, "from the input to the state"),
      matrix_parameter("C", Size::N, Size::One, "from the state to the output"),
      direct_parameter("D", Size::One, Size::One, "from the input to the output at once")};
  static constexpr auto outputs = TransferFunctionPins::outputs;
  /// An instance for its page.
  static constexpr std::string_view example = "NUM := [1.0], DEN := [0.0001, 0.01, 1.0]";
  static constexpr Sizes example_sizes{.n = 2, .m = 1, .p = 3};
  static constexpr std::array states{vector_pin("X", Size::N, "state of the next step")};

  template <class View>
  static void initial(const Sizes& z, View& view) {
    TransferFunctionPins::begin_at_zero(z, view);
  }
  template <class View>
  static auto from_state(const Sizes& z, const View& view, std::size_t field, std::size_t first) {
    using S = typename View::Real;
    return weighted_sum<S>(
        z.n, [&](std::size_t k) { return view.param(field, first + k); },
        [&](std::size_t k) { return TransferFunctionPins::state(view, k); });
  }
  template <class View>
  static void output(const Sizes& z, View& view) {
    const auto sum = from_state(z, view, 2, 0);
    view.set_out(0, z.direct ? sum + view.param(3, 0) * view.in(0, 0) : sum);
  }
  template <class View>
  static void update(const Sizes& z, View& view) {
    for (std::size_t i = 0; i < z.n; ++i) {
      view.set_state(i, from_state(z, view, 0, i * z.n) + view.param(1, i) * view.in(0, 0));
    }
  }
};

}  // namespace hysteron
