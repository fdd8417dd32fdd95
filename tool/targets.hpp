// The targets of `hysteron generate`: a row each.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"
#include "support/diagnostic.hpp"
#include "tool/calibration.hpp"

namespace hysteron::tool {

/// What is chosen besides the target; empty where nothing is.
struct TargetOptions {
  std::string target{};
  std::string dialect{};  ///< of st and plcopen
  std::string body{};     ///< of plcopen
  std::string fmi{};      ///< of fmu
  bool float32 = false;
  bool structured = false;           ///< of st: the blocks stay blocks
  CalibrationOptions calibration{};  ///< of c
};

struct Target {
  std::string_view name{};
  std::string_view language{};  ///< for the help
  std::vector<GeneratedFile> (*generate)(const Program& program, const TargetOptions& options,
                                         Diagnostics& warnings) = nullptr;
  bool has_float32 = true;  ///< whether it computes in 32 bits where it is asked to; all leaves one out that does not
};

[[nodiscard]] std::span<const Target> targets();

/// Without regard to case; null where there is none.
[[nodiscard]] const Target* find_target(std::string_view name);

/// The name of all of them at once.
inline constexpr std::string_view all_targets = "all";

/// Throws InputError HY730 where there is no such target, dialect, body or version, or the target has none.
void check_target_options(const TargetOptions& options);

}  // namespace hysteron::tool
