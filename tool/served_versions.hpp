// The versions of a diagram that `hysteron serve` runs one after the other: their files, and what is asked of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "runtime/host/online_change.hpp"
#include "runtime/task/changeable_program.hpp"
#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "tool/diagram.hpp"
#include "tool/program_shape.hpp"

namespace hysteron::tool {

/// A diagram and its parameters as they were read: by absolute names, since who asks may be in another folder.
struct LoadedVersion {
  Program diagram;
  std::vector<OutputFile> files{};
};

/// Throws InputError as load_diagram; HY853 where a file was written while it was read.
[[nodiscard]] LoadedVersion load_version(const DiagramOptions& options, Diagnostics& warnings);

class ServedVersions {
 public:
  /// `shows_inner`: programs are made with their inner signals, for the live page.
  ServedVersions(DiagramOptions options, Engine engine, bool shows_inner, std::vector<OutputFile> first)
      : options_(std::move(options)), engine_(engine), shows_inner_(shows_inner), running_(std::move(first)) {}

  /// A request as `hysteron online-change` makes it, one line of JSON: `what` is check, change, check-back, back or
  /// files; `bumps` and `as_given` as ChangeWish has them. The answer: `report` or `files`, and `warnings`; or
  /// `errors`.
  [[nodiscard]] std::string answer(runtime::OnlineChange& change, const std::string& request);

 private:
  struct NextVersion {
    std::unique_ptr<runtime::StepProgram> program{};
    std::vector<OutputFile> files{};
  };
  [[nodiscard]] NextVersion next_version(const runtime::OnlineChange& change, const runtime::ChangeWish& wish,
                                         Diagnostics& warnings) const;

  DiagramOptions options_;
  Engine engine_;
  bool shows_inner_;
  std::vector<OutputFile> running_;   ///< files of the version that runs
  std::vector<OutputFile> former_{};  ///< of the one before; empty where there is none
};

}  // namespace hysteron::tool
