// Records as CSV files, as they are written here.
//
//   t,u [V],y [um]
//   0.000,1.800000,-123.059139
//   0.005,1.856539,-120.154262
#pragma once

#include <filesystem>
#include <string>

#include "records/record.hpp"

namespace hysteron::records {

/// The record as CSV with commas, LF and the shortest numbers that read back to the same bits.
[[nodiscard]] std::string csv_text(const Record& record);

/// Writes it, whole or not at all. Throws InputError HY700.
void write_csv(const std::filesystem::path& path, const Record& record);

}  // namespace hysteron::records
