// Ports that many small blocks have in common, so that each of these headers is left with its equation and its words.
//
//   template <class S> using In = Xin<S, "rad", "angle">;
#pragma once

#include "blocks/description.hpp"

namespace hysteron {

/// A text as a template argument.
template <std::size_t N>
struct Label {
  char text[N]{};
  constexpr Label(const char (&literal)[N]) {
    for (std::size_t i = 0; i < N; ++i) {
      text[i] = literal[i];
    }
  }
  constexpr operator std::string_view() const { return {text, N - 1}; }
};

namespace detail {
template <Label... parts>
constexpr auto join() {
  std::array<char, (sizeof(parts.text) + ...) - sizeof...(parts) + 1> text{};
  std::size_t end = 0;
  const auto append = [&](std::string_view part) {
    for (const char c : part) {
      text[end++] = c;
    }
  };
  (append(parts), ...);
  return text;
}
template <Label... parts>
inline constexpr auto joined_text = join<parts...>();
}  // namespace detail

/// Labels one after another: joined<y, "/", u> is the unit of a slope.
template <Label... parts>
inline constexpr std::string_view joined{detail::joined_text<parts...>.data(),
                                         detail::joined_text<parts...>.size() - 1};

/// What ERRORID says. 0 is no error; the other numbers mean the same in every block.
namespace fault {
inline constexpr std::uint16_t zero_divisor = 1;        ///< the divisor is zero
inline constexpr std::uint16_t outside_domain = 2;      ///< the function is not defined at this argument
inline constexpr std::uint16_t points_not_rising = 3;   ///< the X of a table do not rise, or fewer than two are counted
inline constexpr std::uint16_t slope_not_positive = 4;  ///< M(p) is not above 0, so that it has no inverse
inline constexpr std::uint16_t dead_time_too_long = 5;  ///< the dead time is below 0 or longer than the block can hold
}  // namespace fault

/// A block without parameters and without memory. A block that has parameters hides Params by its own.
struct Stateless {
  template <class S>
  using Params = NoFields<S>;
  template <class S>
  using State = NoFields<S>;
};

template <class S, Label unit, Label meaning>
struct Xin {
  S XIN;
  using Self = Xin;
  static constexpr auto fields() { return Fields{HY_FIELD(XIN).in(unit).means(meaning)}; }
};

template <class S, Label unit, Label meaning>
struct Xout {
  S XOUT;
  using Self = Xout;
  static constexpr auto fields() { return Fields{HY_FIELD(XOUT).in(unit).means(meaning)}; }
};

/// An output that is 0, with ERROR and ERRORID, where it is not defined.
template <class S, Label unit, Label meaning>
struct CheckedXout {
  S XOUT;
  Bool<S> ERROR;
  Word<S> ERRORID;
  using Self = CheckedXout;
  static constexpr auto fields() {
    return Fields{HY_FIELD(XOUT).in(unit).means(meaning),
                  HY_FIELD(ERROR).means("TRUE where XOUT is not defined; XOUT is then 0"),
                  HY_FIELD(ERRORID).means(
                      "0 no error, 1 divisor zero, 2 argument outside the domain, 3 points of a table do not rise")};
  }
  static CheckedXout of(const S& value, const Bool<S>& error, std::uint16_t id) {
    return {.XOUT = select(error, S(0.0), value),
            .ERROR = error,
            .ERRORID = select(error, Word<S>(id), Word<S>(std::uint16_t{0}))};
  }
};

template <class S, Label unit1, Label unit2>
struct TwoReals {
  S IN1;
  S IN2;
  using Self = TwoReals;
  static constexpr auto fields() {
    return Fields{HY_FIELD(IN1).in(unit1).means("first operand"), HY_FIELD(IN2).in(unit2).means("second operand")};
  }
};

template <class S>
struct TwoBools {
  Bool<S> IN1;
  Bool<S> IN2;
  using Self = TwoBools;
  static constexpr auto fields() {
    return Fields{HY_FIELD(IN1).means("first operand"), HY_FIELD(IN2).means("second operand")};
  }
};

/// Two operands and two more that change nothing where they are not connected.
template <class S, int neutral>
struct FourBools {
  Bool<S> IN1;
  Bool<S> IN2;
  Bool<S> IN3;
  Bool<S> IN4;
  using Self = FourBools;
  static constexpr auto fields() {
    return Fields{HY_FIELD(IN1).means("first operand"), HY_FIELD(IN2).means("second operand"),
                  HY_FIELD(IN3).otherwise(neutral).means("third operand"),
                  HY_FIELD(IN4).otherwise(neutral).means("fourth operand")};
  }
};

template <class S, Label meaning>
struct Truth {
  Bool<S> Q;
  using Self = Truth;
  static constexpr auto fields() { return Fields{HY_FIELD(Q).means(meaning)}; }
};

}  // namespace hysteron
