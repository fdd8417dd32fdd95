#include "tool/option_values.hpp"

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "support/numbers.hpp"
#include "support/whole_number.hpp"

namespace hysteron::tool {
namespace {

/// Its description is empty: the help names the value by option_text.
CLI::Validator validator(std::string wanted, std::function<bool(std::string_view)> takes) {
  return {[wanted = std::move(wanted), takes = std::move(takes)](std::string& given) {
            return takes(given) ? std::string() : fmt::format("{} is needed, not {}", wanted, given);
          },
          ""};
}

bool is_number(std::string_view text, const std::function<bool(double)>& takes) {
  const ParsedNumber number = parse_number(text);
  return number.status == NumberStatus::Finite && takes(number.value);
}

}  // namespace

CLI::Validator whole_number_from(std::uint64_t least) {
  return validator(fmt::format("a whole number from {} on", least),
                   [least](std::string_view text) { return whole_number(text, least).has_value(); });
}

CLI::Validator number_from_zero() {
  return validator("a number from 0 on",
                   [](std::string_view text) { return is_number(text, [](double number) { return number >= 0.0; }); });
}

CLI::Validator number_between(double least, double most) {
  return validator(fmt::format("a number from {} to {}", number_text(least), number_text(most)),
                   [least, most](std::string_view text) {
                     return is_number(text, [least, most](double number) { return number >= least && number <= most; });
                   });
}

CLI::Validator number_above_zero() {
  return validator("a number above 0",
                   [](std::string_view text) { return is_number(text, [](double number) { return number > 0.0; }); });
}

}  // namespace hysteron::tool
