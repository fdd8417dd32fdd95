// A compiled diagram behind its handle.
#pragma once

#include <memory>
#include <string>

#include "bindings/c/hysteron.h"
#include "bindings/c/messages.hpp"
#include "bindings/c/options.hpp"
#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "tuning/record_options.hpp"

struct hysteron_diagram {
  std::shared_ptr<const hysteron::Program> compiled;  ///< as its text says, for fits, which set the values themselves
  hysteron::Program program;                          ///< with its parameters set
  hysteron::parameters::ParameterFile file;           ///< of parameters; empty where there is none
  hysteron::Diagnostics warnings;                     ///< of the compiler
  std::string json;
};

namespace hysteron::bindings {

/// What is known of a diagram, for programs.
[[nodiscard]] std::string diagram_json(const Program& program);

/// How records are to be read, as options say and then the diagram's parameter file; the diagram may be null.
[[nodiscard]] records::ReadOptions read_options_of(Options& options, const hysteron_diagram* diagram);

}  // namespace hysteron::bindings
