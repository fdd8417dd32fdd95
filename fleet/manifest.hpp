// The manifest of a fleet: a line for each record of a machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fleet/command.hpp"
#include "support/numbers.hpp"

namespace hysteron::fleet {

/// One record of one machine, and what is done with it: a unit of work.
struct Unit {
  std::string machine{};
  std::string when{};          ///< of the record, as the manifest has it; empty where it has none
  double time = not_a_number;  ///< the same in seconds since 1970; not a number where it has none
  std::string group{};         ///< of machines of one kind; empty where it has none
  Command command = Command::Diagnose;
  std::string diagram{};
  std::string parameters{};
  std::string log{};
  std::uint32_t line = 0;  ///< of the manifest, from 1
};

/// Reads a manifest: CSV with the columns machine, diagram, params and log, and if wanted when, group and command, in
/// any order. A cell with a comma or a quotation mark stands in quotation marks (RFC 4180), within its line. Empty
/// lines and lines that begin with # are skipped. Names of files are relative to the manifest. `otherwise` is the
/// command of a line that names none. A check needs no params and no log, and `tune` no log: parameters with a [goal]
/// may have a signal of their own.
///
/// A diagram or parameter file that is not there is an error of the manifest. A record that is not there is none: it
/// fails alone. Throws InputError with all errors: HY100, HY502 a column that is missing, HY503 one that is there
/// twice, HY504 a line with other cells than the header, HY509 no header, HY730 an empty cell, an unknown command or no
/// unit, HY733 an unknown column, HY734 a time that is none.
[[nodiscard]] std::vector<Unit> read_manifest(const std::string& path, Command otherwise = Command::Diagnose);

}  // namespace hysteron::fleet
