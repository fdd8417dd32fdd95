// Names without regard to case, and the nearest known name for "did you mean".
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace hysteron {

/// Whether two names are the same but for the case of ASCII letters.
[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);

/// Whether a name is one of some, without regard to case.
[[nodiscard]] bool is_one_of(std::string_view name, std::span<const std::string_view> known);
[[nodiscard]] inline bool is_one_of(std::string_view name, std::initializer_list<std::string_view> known) {
  return is_one_of(name, std::span(known.begin(), known.size()));
}

/// The name in ASCII capitals: the form to compare and sort by.
[[nodiscard]] std::string in_capitals(std::string_view name);

/// The number of single-character edits (insert, delete, replace, swap of neighbours) between two names, without
/// regard to case; limit + 1 where there are more than `limit`.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit);

/// The candidate nearest to a mistyped name: at most one edit for every three characters of the name, so none for a
/// name of one or two letters, where C1 would be near C2. The first of equals. Empty where none is near.
[[nodiscard]] std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates);
[[nodiscard]] std::string_view nearest_name(std::string_view name, std::span<const std::string> candidates);

/// Of the pins or members of one thing, the one that is meant by a name: the nearest, else the only one that begins or
/// ends with it, as XIN does with IN, and T1 with T. Empty where there is none.
[[nodiscard]] std::string_view meant_member(std::string_view name, std::span<const std::string> members);

}  // namespace hysteron
