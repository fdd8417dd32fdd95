// The result of a unit: a folder that is there whole or not at all, named by what it was made of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
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

/// The names of the files that a diagram or a parameter file names and the result depends on: FMUs, the plants of a
/// goal.
using NamedFiles = std::function<std::vector<std::string>(const std::string& file)>;

struct NamingFiles {
  NamedFiles by_diagram{};
  NamedFiles by_parameters{};
};

/// Keys of units. A file that several units name is read once.
class Keys {
 public:
  /// `options` are those of `diagnose`. Without `named`, no file names others.
  Keys(std::string version, std::vector<std::string> options, NamingFiles named = {})
      : version_(std::move(version)), options_(std::move(options)), named_(std::move(named)) {}

  /// 64 hexadecimal digits: of the version, the command and its options, the machine and its time, and the bytes of
  /// diagram and parameters, of the files that they name, and of the record. A record or a named file that cannot be
  /// read counts by its name, until it can be.
  [[nodiscard]] std::string of(const Unit& unit);

 private:
  const std::string& digest(const std::string& file);
  /// With the files that it names.
  const std::string& digest_of_all(const std::string& file, const NamedFiles& named);

  std::string version_;
  std::vector<std::string> options_;
  NamingFiles named_;
  std::map<std::string, std::string> digests_;
  std::map<std::string, std::string> with_named_;
};

/// Where the result of a key lies.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& output, const std::string& key);

/// As `result.json` within the folder of a unit. Throws InputError HY700.
void write_result(const std::filesystem::path& folder, const Unit& unit, std::string_view version,
                  const Result& result);

/// What lies there; `Open` where nothing does, or what does is no result.
[[nodiscard]] Result read_result(const std::filesystem::path& folder);

}  // namespace hysteron::fleet
