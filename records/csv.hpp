// Records as CSV files.
//
//   t,u [V],y [um]
//   0.000,1.800000,-123.059139
//   0.005,1.856539,-120.154262
//
// What is read: one header row, then numbers, `t` in seconds in any column. Comma, semicolon or tab between columns;
// a decimal comma where the separator is another, or in quotes; LF or CRLF; a byte order mark; lines that begin with
// `#`; blank lines at the end; quoted cells; a unit in brackets behind a name. Everything else is refused with line,
// column, cause and mend: nothing is skipped, filled in or guessed.
#pragma once

#include <filesystem>
#include <string>

#include "records/record.hpp"

namespace hysteron::records {

/// Throws InputError: HY100 where the file cannot be read, HY501 to HY512 where it is no record.
[[nodiscard]] Record read_csv(const std::string& path);

/// The same from a text; `file` stands in the places of errors.
[[nodiscard]] Record parse_csv(const std::string& file, std::string text);

/// The record as CSV with commas, LF and the shortest numbers that read back to the same bits.
[[nodiscard]] std::string csv_text(const Record& record);

/// Writes it, whole or not at all. Throws InputError HY700.
void write_csv(const std::filesystem::path& path, const Record& record);

}  // namespace hysteron::records
