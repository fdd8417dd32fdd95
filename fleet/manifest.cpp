#include "fleet/manifest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "fleet/when.hpp"
#include "support/byte_order_mark.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "support/trimmed.hpp"

namespace hysteron::fleet {
namespace {

namespace fs = std::filesystem;

/// A line as written. A command is not known before its cells are read.
struct ManifestLine {
  Unit unit{};
  std::string command{};
};

enum class Needed : std::uint8_t { Always, ByParameters, ByLogs, Never };

struct Column {
  std::string_view name;
  std::string& (*cell)(ManifestLine&);
  Needed needed;
};
constexpr std::array<Column, 7> columns{
    {{"machine", [](ManifestLine& line) -> std::string& { return line.unit.machine; }, Needed::Always},
     {"diagram", [](ManifestLine& line) -> std::string& { return line.unit.diagram; }, Needed::Always},
     {"params", [](ManifestLine& line) -> std::string& { return line.unit.parameters; }, Needed::ByParameters},
     {"log", [](ManifestLine& line) -> std::string& { return line.unit.log; }, Needed::ByLogs},
     {"when", [](ManifestLine& line) -> std::string& { return line.unit.when; }, Needed::Never},
     {"group", [](ManifestLine& line) -> std::string& { return line.unit.group; }, Needed::Never},
     {"command", [](ManifestLine& line) -> std::string& { return line.command; }, Needed::Never}}};

bool is_needed(const Column& column, Command command) {
  return column.needed == Needed::Always || (column.needed == Needed::ByParameters && needs_parameters(command)) ||
         (column.needed == Needed::ByLogs && always_needs_log(command));
}

/// The cells of a line; nothing where a quotation mark is not closed, or text follows one that is.
std::optional<std::vector<std::string>> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  std::size_t at = 0;
  while (true) {
    const auto begin = std::min(line.find_first_not_of(" \t", at), line.size());
    std::string cell;
    if (begin < line.size() && line[begin] == '"') {
      std::size_t i = begin + 1;
      for (; i < line.size(); ++i) {
        if (line[i] != '"') {
          cell += line[i];
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          cell += line[i++];
        } else {
          break;
        }
      }
      const bool closed = i < line.size();
      at = closed ? std::min(line.find(',', i), line.size()) : line.size();
      if (!closed || !trimmed(line.substr(i + 1, at - i - 1)).empty()) {
        return std::nullopt;
      }
    } else {
      const auto end = std::min(line.find(',', at), line.size());
      cell = trimmed(line.substr(at, end - at));
      at = end;
    }
    cells.push_back(std::move(cell));
    if (at >= line.size()) {
      return cells;
    }
    ++at;
  }
}

std::vector<std::string> names_of_columns() {
  std::vector<std::string> names;
  names.reserve(std::size(columns));
  for (const Column& one : columns) {
    names.emplace_back(one.name);
  }
  return names;
}

/// Which column each cell is; a null one where its name is wrong, which is reported.
std::vector<const Column*> header_of(const std::vector<std::string>& cells, Command otherwise, const Place& place,
                                     Diagnostics& found) {
  std::vector<const Column*> header;
  for (const std::string& cell : cells) {
    const auto* const one = std::ranges::find(columns, std::string_view(cell), &Column::name);
    const bool known = one != columns.end();
    if (!known) {
      found.error(error::unknown_manifest_column, place,
                  fmt::format("the manifest has a column \"{}\", which means nothing.", cell),
                  fmt::format("remove it, or correct its name; columns are {}.", fmt::join(names_of_columns(), ", ")));
    } else if (std::ranges::find(header, one) != header.end()) {
      found.error(error::duplicate_column, place, fmt::format("column \"{}\" of the manifest is there twice.", cell),
                  "remove one of them.");
    }
    header.push_back(known ? one : nullptr);
  }
  const bool has_commands =
      std::ranges::any_of(header, [](const Column* one) { return one != nullptr && one->name == "command"; });
  for (const Column& one : columns) {
    const bool needed = one.needed == Needed::Always || (!has_commands && is_needed(one, otherwise));
    if (needed && std::ranges::find(header, &one) == header.end()) {
      found.error(error::missing_column, place, fmt::format("the manifest has no column {}.", one.name),
                  "add it; the first line names the columns, as machine,diagram,params,log,when.");
    }
  }
  return header;
}

void read_command(ManifestLine& line, Command otherwise, const Place& place, Diagnostics& found) {
  const auto named = line.command.empty() ? otherwise : command_named(line.command);
  if (!named) {
    found.error(error::bad_usage, place, fmt::format("the command \"{}\" is none of a fleet.", line.command),
                "write diagnose, tune or check, or leave the cell empty.");
  }
  line.unit.command = named.value_or(otherwise);
}

void read_time(Unit& unit, const Place& place, Diagnostics& found) {
  if (unit.when.empty()) {
    return;
  }
  const auto seconds = seconds_of(unit.when);
  if (!seconds) {
    found.error(error::no_date, place, fmt::format("the time \"{}\" of {} is no date.", unit.when, unit.machine),
                "write it as 2026-05-02, 2026-05-02T06:30 or 2026-05-02T06:30+02:00, or as seconds since 1970.");
  }
  unit.time = seconds.value_or(not_a_number);
}

Unit unit_of(const std::vector<std::string>& cells, const std::vector<const Column*>& header, Command otherwise,
             const Place& place, Diagnostics& found) {
  ManifestLine line{.unit = {.line = place.line}};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    header[i]->cell(line) = cells[i];
  }
  read_command(line, otherwise, place, found);
  for (const Column& one : columns) {
    if (is_needed(one, line.unit.command) && one.cell(line).empty()) {
      found.error(error::bad_usage, place,
                  fmt::format("{} needs a cell {}, and it is empty.", name_of(line.unit.command), one.name),
                  "write it, or remove the line.");
    }
  }
  Unit& unit = line.unit;
  read_time(unit, place, found);
  const fs::path folder = fs::path(place.file).parent_path();
  for (std::string* const file : {&unit.diagram, &unit.parameters, &unit.log}) {
    std::error_code unknown;
    if (!file->empty()) {
      *file = (folder / *file).string();  // an absolute name stays as it is
      if (file != &unit.log && !fs::is_regular_file(*file, unknown)) {
        found.error(error::unreadable_file, place, fmt::format("there is no file {}.", *file),
                    "correct its name, which is relative to the manifest.");
      }
    }
  }
  return unit;
}

}  // namespace

std::vector<Unit> read_manifest(const std::string& path, Command otherwise) {
  const std::string text = read_text_file(path);
  std::string_view rest = text;
  if (rest.starts_with(byte_order_mark)) {
    rest.remove_prefix(byte_order_mark.size());
  }
  Diagnostics found;
  std::vector<Unit> units;
  std::vector<const Column*> header;
  for (Place place{.file = path, .line = 1}; !rest.empty(); ++place.line) {
    const auto end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    line.remove_suffix(line.ends_with('\r') ? 1 : 0);
    if (trimmed(line).empty() || line.starts_with('#')) {
      continue;
    }
    const auto cells = cells_of(line);
    if (!cells || (!header.empty() && cells->size() != header.size())) {
      found.error(error::ragged_row, place,
                  !cells ? std::string("a quotation mark has no counterpart in its line.")
                         : fmt::format("the line has {} cells, the header {}.", cells->size(), header.size()),
                  "correct the line; a cell with a comma stands in quotation marks.");
      if (header.empty()) {
        break;
      }
    } else if (header.empty()) {
      header = header_of(*cells, otherwise, place, found);
      if (found.has_errors()) {
        break;  // what the lines mean is not known
      }
    } else {
      units.push_back(unit_of(*cells, header, otherwise, place, found));
    }
  }
  if (!found.has_errors() && units.empty()) {
    found.error(header.empty() ? error::missing_header : error::bad_usage, {.file = path},
                header.empty() ? "the manifest has no header." : "the manifest has no record.",
                header.empty() ? "begin with a line that names the columns: machine,diagram,params,log,when."
                               : "add a line for each record of a machine.");
  }
  if (found.has_errors()) {
    throw InputError(found);
  }
  return units;
}

}  // namespace hysteron::fleet
