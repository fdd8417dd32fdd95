// The description of a block: what its ports and parameters are called, mean, and may be.
//
// It is written once, in the block's header, and everything printed, checked or derived comes from it: ports,
// units, defaults, tuner bounds, declarations in every target, register maps, reference pages.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "blocks/families.hpp"
#include "blocks/fields.hpp"
#include "blocks/roles.hpp"
#include "blocks/scalar.hpp"

namespace hysteron {

/// The types of the language, by their IEC 61131-3 names LREAL, BOOL, DINT and WORD.
enum class Type : std::uint8_t { Real, Bool, Int, Word };

/// One port, parameter or state of a block, without the C++ member behind it.
///
/// `unit` is written in SI symbols (`m`, `um/V`, `1`) and in the block's own unit variables ('x, 'x/s), which take
/// whatever unit is wired. An empty unit is not checked.
struct Field {
  std::string_view name;
  std::string_view unit;
  std::string_view meaning;
  std::string_view effect;       ///< the physical effect that this parameter switches on by itself; empty for none
  Family family = Family::None;  ///< of that effect
  double effect_minimum = -std::numeric_limits<double>::infinity();  ///< below it, the block is another effect
  double effect_maximum = std::numeric_limits<double>::infinity();   ///< above it, likewise
  double preset = 0.0;
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  double neutral = std::numeric_limits<double>::quiet_NaN();
  std::uint16_t length = 1;  ///< above 1: an array
  Type type = Type::Real;
  bool required = false;       ///< an input that has no default: it must be connected
  bool above_minimum = false;  ///< the minimum itself is out of range
  bool filled = false;         ///< an array of just so many numbers: fewer would mean something else
  bool open = false;           ///< a choice of the machine's past, which a record does not show
  FieldRole role = FieldRole::Number;
  std::string_view shapes{};  ///< the parameter of the same block whose effect it shapes; empty for none

  [[nodiscard]] constexpr bool has_neutral() const { return neutral == neutral; }
};

/// A field tied to the member that holds it.
template <class Struct, class Member>
struct BoundField : Field {
  Member Struct::*member = nullptr;

  [[nodiscard]] constexpr BoundField in(std::string_view the_unit) const {
    auto copy = *this;
    copy.unit = the_unit;
    return copy;
  }
  [[nodiscard]] constexpr BoundField means(std::string_view text) const {
    auto copy = *this;
    copy.meaning = text;
    return copy;
  }
  /// The value where nothing is connected or set. An input without one must be connected.
  [[nodiscard]] constexpr BoundField otherwise(double value) const {
    auto copy = *this;
    copy.preset = value;
    copy.required = false;
    return copy;
  }
  [[nodiscard]] constexpr BoundField within(double low, double high) const {
    auto copy = *this;
    copy.minimum = low;
    copy.maximum = high;
    return copy;
  }
  [[nodiscard]] constexpr BoundField at_least(double low) const {
    auto copy = *this;
    copy.minimum = low;
    return copy;
  }
  [[nodiscard]] constexpr BoundField above(double low) const {
    auto copy = *this;
    copy.minimum = low;
    copy.above_minimum = true;
    return copy;
  }
  /// The setting at which an effect passes its input through unchanged, or at which an enriching block is the block
  /// that it can replace.
  [[nodiscard]] constexpr BoundField neutral_at(double value) const {
    auto copy = *this;
    copy.neutral = value;
    return copy;
  }
  /// The effect that the parameter switches on by itself, away from its neutral setting.
  [[nodiscard]] constexpr BoundField effect(std::string_view identifier, Family of) const {
    auto copy = *this;
    copy.Field::effect = identifier;
    copy.family = of;
    return copy;
  }
  /// What it is for, where its unit does not tell.
  [[nodiscard]] constexpr BoundField role(FieldRole what) const {
    auto copy = *this;
    copy.Field::role = what;
    return copy;
  }
  /// It says how another parameter, which has an effect of its own, takes effect.
  [[nodiscard]] constexpr BoundField shapes(std::string_view name_of_other) const {
    auto copy = *this;
    copy.Field::shapes = name_of_other;
    return copy;
  }
  /// A choice of what was before a record began, which the record does not tell: a diagnosis tries it both ways.
  [[nodiscard]] constexpr BoundField either_way() const {
    auto copy = *this;
    copy.open = true;
    return copy;
  }
  /// Up to where the block is what its effect is called: a resonance rings, above critical damping it lags.
  [[nodiscard]] constexpr BoundField effect_up_to(double value) const {
    auto copy = *this;
    copy.effect_maximum = value;
    return copy;
  }
  /// The same on both sides: a clock that is off by a quarter is none, but another rate.
  [[nodiscard]] constexpr BoundField effect_within(double low, double high) const {
    auto copy = *this;
    copy.effect_minimum = low;
    copy.effect_maximum = high;
    return copy;
  }
};

namespace detail {
template <class Member>
struct MemberType {
  static constexpr Type type = Type::Real;
  static constexpr std::uint16_t length = 1;
};
template <>
struct MemberType<bool> {
  static constexpr Type type = Type::Bool;
  static constexpr std::uint16_t length = 1;
};
template <>
struct MemberType<std::int32_t> {
  static constexpr Type type = Type::Int;
  static constexpr std::uint16_t length = 1;
};
template <>
struct MemberType<std::uint16_t> {
  static constexpr Type type = Type::Word;
  static constexpr std::uint16_t length = 1;
};
template <class T, std::size_t N>
struct MemberType<std::array<T, N>> {
  static constexpr Type type = Type::Real;
  static constexpr auto length = static_cast<std::uint16_t>(N);
};
}  // namespace detail

template <class Struct, class Member>
constexpr BoundField<Struct, Member> describe(Member Struct::*member, std::string_view name) {
  BoundField<Struct, Member> field;
  field.name = name;
  field.member = member;
  field.type = detail::MemberType<Member>::type;
  field.length = detail::MemberType<Member>::length;
  field.required = true;
  return field;
}

/// Ties a member to its description, so that the name is written once: `HY_FIELD(T1).in("s").means("…")`.
/// The structure names itself by `using Self = …`.
#define HY_FIELD(member) ::hysteron::describe(&Self::member, #member)

/// A structure without members: the state of a block that has none, say.
template <class S>
struct NoFields {
  static constexpr auto fields() { return Fields{}; }
};

enum class Group : std::uint8_t { Memory, Arithmetic, Function, Shaping, Dynamics, Control, Logic, Time, Rate };

/// What is said of a block as a whole.
struct About {
  std::string_view name{};   ///< as written in a diagram: HY_LAG
  std::string_view title{};  ///< a few words: First-order lag
  Group group = Group::Arithmetic;
  std::string_view equation{};  ///< the defining equation, in Unicode
  std::string_view meaning{};   ///< a paragraph for its user: what it is for, what it does in the first samples
  std::string_view delay{};     ///< delay and gain curve over frequency, where they matter
  std::string_view source{};    ///< standard, paper or book that defines it
  std::string_view effect{};    ///< identifier of the physical effect that it adds between XIN and XOUT; empty for none
  Family family = Family::None;  ///< of that effect
  /// The block that this one can replace: it has the same ports and parameters of the same meaning and more, and gives
  /// equal bits while every further parameter that has an effect is at its neutral setting. Empty for none.
  std::string_view enriches{};
  /// An effect with fewer parameters, of the same names, that may be meant where this one was found. Empty for none.
  std::string_view simpler{};
  std::string_view untried{};    ///< why a diagnosis tries the effect only where it is asked for it; empty: it does
  bool rate_transition = false;  ///< may stand between two rates (@every)
  bool of_record = false;        ///< its effect is the record's and not the machine's: at the ports of a diagram alone
};

/// The descriptions of one structure, as a plain array.
template <class Struct>
constexpr auto fields_of() {
  return Struct::fields().apply(
      [](const auto&... field) { return std::array<Field, sizeof...(field)>{static_cast<const Field&>(field)...}; });
}

/// What every block offers. S is double here; the contract tests hold it for the other scalars.
template <class B>
concept FunctionBlock = requires(const typename B::template Params<double>& params,
                                 const typename B::template State<double>& state,
                                 const typename B::template In<double>& in, double ts) {
  { B::about } -> std::convertible_to<About>;
  B::template Params<double>::fields();
  B::template State<double>::fields();
  B::template In<double>::fields();
  B::template Out<double>::fields();
  { B::output(params, state, in, ts) } -> std::same_as<typename B::template Out<double>>;
};

/// A block with memory also says how the memory begins and how it moves from one step to the next.
template <class B>
concept HasMemory = !std::is_empty_v<typename B::template State<double>>;

/// A block may work out first what follows from its parameters and TS alone. Its output, update and step then have a
/// form that takes these coefficients behind the parameters, with the same bits. Who runs many steps with the same
/// parameters works them out once.
template <class B>
concept HasCoefficients = requires(const typename B::template Params<double>& params, const double& ts) {
  { B::coefficients(params, ts) } -> std::same_as<typename B::template Coefficients<double>>;
};

/// A block may say output and update in one, where both start from the same costly values.
template <class B>
concept StepsAtOnce = requires(const typename B::template Params<double>& params,
                               typename B::template State<double>& state, const typename B::template In<double>& in,
                               const double& ts) {
  B::template step<double>(params, state, in, ts);
};

}  // namespace hysteron
