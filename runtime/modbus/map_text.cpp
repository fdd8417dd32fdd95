#include "runtime/modbus/map_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/csv_cell.hpp"
#include "support/json_number.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr const char* kind_name(PointKind kind) {
  switch (kind) {
    case PointKind::input:
      return "input";
    case PointKind::output:
      return "output";
    case PointKind::parameter:
      return "parameter";
    case PointKind::status:
      return "status";
    case PointKind::command:
      return "command";
  }
  return "";
}

std::string access_of(const Point& point) {
  return point.writable ? "read write" : "read";
}

/// Of what has one.
std::string_view order_of(const MapEntry& entry) {
  return entry.at.count > 1 ? name_of(entry.format.order) : std::string_view();
}

/// The type as a reader of a table wants it: int16, 0.01·raw - 5, CDAB where that is not the order of the map.
std::string format_text(const MapEntry& entry, WordOrder usual) {
  const PointFormat& format = entry.format;
  std::string text = name_of(format.type);
  if (format.is_scaled()) {
    text += fmt::format(", {}·raw", number_text(format.scale));
    text += format.offset == 0.0 ? ""
            : format.offset > 0  ? fmt::format(" + {}", number_text(format.offset))
                                 : fmt::format(" - {}", number_text(-format.offset));
  }
  return text + (entry.at.count > 1 && format.order != usual ? fmt::format(", {}", name_of(format.order)) : "");
}

std::string discovery_text(const RegisterMap& map) {
  return map.chain().empty() ? std::string()
         : map.is_in_files()
             ? fmt::format("The same table can be read over Modbus by function 20, as holding register {} says.\n",
                           chain_address)
             : fmt::format("The same table can be read over Modbus from holding register {}.\n", chain_address);
}

std::string markdown_cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  }
  return escaped;
}

/// Printable as it is; quotes and backslashes escaped.
std::string cpp_text(const std::string& text) {
  std::string escaped = "\"";
  for (const char c : text) {
    escaped += c == '"' || c == '\\' ? std::string("\\") + c : c == '\n' ? "\\n" : std::string(1, c);
  }
  return escaped + '"';
}

std::string namespace_of(const std::string& title) {
  std::string name;
  for (const char c : title) {
    const auto letter = static_cast<unsigned char>(c);
    name += std::isalnum(letter) != 0 ? static_cast<char>(std::tolower(letter)) : '_';
  }
  return name + "_registers";
}

constexpr std::string_view hashed_columns =
    "area,address,registers,type,name,unit,low,high,access,kind,meaning,bit,scale,offset,word_order";

std::string hashed_cells(const RegisterMap& map, const MapEntry& entry) {
  const Point& point = map.point_of(entry);
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", name_of(entry.at.area), entry.at.address,
                     entry.at.count, name_of(entry.format.type), csv_cell(point.name), csv_cell(point.unit),
                     number_text(point.low), number_text(point.high), access_of(point), kind_name(point.kind),
                     csv_cell(point.meaning), entry.at.is_bit() ? std::to_string(entry.at.bit) : "",
                     number_text(entry.format.scale), number_text(entry.format.offset), order_of(entry));
}

}  // namespace

std::string reference_number(const Stretch& at) {
  constexpr std::array<int, 4> digits{0, 1, 4, 3};
  return fmt::format("{}{:05}{}", digits[static_cast<std::size_t>(at.area)], at.address + 1, bit_text(at));
}

std::string hashed_text(const RegisterMap& map) {
  std::string text = std::string(hashed_columns) + "\n";
  for (const MapEntry& entry : map.entries()) {
    text += hashed_cells(map, entry) + "\n";
  }
  return text;
}

std::string as_csv(const RegisterMap& map) {
  std::string text = std::string(hashed_columns) + ",retained\n";
  for (const MapEntry& entry : map.entries()) {
    text += hashed_cells(map, entry) + (map.point_of(entry).is_retained ? ",true\n" : ",false\n");
  }
  return text;
}

std::string as_json(const RegisterMap& map) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    list.push_back({{"name", point.name},
                    {"area", name_of(entry.at.area)},
                    {"address", entry.at.address},
                    {"registers", entry.at.count},
                    {"reference", reference_number(entry.at)},
                    {"bit", entry.at.is_bit() ? nlohmann::ordered_json(int{entry.at.bit}) : nullptr},
                    {"type", name_of(entry.format.type)},
                    {"scale", entry.format.scale},
                    {"offset", entry.format.offset},
                    {"word_order", entry.at.count > 1 ? nlohmann::ordered_json(order_of(entry)) : nullptr},
                    {"unit", point.unit},
                    {"low", number_or_null<nlohmann::ordered_json>(point.low)},
                    {"high", number_or_null<nlohmann::ordered_json>(point.high)},
                    {"writable", point.writable},
                    {"retained", point.is_retained},
                    {"kind", kind_name(point.kind)},
                    {"meaning", point.meaning}});
  }
  const nlohmann::ordered_json root{
      {"title", map.title()},
      {"hash", map.hash()},
      {"word_order", name_of(map.order())},
      {"discovery", map.chain().empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(chain_address)},
      {"points", list}};
  return root.dump(2) + "\n";
}

std::string as_markdown(const RegisterMap& map) {
  std::string text = fmt::format(
      "# Registers of {}\n\nMap `{}`. Word order {}: values of 32 and 64 bits take two and four registers.\n{}\n"
      "| area | address | reference | type | name | unit | from | to | access | meaning |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      map.title(), map.hash(), name_of(map.order()), discovery_text(map));
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    const auto bound = [](double value) { return std::isfinite(value) ? number_text(value) : std::string(); };
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name_of(entry.at.area),
                        std::to_string(entry.at.address) + bit_text(entry.at), reference_number(entry.at),
                        format_text(entry, map.order()), markdown_cell(point.name), markdown_cell(point.unit),
                        bound(point.low), bound(point.high), access_of(point) + (point.is_retained ? ", retained" : ""),
                        markdown_cell(point.meaning));
  }
  return text;
}

std::string as_cpp(const RegisterMap& map) {
  std::string text = fmt::format(
      R"(// Registers of {0}, for a Modbus client. Map {1}, word order {2}.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace {3} {{

inline constexpr std::string_view map_hash = "{1}";
inline constexpr std::string_view word_order = "{2}";

enum class Area : std::uint8_t {{ coil, discrete, holding, input }};

struct Register {{
  std::string_view name;
  Area area;
  std::uint16_t address;
  std::uint16_t count;
  std::string_view type;
  std::string_view unit;
  bool writable;
  double scale;  // value = scale * raw + offset
  double offset;
  std::string_view word_order;
  int bit;  // of a boolean in a register; else -1
  bool retained;  // what was written is there again after a restart
}};

inline constexpr std::array<Register, {4}> registers{{{{
)",
      map.title(), map.hash(), name_of(map.order()), namespace_of(map.title()), map.entries().size());
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    text += fmt::format("    {{{}, Area::{}, {}, {}, \"{}\", {}, {}, {}, {}, \"{}\", {}, {}}},\n", cpp_text(point.name),
                        name_of(entry.at.area), entry.at.address, entry.at.count, name_of(entry.format.type),
                        cpp_text(point.unit), point.writable, number_text(entry.format.scale),
                        number_text(entry.format.offset), order_of(entry), static_cast<int>(entry.at.bit),
                        point.is_retained);
  }
  text += fmt::format(R"(}}}};

/// at("HYST.C1"), found by the compiler; a name that is not in the map does not compile.
consteval Register at(std::string_view name) {{
  for (const Register& one : registers) {{
    if (one.name == name) {{
      return one;
    }}
  }}
  throw "no such point";
}}

}}  // namespace {}
)",
                      namespace_of(map.title()));
  return text;
}

}  // namespace hysteron::runtime::modbus
