// The name of an element of a vector, `Y[2]`: of a variable of a diagram, or of a pin of a block.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "support/names.hpp"

namespace hysteron {

/// What the name of an element says: of `Y[2]`, Y and 2.
struct ElementName {
  std::string_view vector{};
  std::int64_t index = 0;
};

/// Empty for other names.
[[nodiscard]] inline std::optional<ElementName> element_of(std::string_view name) {
  const auto bracket = name.find('[');
  if (bracket == std::string_view::npos || !name.ends_with(']')) {
    return std::nullopt;
  }
  ElementName result{.vector = name.substr(0, bracket)};
  const char* const last = name.data() + name.size() - 1;
  const auto [end, problem] = std::from_chars(name.data() + bracket + 1, last, result.index);
  return problem == std::errc{} && end == last ? std::optional(result) : std::nullopt;
}

/// Whether a name is the wanted one, or an element of the vector that is named so; case makes no difference.
[[nodiscard]] inline bool is_or_is_element_of(std::string_view name, std::string_view wanted) {
  const auto element = element_of(name);
  return equal_ignoring_case(name, wanted) || (element && equal_ignoring_case(element->vector, wanted));
}

/// `Y[2]`.
[[nodiscard]] inline std::string element_name(std::string_view vector, std::int64_t index) {
  return std::string(vector) + "[" + std::to_string(index) + "]";
}

/// `Y_2`, and `Y_M1` of `Y[-1]`: an element as a variable of its own, where a name has no brackets.
[[nodiscard]] inline std::string flat_element_name(std::string_view vector, std::int64_t index) {
  const std::string digits = std::to_string(index);
  return std::string(vector) + "_" + (index < 0 ? "M" + digits.substr(1) : digits);
}

/// A name as a key of TOML: that of an element stands in quotes, "Y[2]".
[[nodiscard]] inline std::string toml_key(const std::string& name) {
  return element_of(name) ? "\"" + name + "\"" : name;
}

}  // namespace hysteron
