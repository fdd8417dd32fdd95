// An FMU for co-simulation, read from its file: what it says of itself, and its files unpacked where they are needed.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "codegen/cosimulation/description.hpp"
#include "support/temporary_folder.hpp"

namespace hysteron::cosimulation {

/// How long one call of an FMU may take, in seconds, before its process is ended. For the whole process.
void set_time_limit(double seconds);
[[nodiscard]] double time_limit();

/// The program that opens the binaries of FMUs. By itself it is found beside the running program or in ../libexec.
void set_worker_program(std::filesystem::path program);
[[nodiscard]] std::filesystem::path worker_program();

class Fmu {
 public:
  /// Reads a file, once in the life of the process while the file stays as it is. Throws InputError HY219.
  static const Fmu& open(const std::string& path);

  explicit Fmu(const std::string& path);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const Description& description() const { return description_; }
  /// SHA-256 of the file.
  [[nodiscard]] const std::string& hash() const { return hash_; }

  struct Files {
    std::string library{};    ///< the binary for this machine
    std::string resources{};  ///< folder of the FMU's own files
  };
  /// Unpacks binary and resources into a folder that is removed at the end of the process. Throws InputError HY219, or
  /// HY750 where there is no binary for this machine.
  [[nodiscard]] const Files& files() const;

  /// What was done with it so far.
  struct Counts {
    std::atomic<std::uint64_t> instances{0};
    std::atomic<std::uint64_t> steps{0};  ///< of all instances
  };
  [[nodiscard]] Counts& counts() const { return counts_; }

 private:
  [[noreturn]] void refuse(const std::string& reason) const;
  void refuse_without_binary(const class Archive& archive, const std::string& wanted) const;

  std::string path_;
  std::string hash_{};
  Description description_{};
  mutable std::mutex unpacking_{};
  mutable std::optional<TemporaryFolder> folder_{};
  mutable std::optional<Files> files_{};
  mutable Counts counts_{};
};

}  // namespace hysteron::cosimulation
