// HY_TRANSFER_FUNCTION_S: XOUT/XIN = (NUM_0·s^m + … + NUM_m)/(DEN_0·s^n + … + DEN_n), m ≤ n, by the trapezoidal rule
#pragma once

#include "blocks/transfer_function.hpp"

namespace hysteron {

struct TransferFunctionS : TransferFunctionPins {
  static constexpr About about{
      .name = "HY_TRANSFER_FUNCTION_S",
      .title = "Transfer function in s",
      .group = Group::Dynamics,
      .equation = "XOUT/XIN = (NUM_0·s^m + … + NUM_m)/(DEN_0·s^n + … + DEN_n), m <= n, s = (2/TS)·(z - 1)/(z + 1)",
      .meaning =
          "A continuous transfer function by its coefficients, the highest power of s first, discretised at the sample "
          "time by the trapezoidal rule (Tustin): NUM := [1.0], DEN := [0.1, 1.0] is 1/(0.1·s + 1). It is a chain of n "
          "trapezoidal integrators, whose loop is solved in each step: the bits of the result do not suffer where the "
          "sample time is short, and the coefficients can be tuned. It starts at rest; R1 brings it to rest. XOUT "
          "depends on the present input: to close a loop, put HY_DELAY in it. Up to 16 poles.",
      .delay = "That of the transfer function at the warped frequency (2/TS)·tan(ωTS/2), which is ω at low frequency.",
      .source =
          "A. Tustin, J. IEE 94 (1947) 130; K. J. Åström and B. Wittenmark, Computer-Controlled Systems, 3rd ed., "
          "section 8.3"};
  /// An instance for its page.
  static constexpr std::string_view example = "NUM := [1.0], DEN := [0.0001, 0.01, 1.0]";
  static constexpr Sizes example_sizes{.n = 2, .m = 1, .p = 3};
  static constexpr std::array states{vector_pin("S", Size::N, "integrators before the present input")};

  // With w the signal whose n-th derivative is v, and z_k its k-th: DEN_0·v = XIN − Σ DEN_(n−k)·z_k. The trapezoidal
  // rule says z_k = s_k + c·z_(k+1), c = TS/2, with s_k known; so z_k = r_k + c^(n−k)·v, r_k = s_k + c·r_(k+1).
  template <class View>
  struct Chain {
    using S = typename View::Real;
    std::array<S, most_states + 1> z{};  ///< z_0 … z_n
  };

  template <class View>
  static Chain<View> solve(const Sizes& sizes, const View& view) {
    using S = typename View::Real;
    const std::size_t n = sizes.n;
    const S c = view.ts() * S(0.5);
    std::array<S, most_states + 1> power{};  // c^1 … c^n
    power[1] = c;
    for (std::size_t j = 2; j <= n; ++j) {
      power[j] = power[j - 1] * c;
    }
    Chain<View> chain;
    chain.z[n - 1] = state(view, n - 1);
    for (std::size_t k = n - 1; k-- > 0;) {
      chain.z[k] = state(view, k) + c * chain.z[k + 1];
    }
    S rest = view.in(0, 0);
    S loop = view.param(1, 0);
    for (std::size_t k = n; k-- > 0;) {
      rest = rest - view.param(1, n - k) * chain.z[k];
      loop = loop + view.param(1, n - k) * power[n - k];
    }
    chain.z[n] = rest / loop;
    for (std::size_t k = 0; k < n; ++k) {
      chain.z[k] = chain.z[k] + power[n - k] * chain.z[n];
    }
    return chain;
  }

  template <class View>
  static void initial(const Sizes& z, View& view) {
    begin_at_zero(z, view);
  }
  // XOUT = Σ NUM_(m−k)·z_k, the highest power first
  template <class View>
  static void output(const Sizes& z, View& view) {
    using S = typename View::Real;
    const Chain<View> chain = solve(z, view);
    view.set_out(0, weighted_sum<S>(
                        z.m, [&](std::size_t k) { return view.param(0, k); },
                        [&](std::size_t k) { return chain.z[z.m - 1 - k]; }));
  }
  // s_k⁺ = z_k + c·z_(k+1)
  template <class View>
  static void update(const Sizes& z, View& view) {
    using S = typename View::Real;
    const Chain<View> chain = solve(z, view);
    const S c = view.ts() * S(0.5);
    for (std::size_t k = 0; k < z.n; ++k) {
      view.set_state(k, chain.z[k] + c * chain.z[k + 1]);
    }
  }
};

}  // namespace hysteron
