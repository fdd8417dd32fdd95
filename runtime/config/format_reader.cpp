#include "runtime/config/format_reader.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "runtime/modbus/register_map.hpp"

namespace hysteron::runtime {

std::optional<modbus::GivenFormat> read_format(TomlReader& table) {
  modbus::GivenFormat format;
  constexpr std::size_t none = modbus::register_types.size();
  std::size_t type = none;
  table.read_choice("type", type);
  if (type != none) {
    format.type = modbus::register_types.at(type);
  }
  table.read("scale", format.scale);
  table.read("offset", format.offset);
  std::size_t order = modbus::word_orders.size();
  table.read_choice("word_order", order);
  if (order != modbus::word_orders.size()) {
    format.order = modbus::word_orders.at(order);
  }
  constexpr std::array<std::string_view, 4> keys{"type", "scale", "offset", "word_order"};
  const bool has_any = std::ranges::any_of(keys, [&](std::string_view key) { return table.has(key); });
  return has_any ? std::optional(format) : std::nullopt;
}

std::int8_t read_bit(TomlReader& table) {
  std::int8_t bit = modbus::no_bit;
  table.read_whole("bit", bit);
  return bit;
}

}  // namespace hysteron::runtime
