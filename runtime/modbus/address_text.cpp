#include "runtime/modbus/address_text.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "support/whole_number.hpp"

namespace hysteron::runtime::modbus {
namespace {

struct Notation {
  std::string_view prefix;
  Stretch range;
  std::uint32_t width;
};

constexpr std::array<Notation, 5> words{{
    {"%IW", openplc::input_words, 1},
    {"%QW", openplc::output_words, 1},
    {"%MW", openplc::memory_words, 1},
    {"%MD", openplc::memory_doubles, 2},
    {"%ML", openplc::memory_longs, 4},
}};

std::optional<ParsedAddress> parse_bit(std::string_view rest, const Stretch& range) {
  const auto dot = rest.find('.');
  if (dot == std::string_view::npos) {
    return std::nullopt;
  }
  const auto byte = parse_count(rest.substr(0, dot));
  const auto bit = parse_count(rest.substr(dot + 1));
  if (!byte || !bit || *bit > 7 || *byte * 8 + *bit >= range.count) {
    return std::nullopt;
  }
  return ParsedAddress{.at = {range.area, range.address + *byte * 8 + *bit, 1}};
}

std::optional<ParsedAddress> parse_direct(std::string_view text) {
  if (text.starts_with("%QX")) {
    return parse_bit(text.substr(3), openplc::output_bits);
  }
  if (text.starts_with("%IX")) {
    return parse_bit(text.substr(3), openplc::input_bits);
  }
  for (const auto& [prefix, range, width] : words) {
    if (text.starts_with(prefix)) {
      const auto number = parse_count(text.substr(prefix.size()));
      if (!number || *number >= range.count / width) {
        return std::nullopt;
      }
      return ParsedAddress{.at = {range.area, range.address + *number * width, width}};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::uint32_t> parse_count(std::string_view digits) {
  return digits.size() > 5 ? std::nullopt : whole_number<std::uint32_t>(digits);
}

std::string_view name_of(Area area) {
  switch (area) {
    case Area::coil:
      return "coil";
    case Area::discrete_input:
      return "discrete";
    case Area::holding_register:
      return "holding";
    case Area::input_register:
      return "input";
  }
  return "";
}

std::optional<Area> area_named(std::string_view name) {
  const auto* const found = std::ranges::find_if(areas, [&](Area area) { return name_of(area) == name; });
  return found == areas.end() ? std::nullopt : std::optional(*found);
}

std::optional<ParsedAddress> parse_address(std::string_view text) {
  if (text.starts_with('%')) {
    std::string upper(text);
    std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return parse_direct(upper);
  }
  const auto space = text.find(' ');
  if (space == std::string_view::npos) {
    return std::nullopt;
  }
  const auto area = area_named(text.substr(0, space));
  const auto dot = text.find('.', space);
  const auto number = parse_count(text.substr(space + 1, dot == std::string_view::npos ? dot : dot - space - 1));
  if (!area || !number || *number > 0xFFFF) {
    return std::nullopt;
  }
  if (dot == std::string_view::npos) {
    return ParsedAddress{.at = {*area, *number, 1}, .any_width = true};
  }
  const auto bit = parse_count(text.substr(dot + 1));
  if (!bit || *bit > 15 || holds_bits(*area)) {
    return std::nullopt;
  }
  return ParsedAddress{.at = {*area, *number, 1, static_cast<std::int8_t>(*bit)}, .any_width = true};
}

std::string bit_text(const Stretch& at) {
  return at.is_bit() ? "." + std::to_string(at.bit) : "";
}

std::string address_text(const Stretch& at) {
  return std::string(name_of(at.area)) + " " + std::to_string(at.address) + bit_text(at);
}

}  // namespace hysteron::runtime::modbus
