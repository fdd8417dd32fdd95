// A signal's past in a ring, and its value a time ago: what HY_DEAD_TIME and HY_CLOCK are made of.
#pragma once

#include "blocks/ports.hpp"

namespace hysteron {

/// A block that holds the last 1024 samples. Its State has the members PAST, HEAD, HELD, BEFORE and STARTED.
struct PastSignal {
  static constexpr std::size_t capacity = 1024;

  template <class S>
  struct Out {
    S XOUT;
    Bool<S> ERROR;
    Word<S> ERRORID;
    using Self = Out;
    static constexpr auto fields() {
      return Fields{HY_FIELD(XOUT).in("'x").means("delayed signal"),
                    HY_FIELD(ERROR).means("the delay is longer than 1024 samples, or below 0"),
                    HY_FIELD(ERRORID).means("0 no error, 5 dead time too long or below 0")};
    }
  };

  /// What a look into the past begins with.
  template <class S>
  struct View {
    S present;
    S earlier;     ///< the signal before all samples that count
    Int<S> count;  ///< the past samples that count
  };

 protected:
  template <class State>
  static void forget(State& state) {
    using S = std::remove_cvref_t<decltype(state.BEFORE)>;
    fill(state.PAST, S(0.0));
    state.HEAD = Int<S>(0);
    state.HELD = Int<S>(0);
    state.BEFORE = S(0.0);
    state.STARTED = Bool<S>(false);
  }
  /// The signal a number of steps ago, whole or not, straight between its samples.
  template <class S, class State>
  static Out<S> ago(const State& state, const View<S>& view, const S& wanted) {
    constexpr auto longest = static_cast<double>(capacity);
    const S steps = max(min(S(longest), wanted), S(0.0));
    const Int<S> whole = to_int(steps);
    const S fraction = steps - to_real<S>(whole);
    const S newer = select(whole < Int<S>(1), view.present, past<S>(state, view, whole));
    const S older = past<S>(state, view, whole + Int<S>(1));
    const Bool<S> held_back = !(wanted >= S(0.0) && wanted <= S(longest));
    return {.XOUT = newer + fraction * (older - newer),
            .ERROR = held_back,
            .ERRORID = select(held_back, Word<S>(fault::dead_time_too_long), Word<S>(std::uint16_t{0}))};
  }
  /// The sample before the present one, which itself stands in for it in the first step.
  template <class S, class State>
  static S last(const State& state, const View<S>& view) {
    return past<S>(state, view, Int<S>(1));
  }
  template <class S, class State>
  static void keep(State& state, const View<S>& view) {
    constexpr std::int32_t size{capacity};
    state.BEFORE = view.earlier;
    state.HELD = min(view.count + Int<S>(1), Int<S>(size));
    store(state.PAST, state.HEAD, view.present);
    const Int<S> next = state.HEAD + Int<S>(1);
    state.HEAD = select(next < Int<S>(size), next, Int<S>(0));
    state.STARTED = Bool<S>(true);
  }

 private:
  /// The sample `age` steps ago, for an age of at least 1.
  template <class S, class State>
  static S past(const State& state, const View<S>& view, const Int<S>& age) {
    const Int<S> place = state.HEAD - age;
    const Int<S> wrapped = select(place < Int<S>(0), place + Int<S>(std::int32_t{capacity}), place);
    return select(age <= view.count, at(state.PAST, wrapped), view.earlier);
  }
};

}  // namespace hysteron
