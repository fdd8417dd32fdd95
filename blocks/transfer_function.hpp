// HY_TRANSFER_FUNCTION: XOUT/XIN = (NUM_0·z^m + … + NUM_m)/(DEN_0·z^n + … + DEN_n), m ≤ n
#pragma once

#include "blocks/sized.hpp"

namespace hysteron {

/// What transfer functions have in common: P = N + 1 numbers of the denominator, M of the numerator, and N states.
struct TransferFunctionPins {
  static constexpr SizeRule size_rule = SizeRule::TransferFunction;
  static constexpr auto settings = no_settings;
  static constexpr bool is_discretised = false;

  static constexpr std::array inputs{signal_pin("XIN", "signal"),
                                     flag_pin("R1", "reset, dominant: the memory begins at 0 again")};
  static constexpr std::array params{
      matrix_parameter("NUM", Size::M, Size::One, "numerator, the highest power first"),
      scaled_list("DEN", Size::P, "denominator, the highest power first; a fit leaves its first number")};
  static constexpr std::array outputs{signal_pin("XOUT", "filtered signal")};

  /// The state, or 0 at a reset.
  template <class View>
  static auto state(const View& view, std::size_t k) {
    using S = typename View::Real;
    return select(view.flag(1), S(0.0), view.state(k));
  }
  template <class View>
  static void begin_at_zero(const Sizes& z, View& view) {
    using S = typename View::Real;
    for (std::size_t k = 0; k < z.n; ++k) {
      view.set_state(k, S(0.0));
    }
  }
};

struct TransferFunction : TransferFunctionPins {
  static constexpr About about{
      .name = "HY_TRANSFER_FUNCTION",
      .title = "Transfer function in z",
      .group = Group::Dynamics,
      .equation = "XOUT/XIN = (NUM_0·z^m + … + NUM_m)/(DEN_0·z^n + … + DEN_n), m <= n",
      .meaning =
          "A digital filter by its coefficients, the highest power of z first, as scipy.signal.dlti and tf(…, TS) have "
          "them: NUM := [1.0, 0.2], DEN := [1.0, -0.7] is (z + 0.2)/(z - 0.7). Computed in the transposed second "
          "direct "
          "form, XOUT = (NUM_0·XIN + s_1)/DEN_0. It starts with an empty memory; R1 empties it. With m < n the output "
          "depends on memory alone but for R1, so that a loop may be closed. Up to 16 poles. Coefficients of a low "
          "cut-off lose digits: for the slow parts of a loop HY_TRANSFER_FUNCTION_S or HY_STATE_SPACE is more exact.",
      .source = "A. V. Oppenheim and R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., section 6.3"};
  /// An instance for its page.
  static constexpr std::string_view example = "NUM := [1.0, 0.2], DEN := [1.0, -0.7]";
  static constexpr Sizes example_sizes{.n = 1, .m = 2, .p = 2, .direct = true};
  static constexpr std::array states{vector_pin("S", Size::N, "memory")};

  /// NUM of z^(n − i) times XIN, added to `sum`; nothing where the numerator does not reach so high.
  template <class View, class S>
  static S with_input(const Sizes& z, const View& view, std::size_t i, const S& sum) {
    return i + z.m < z.p ? sum : sum + view.param(0, i + z.m - z.p) * view.in(0, 0);
  }
  template <class View>
  static void initial(const Sizes& z, View& view) {
    begin_at_zero(z, view);
  }
  template <class View>
  static void output(const Sizes& z, View& view) {
    view.set_out(0, with_input(z, view, 0, state(view, 0)) / view.param(1, 0));
  }
  // s_i⁺ = s_(i+1) + NUM_i·XIN − DEN_i·XOUT
  template <class View>
  static void update(const Sizes& z, View& view) {
    using S = typename View::Real;
    for (std::size_t i = 1; i <= z.n; ++i) {
      const S before = i < z.n ? state(view, i) : S(0.0);
      view.set_state(i - 1, with_input(z, view, i, before) - view.param(1, i) * view.out(0));
    }
  }
};

}  // namespace hysteron
