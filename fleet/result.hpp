// The result of a unit: a folder that is there whole or not at all, named by what it was made of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleet/manifest.hpp"

namespace hysteron::fleet {

enum class Status : std::uint8_t {
  Open,     ///< no result yet
  Done,     ///< a verdict
  Refused,  ///< the record cannot be diagnosed, verdict.json says why
  Failed    ///< the process ended otherwise: an error, a limit, a crash
};
[[nodiscard]] std::string_view name_of(Status status);

struct Result {
  Status status = Status::Open;
  int exit_code = 0;     ///< of the process; 128 and the number of the signal that killed it
  std::string reason{};  ///< why there is no verdict, in a line; empty where there is one
  double seconds = 0.0;  ///< that the process took
};

/// 64 hexadecimal digits: of the version, the options, the machine and its time, and the bytes of diagram, parameters
/// and record. A record that cannot be read counts by its name, until it can be.
[[nodiscard]] std::string key_of(const Unit& unit, std::string_view version, const std::vector<std::string>& options);

/// Where the result of a key lies.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& output, const std::string& key);

/// As `result.json` within the folder of a unit. Throws InputError HY700.
void write_result(const std::filesystem::path& folder, const Unit& unit, std::string_view version,
                  const Result& result);

/// What lies there; `Open` where nothing does, or what does is no result.
[[nodiscard]] Result read_result(const std::filesystem::path& folder);

}  // namespace hysteron::fleet
