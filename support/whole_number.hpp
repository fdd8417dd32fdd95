// Whole numbers from text, and nothing else: the one reader of them. No locale is involved.
#pragma once

#include <charconv>
#include <concepts>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>

namespace hysteron {

/// The whole text as a whole number from `low` to `high`: digits of the base, behind a minus where the type has one. An
/// empty text, a plus, blanks, a rest and what is outside of these limits are none.
template <std::integral Whole>
[[nodiscard]] std::optional<Whole> whole_number(std::string_view text, Whole low = std::numeric_limits<Whole>::lowest(),
                                                Whole high = std::numeric_limits<Whole>::max(), int base = 10) {
  Whole value{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  const bool is_whole = problem == std::errc{} && end == text.data() + text.size();
  return is_whole && value >= low && value <= high ? std::optional(value) : std::nullopt;
}

}  // namespace hysteron
