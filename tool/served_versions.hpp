// The versions of a diagram that `hysteron serve` runs one after the other: their files, and what is asked of them.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/program_hash.hpp"
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
  bool is_steady = false;  ///< none of them was written meanwhile
};

/// Throws InputError as load_diagram; HY853 where files are written again and again while they are read.
[[nodiscard]] LoadedVersion load_version(const DiagramOptions& options, Diagnostics& warnings);

/// The same at the start of a task, which nothing that passes may end: where files are written all the time, the
/// version that was read last counts, and a line says so.
[[nodiscard]] LoadedVersion first_version(const DiagramOptions& options, Diagnostics& warnings);

/// What the task was started with beside its diagram.
struct StartFiles {
  std::string run_file{};
  std::string text{};               ///< of the run file, as it counts
  std::vector<InputFile> inputs{};  ///< that nothing may be written over
};

class ServedVersions {
 public:
  /// What is being done that takes long, as the end of a sentence that begins with "the task".
  using Progress = std::function<void(std::string_view)>;

  /// `shows_inner`: programs are made with their inner signals and their picture, for the live page.
  ServedVersions(DiagramOptions options, Engine engine, bool shows_inner, StartFiles start, const LoadedVersion& first)
      : options_(std::move(options)),
        engine_(engine),
        shows_inner_(shows_inner),
        start_(std::move(start)),
        running_(first.files),
        running_hash_(program_hash(first.diagram)) {}

  /// A request as `hysteron online-change` makes it, one line of JSON: `what` is check, change, check-back, back or
  /// files; `bumps`, `as_given` and `load` as ChangeWish has them. The answer: `report` or `files`, and `warnings`; or
  /// `errors`.
  [[nodiscard]] std::string answer(runtime::OnlineChange& change, const std::string& request, const Progress& progress);

 private:
  struct NextVersion {
    std::unique_ptr<runtime::StepProgram> program{};
    std::vector<OutputFile> files{};
    std::string hash{};
  };
  /// Without a program where the files are those of the version that runs, and nothing else is wished.
  [[nodiscard]] NextVersion next_version(const runtime::OnlineChange& change, const runtime::ChangeWish& wish,
                                         Diagnostics& warnings, const Progress& progress) const;
  [[nodiscard]] bool is_asked_for_nothing(const LoadedVersion& loaded, const runtime::ChangeWish& wish) const;
  /// Throws InputError where a start with the run file as it stands now, and with this version, would be refused.
  void require_next_start(const runtime::StepProgram& program) const;
  [[nodiscard]] bool is_run_file_edited() const;

  DiagramOptions options_;
  Engine engine_;
  bool shows_inner_;
  StartFiles start_;
  std::vector<OutputFile> running_;   ///< files of the version that runs
  std::vector<OutputFile> former_{};  ///< of the one before; empty where there is none
  std::string running_hash_;          ///< of the diagram, in which an FMU counts that the files only name
  std::string former_hash_{};
};

}  // namespace hysteron::tool
