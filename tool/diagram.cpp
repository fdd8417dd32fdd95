#include "tool/diagram.hpp"

#include <CLI/CLI.hpp>
#include <utility>

#include "codegen/cosimulation/fmu.hpp"
#include "codegen/parameters/apply.hpp"
#include "support/errors.hpp"
#include "tool/option_values.hpp"

namespace hysteron::tool {

void add_diagram_options(CLI::App& options, DiagramOptions& diagram) {
  options.add_option("FILE", diagram.file, "The diagram, a file in Structured Text.")->required()->option_text(" ");
  options.add_option("--params", diagram.parameters, "Parameters, over those that the diagram gives.")
      ->option_text("P.toml");
  options.add_option("--top", diagram.top, "The block to take, where the file has several that no other contains.")
      ->option_text("NAME");
  options.add_flag("--float32", diagram.float32, "LREAL is a 32-bit float, as on a target without a double.");
  options.add_flag("--any-order", diagram.any_order,
                   "The order of the statements means nothing: HY402 becomes a warning.");
}

void add_fmu_options(CLI::App& options) {
  options
      .add_option_function<double>("--fmu-time-limit", cosimulation::set_time_limit,
                                   "The most seconds that one call of an FMU may take; 30 by default.")
      ->check(number_above_zero())
      ->option_text("SECONDS");
}

Program load_diagram(const DiagramOptions& options, Diagnostics& warnings) {
  Program program = compile_file(
      options.file, {.top = options.top, .any_order = options.any_order, .keep_names = options.keep_names}, warnings);
  set_parameters_of(options.parameters, program);
  return program;
}

void set_parameters_of(const std::string& file, Program& program) {
  if (!file.empty()) {
    parameters::apply(parameters::read_parameter_file(file), program.graph);
  }
}

std::vector<InputFile> inputs_of(const DiagramOptions& options) {
  return {{.file = options.file}, {.file = options.parameters, .named_by = "--params"}};
}

}  // namespace hysteron::tool
