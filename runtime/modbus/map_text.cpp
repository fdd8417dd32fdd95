#include "runtime/modbus/map_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

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

}  // namespace

std::string reference_number(const Stretch& at) {
  constexpr std::array<int, 4> digits{0, 1, 4, 3};
  return fmt::format("{}{:05}", digits[static_cast<std::size_t>(at.area)], at.address + 1);
}

std::string as_csv(const RegisterMap& map) {
  std::string text = "area,address,registers,type,name,unit,low,high,access,kind,meaning\n";
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", name_of(entry.at.area), entry.at.address, entry.at.count,
                        name_of(point.type), csv_cell(point.name), csv_cell(point.unit), number_text(point.low),
                        number_text(point.high), access_of(point), kind_name(point.kind), csv_cell(point.meaning));
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
                    {"type", name_of(point.type)},
                    {"unit", point.unit},
                    {"low", number_or_null<nlohmann::ordered_json>(point.low)},
                    {"high", number_or_null<nlohmann::ordered_json>(point.high)},
                    {"writable", point.writable},
                    {"kind", kind_name(point.kind)},
                    {"meaning", point.meaning}});
  }
  const nlohmann::ordered_json root{{"title", map.title()},
                                    {"hash", map.hash()},
                                    {"word_order", name_of(map.order())},
                                    {"discovery", chain_address},
                                    {"points", list}};
  return root.dump(2) + "\n";
}

std::string as_markdown(const RegisterMap& map) {
  std::string text = fmt::format(
      "# Registers of {}\n\nMap `{}`. Word order {}: values of 32 and 64 bits take two and four registers.\n"
      "The same table can be read over Modbus from holding register {}.\n\n"
      "| area | address | reference | type | name | unit | from | to | access | meaning |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      map.title(), map.hash(), name_of(map.order()), chain_address);
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    const auto bound = [](double value) { return std::isfinite(value) ? number_text(value) : std::string(); };
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name_of(entry.at.area),
                        entry.at.address, reference_number(entry.at), name_of(point.type), markdown_cell(point.name),
                        markdown_cell(point.unit), bound(point.low), bound(point.high), access_of(point),
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
}};

inline constexpr std::array<Register, {4}> registers{{{{
)",
      map.title(), map.hash(), name_of(map.order()), namespace_of(map.title()), map.entries().size());
  for (const MapEntry& entry : map.entries()) {
    const Point& point = map.point_of(entry);
    text += fmt::format("    {{{}, Area::{}, {}, {}, \"{}\", {}, {}}},\n", cpp_text(point.name), name_of(entry.at.area),
                        entry.at.address, entry.at.count, name_of(point.type), cpp_text(point.unit), point.writable);
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
