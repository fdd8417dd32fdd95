#include "runtime/modbus/lock_file.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime::modbus {
namespace {

std::optional<LockLine> parse_line(const std::string& text, std::uint32_t holding_end) {
  std::istringstream words(text);
  std::string area;
  std::string number;
  std::string type;
  LockLine line;
  std::string rest;
  if (!(words >> area >> number >> type >> line.name) || words >> rest) {
    return std::nullopt;
  }
  const auto parsed = parse_address(area + " " + number);
  const auto known = register_type_named(type);
  if (!parsed || !known || parsed->at.is_boolean() != (*known == PointType::boolean)) {
    return std::nullopt;
  }
  line.type = *known;
  line.at = parsed->at;
  line.at.count = static_cast<std::uint32_t>(registers_of(*known));
  const std::uint32_t end = line.at.area == Area::holding_register ? holding_end : 0x10000;
  return line.at.address + line.at.count <= end ? std::optional(line) : std::nullopt;
}

}  // namespace

std::vector<LockLine> read_lock(const std::string& file, const std::string& text, std::uint32_t holding_end,
                                Diagnostics& diagnostics) {
  std::vector<LockLine> lines;
  std::map<std::tuple<std::string, Area, std::string>, Place> seen;
  std::istringstream stream(text);
  std::uint32_t number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.ends_with('\r')) {
      line.pop_back();
    }
    if (line.empty() || line.starts_with('#')) {
      continue;
    }
    const Place place{.file = file, .line = number, .column = 1, .length = static_cast<std::uint32_t>(line.size())};
    auto parsed = parse_line(line, holding_end);
    if (!parsed) {
      diagnostics.error(error::lock_file_syntax, place, "The line is no address of a lock file.",
                        "write area, number, type and name, as in: holding 16 real64 HYST.C1; or delete the line, and "
                        "the point gets a new address");
      continue;
    }
    parsed->place = place;
    const auto [first, is_new] = seen.emplace(std::tuple(parsed->name, parsed->at.area, name_of(parsed->type)), place);
    if (!is_new) {
      diagnostics.error(error::point_addressed_twice, place, fmt::format("{} is given a second address.", parsed->name),
                        "keep the line by which clients know the point, and delete the other",
                        {{first->second, "the first"}});
      continue;
    }
    lines.push_back(std::move(*parsed));
  }
  return lines;
}

std::string lock_text(const RegisterMap& map) {
  std::string text = fmt::format("# Addresses of {}. Keep this file with the diagram.\n", map.title());
  for (const MapEntry& entry : map.entries()) {
    text += fmt::format("{} {} {}\n", address_text(entry.at), name_of(entry.format.type), map.point_of(entry).name);
  }
  if (!map.retired().empty()) {
    text += "# Of points that are gone; nobody else gets these.\n";
  }
  for (const RetiredAddress& gone : map.retired()) {
    text += fmt::format("{} {} {}\n", address_text(gone.at), name_of(gone.type), gone.name);
  }
  return text;
}

}  // namespace hysteron::runtime::modbus
