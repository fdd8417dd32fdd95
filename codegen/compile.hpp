// From the text of a diagram to a program: the front door of codegen.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "codegen/graph/elaborate.hpp"
#include "codegen/graph/graph.hpp"
#include "codegen/graph/schedule.hpp"
#include "codegen/language/syntax.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// What the interpreter and the back-ends need of a diagram.
struct Program {
  Graph graph;
  Schedule schedule;
};

struct CompileOptions {
  std::string top{};                         ///< which FUNCTION_BLOCK; empty: the only one that no other contains
  bool any_order = false;                    ///< the order of statements means nothing: HY402 becomes a warning
  bool keep_names = false;                   ///< Graph::named is filled, which costs time and memory
  std::vector<NoisyOutput> noisy_outputs{};  ///< of the block that `top` names
  std::string path = "text";                 ///< of a text in memory: files that it names are seen from its folder
};

/// Checks every block of a file. All diagnostics, sorted by place, each once.
void check(std::shared_ptr<const language::SourceFile> source, Diagnostics& diagnostics);

/// Checks a file and compiles its top block. Sound only where no error was reported.
Program compile(std::shared_ptr<const language::SourceFile> source, const CompileOptions& options,
                Diagnostics& diagnostics);

/// Reads, checks and compiles a file. Throws InputError with all diagnostics where there is an error; warnings are
/// added to `warnings`.
Program compile_file(const std::string& path, const CompileOptions& options, Diagnostics& warnings);

/// The same for a text in memory.
Program compile_text(std::string text, const CompileOptions& options = {});

struct FormatOptions {
  bool any_order = false;  ///< the order of the statements means nothing: they are put into that of the data flow
};

/// The text in the house's layout. Diagnostics that keep it from being understood are added, and the text is given
/// back as it was. So are, as errors, the reads of HY402 and HY405: there the text means one thing here and another in
/// an IEC compiler, and no layout may choose. With `any_order` the statements are sorted, and what was moved is a
/// warning.
std::string format_text(std::string path, std::string text, Diagnostics& diagnostics,
                        const FormatOptions& options = {});

}  // namespace hysteron
