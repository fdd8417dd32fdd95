// A set of effects in words, as the verdict, the report and the next experiment name it.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>
#include <string>
#include <string_view>

namespace hysteron::diagnosis {

/// The empty set: nothing is added to the diagram, its parameters were fitted anew. It reads in a list, and in "would
/// tell lag from …".
inline constexpr std::string_view no_effect = "the fitted parameters alone";

/// creep + lag
[[nodiscard]] inline std::string words_of_set(std::span<const std::string> effects) {
  return effects.empty() ? std::string(no_effect) : fmt::format("{}", fmt::join(effects, " + "));
}

}  // namespace hysteron::diagnosis
