// The described members of a structure, in order: `Fields{HY_FIELD(A).in("m"), HY_FIELD(B)}`.
//
// std::tuple would hold them as well. Its constructors and their constraints were half of what a compiler's front end
// took for the library, for each scalar anew: a few hundred structures, each with its own types.
#pragma once

#include <cstddef>
#include <utility>

namespace hysteron {
namespace detail {

/// The number makes two fields of one type two bases.
template <std::size_t, class Field>
struct NumberedField {
  Field field;
};

template <class Numbers, class... Field>
class FieldList;
template <std::size_t... I, class... Field>
class FieldList<std::index_sequence<I...>, Field...> : private NumberedField<I, Field>... {
 public:
  constexpr explicit FieldList(const Field&... fields) : NumberedField<I, Field>{fields}... {}

  /// call(first, second, …).
  template <class Call>
  constexpr decltype(auto) apply(const Call& call) const {
    return call(static_cast<const NumberedField<I, Field>&>(*this).field...);
  }
};

}  // namespace detail

template <class... Field>
class Fields : public detail::FieldList<std::index_sequence_for<Field...>, Field...> {
 public:
  static constexpr std::size_t size = sizeof...(Field);
  constexpr explicit Fields(const Field&... fields)
      : detail::FieldList<std::index_sequence_for<Field...>, Field...>(fields...) {}
};

/// The fields of both, in order.
template <class... First, class... Second>
constexpr Fields<First..., Second...> concatenate(const Fields<First...>& first, const Fields<Second...>& second) {
  return first.apply([&](const First&... one) {
    return second.apply([&](const Second&... other) { return Fields<First..., Second...>(one..., other...); });
  });
}

}  // namespace hysteron
