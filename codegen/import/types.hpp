// What types, functions and literals of other systems are in a diagram.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blocks/description.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::import {

/// What a variable or a wire carries: one value, or a vector of them.
struct Carried {
  Type type = Type::Real;
  std::int64_t low = 0;    ///< of a vector: its first place
  std::int64_t high = -1;  ///< and its last; below the first: one value

  Carried() = default;
  constexpr Carried(Type of_one) : type(of_one) {}  // NOLINT: one value carries its type
  constexpr Carried(Type of_each, std::int64_t from, std::int64_t to) : type(of_each), low(from), high(to) {}

  [[nodiscard]] bool is_vector() const { return high >= low; }
  [[nodiscard]] bool has_place(std::int64_t place) const { return low <= place && place <= high; }
  /// The same bounds, of another type.
  [[nodiscard]] Carried of(Type other) const { return {other, low, high}; }
};

struct KnownType {
  Carried carried{};
  std::string_view note{};  ///< what to mind; empty where it is the same type
};

/// An elementary type by its name in IEC 61131-3, or an array of one dimension of such; nothing where no type of a
/// diagram can stand for it.
[[nodiscard]] std::optional<KnownType> known_type(std::string_view name);

/// As a diagram declares it: LREAL, or ARRAY[0..2] OF LREAL.
[[nodiscard]] std::string declared_text(const Carried& carried);

/// A literal of a type as a diagram has it: 2 for an LREAL is 2.0.
[[nodiscard]] std::string real_text(Type type, const std::string& literal);

/// `[1.5, 2.5]` by its elements; empty where the text is no such list.
[[nodiscard]] std::vector<std::string> elements_of_list(std::string_view text);

/// The block of the library that a function block of the standard is: TON is HY_TON. Null where there is none.
[[nodiscard]] const BlockType* known_block(std::string_view name);

/// The function of a diagram that does the same: REAL_TO_DINT is LREAL_TO_DINT. "MOVE" for what hands its input on;
/// empty where there is none.
[[nodiscard]] std::string known_function(std::string_view name);

/// A text with its literals as a diagram has them: T#500ms is 0.5, REAL#1.5 is LREAL#1.5, INT#3 is DINT#3.
[[nodiscard]] std::string with_known_literals(std::string_view text);

/// T#1s500ms in seconds; nothing where it is no duration.
[[nodiscard]] std::optional<double> seconds_of(std::string_view literal);

}  // namespace hysteron::import
