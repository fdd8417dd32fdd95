// A block with its parameters and its memory, run step by step as a diagram would run it.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "blocks/description.hpp"

namespace hysteron::testing {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// A structure with every member at its preset.
template <class Struct>
Struct presets() {
  Struct result{};
  const auto set = [&](const auto& field) {
    auto& member = result.*(field.member);
    using Member = std::remove_reference_t<decltype(member)>;
    if constexpr (requires { member.fill({}); }) {
      member.fill(static_cast<typename Member::value_type>(field.preset));
    } else {
      member = static_cast<Member>(field.preset);
    }
  };
  Struct::fields().apply([&](const auto&... field) { (set(field), ...); });
  return result;
}

template <class B, class S = double>
class Stepper {
 public:
  using Params = typename B::template Params<S>;
  using In = typename B::template In<S>;
  using Out = typename B::template Out<S>;
  using State = typename B::template State<S>;

  explicit Stepper(S ts, Params the_params = presets<Params>()) : params(the_params), ts_(ts) { reset(); }

  void reset() {
    if constexpr (HasMemory<B>) {
      state = B::initial(params);
    }
  }
  Out operator()(const In& in) {
    const Out out = B::output(params, state, in, ts_);
    if constexpr (HasMemory<B>) {
      B::update(params, state, in, out, ts_);
    }
    return out;
  }

  Params params;
  State state{};

 private:
  S ts_;
};

}  // namespace hysteron::testing
