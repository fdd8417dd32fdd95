// Random inputs and parameters for any block, from its description; and the same values in another scalar.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <type_traits>
#include <vector>

#include "blocks/description.hpp"

namespace hysteron::testing {

namespace detail {
template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t N>
inline constexpr bool is_array<std::array<T, N>> = true;
}  // namespace detail

/// Random values within the ranges of fields. A given seed gives the same values on every machine.
class RandomIo {
 public:
  /// `ts` scales the times: a field in seconds lies within some 30 samples.
  explicit RandomIo(std::uint64_t seed, double ts) : engine_(seed), ts_(ts) {}

  /// Between 0 and 1, never either.
  double unit() { return (static_cast<double>(engine_() >> 12U) + 0.5) * 0x1p-52; }

  /// A structure of double (or float) with every member at a random value in its range. Truth values stand at their
  /// preset nine times in ten, so that a reset does not happen in every other step. Arrays rise.
  template <class Struct>
  Struct make() {
    Struct result{};
    Struct::fields().apply([&](const auto&... field) { (set(result.*(field.member), field), ...); });
    return result;
  }

 private:
  template <class Member>
  void set(Member& member, const Field& field) {
    if constexpr (detail::is_array<Member>) {
      double value = -1.0;
      for (auto& element : member) {
        value += 0.01 + unit();
        element = static_cast<typename Member::value_type>(value);
      }
    } else if constexpr (std::is_same_v<Member, bool>) {
      const bool usual = field.required ? unit() < 0.5 : field.preset != 0.0;
      member = unit() < 0.9 ? usual : !usual;
    } else if constexpr (std::is_integral_v<Member>) {
      const double low = std::max(field.minimum, field.type == Type::Word ? 0.0 : -10.0);
      const double high = std::max(low, std::min(field.maximum, 50.0));
      member = static_cast<Member>(low + std::floor(unit() * (high - low + 1.0)));
    } else {
      member = static_cast<Member>(real(field));
    }
  }
  double real(const Field& field) {
    const double reach = field.unit == "s" ? 30.0 * ts_ : 10.0;
    const double low = std::isfinite(field.minimum) ? field.minimum : std::min(-reach, field.maximum - reach);
    const double high = std::isfinite(field.maximum) ? field.maximum : std::max(reach, low + reach);
    return low + unit() * (high - low);
  }

  std::mt19937_64 engine_;
  double ts_;
};

/// A value of double, bool, std::int32_t, std::uint16_t or an array as the same thing of another scalar.
template <class To, class From>
To convert_value(const From& from) {
  if constexpr (detail::is_array<From>) {
    To to{};
    std::ranges::transform(from, to.begin(), [](const auto& x) { return convert_value<typename To::value_type>(x); });
    return to;
  } else {
    return static_cast<To>(from);
  }
}

/// A structure of one scalar as the structure of another scalar, member by member.
template <class To, class From>
To convert(const From& from) {
  To to{};
  From::fields().apply([&](const auto&... source) {
    To::fields().apply([&](const auto&... target) {
      ((to.*(target.member) =
            convert_value<std::remove_reference_t<decltype(to.*(target.member))>>(from.*(source.member))),
       ...);
    });
  });
  return to;
}

/// Sets every field that has a neutral setting to it; says how many there are.
template <class Struct>
int neutralise(Struct& structure) {
  int count = 0;
  const auto set = [&](const auto& field) {
    using Member = std::remove_reference_t<decltype(structure.*(field.member))>;
    if constexpr (!detail::is_array<Member>) {
      if (field.has_neutral()) {
        structure.*(field.member) = static_cast<Member>(field.neutral);
        ++count;
      }
    }
  };
  Struct::fields().apply([&](const auto&... field) { (set(field), ...); });
  return count;
}

/// The bits of a structure's members, in order: equal vectors are equal structures, to the bit.
template <class Struct>
std::vector<std::uint64_t> bits(const Struct& structure) {
  std::vector<std::uint64_t> result;
  const auto append = [&]<class Member>(auto&& self, const Member& member) -> void {
    if constexpr (detail::is_array<Member>) {
      for (const auto& element : member) {
        self(self, element);
      }
    } else if constexpr (requires { member.value(); }) {
      self(self, member.value());
    } else if constexpr (std::is_same_v<Member, double>) {
      result.push_back(std::bit_cast<std::uint64_t>(member));
    } else if constexpr (std::is_same_v<Member, float>) {
      result.push_back(std::bit_cast<std::uint32_t>(member));
    } else {
      result.push_back(static_cast<std::uint64_t>(member));
    }
  };
  Struct::fields().apply([&](const auto&... field) { (append(append, structure.*(field.member)), ...); });
  return result;
}

/// The real members of a structure, as double.
template <class Struct>
std::vector<double> reals(const Struct& structure) {
  std::vector<double> result;
  const auto append = [&]<class Member>(const Member& member) {
    if constexpr (std::is_floating_point_v<Member>) {
      result.push_back(static_cast<double>(member));
    }
  };
  Struct::fields().apply([&](const auto&... field) { (append(structure.*(field.member)), ...); });
  return result;
}

}  // namespace hysteron::testing
