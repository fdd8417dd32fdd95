#include "records/text/cell_mend.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <cstdint>

#include "records/text/cell_value.hpp"
#include "records/text/characters.hpp"

namespace hysteron::records {
namespace {

bool is_plain_number(std::string_view text) {
  const CellValue value = cell_value(text);
  return value.kind == CellKind::Number && value.unit.empty() && value.label.empty();
}

/// The one number of a text like 1.5V, [1.5] and np.float64(1.5), longest first; empty where there are none or several.
std::string_view number_in(std::string_view text) {
  const auto begins_number = [&](std::size_t at) {
    return (is_digit(text[at]) || text[at] == '-' || text[at] == '+' || text[at] == '.') &&
           (at == 0 || !(is_letter(text[at - 1]) || is_digit(text[at - 1]) || text[at - 1] < 0));
  };
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (std::size_t length = begins_number(at) ? text.size() - at : 0; length > 0; --length) {
      if (is_digit(text[at + length - 1]) && is_plain_number(text.substr(at, length))) {
        const std::string_view rest = text.substr(at + length);
        return rest.find_first_of("0123456789") == std::string_view::npos ? text.substr(at, length) : "";
      }
    }
  }
  return {};
}

}  // namespace

std::optional<std::string> mend_by_number(std::string_view word) {
  const bool is_base_16 = word.starts_with("0x") || word.starts_with("0X") || word.starts_with("16#");
  if (is_base_16) {
    std::uint64_t value = 0;
    const std::size_t prefix = word.starts_with("16#") ? 3 : 2;
    const auto [end, problem] = std::from_chars(word.data() + prefix, word.data() + word.size(), value, 16);
    return problem == std::errc{} && end == word.data() + word.size()
               ? std::optional(
                     fmt::format("it is hexadecimal: write {}, as all of the column in decimal digits.", value))
               : std::nullopt;
  }
  if (word.size() > 2 && word.front() == '(' && word.back() == ')' &&
      is_plain_number(word.substr(1, word.size() - 2))) {
    return fmt::format("if brackets mean a negative number, write -{}.", word.substr(1, word.size() - 2));
  }
  if (word.ends_with('-') && is_plain_number(word.substr(0, word.size() - 1))) {
    return fmt::format("if the sign stands behind the number, write -{}.", word.substr(0, word.size() - 1));
  }
  const std::string_view number = number_in(word);
  if (number.empty() || word.size() > 40) {
    return std::nullopt;
  }
  const std::string_view behind = word.substr(static_cast<std::size_t>(number.data() - word.data()) + number.size());
  if (behind == "m" || behind == "k" || behind == "u" || behind == "n" || behind == "M" || behind == "G") {
    return fmt::format("{} behind a number may be a prefix: write {} without it, all rows in one unit.", behind, word);
  }
  return fmt::format("write the number alone, {}, in all rows; a unit stands in the name of the column.", number);
}

}  // namespace hysteron::records
