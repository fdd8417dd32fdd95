// A diagram as commands take it: the file, its top block, and the parameters set from a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codegen/compile.hpp"
#include "support/diagnostic.hpp"
#include "support/overwriting.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library is so named
class App;
}

namespace hysteron::tool {

struct DiagramOptions {
  std::string file{};
  std::string top{};
  std::string parameters{};
  bool any_order = false;
  bool float32 = false;
  bool keep_names = false;  ///< see CompileOptions
};

/// The options --top, --params, --any-order and --float32, and the file itself. The structure must outlive the parse.
void add_diagram_options(CLI::App& options, DiagramOptions& diagram);

/// The option --fmu-time-limit, of commands that may meet an FMU.
void add_fmu_options(CLI::App& options);

/// Compiles the diagram and sets its parameters. Throws InputError with all errors; adds warnings.
[[nodiscard]] Program load_diagram(const DiagramOptions& options, Diagnostics& warnings);

/// Refuses a command without --params: what such a file is, and its first lines for this very diagram. `advice` says
/// what to do with it. Throws InputError.
void require_parameters(const DiagramOptions& options, std::string_view command, std::string_view advice);

/// Sets the parameters of a file; without a name nothing is set. Throws InputError.
void set_parameters_of(const std::string& file, Program& program);

/// What a diagram is read from, for refuse_to_overwrite.
[[nodiscard]] std::vector<InputFile> inputs_of(const DiagramOptions& options);

}  // namespace hysteron::tool
