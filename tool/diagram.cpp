#include "tool/diagram.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <utility>
#include <vector>

#include "codegen/cosimulation/fmu.hpp"
#include "codegen/parameters/apply.hpp"
#include "support/errors.hpp"
#include "tool/option_values.hpp"

namespace hysteron::tool {
namespace {

/// Of a parameter file for a diagram: the first parameters of one block, or of the diagram itself, that a fit may move.
/// Empty where there is none.
std::vector<Note> first_lines(const Graph& graph) {
  constexpr std::size_t most = 2;
  const auto block_of = [](const Parameter& one) {
    const auto dot = one.path.rfind('.');
    return one.path.substr(0, dot == std::string::npos ? 0 : dot);
  };
  std::vector<const Parameter*> fitted;
  for (const Parameter& one : graph.parameters) {
    const bool is_number = one.field.type == Type::Real && one.field.length == 1;
    if (is_number && one.field.effect.empty() && one.field.role != FieldRole::StartValue && fitted.size() < most &&
        (fitted.empty() || block_of(*fitted.front()) == block_of(one))) {
      fitted.push_back(&one);
    }
  }
  std::vector<Note> lines;
  for (const Parameter* const one : fitted) {
    const std::string block = block_of(*one);
    if (lines.empty()) {
      lines.push_back({.text = block.empty() ? "[fit]" : fmt::format("[fit.{}]", block)});
    }
    lines.push_back({.text = fmt::format("{} = {{}}", one->path.substr(block.empty() ? 0 : block.size() + 1))});
  }
  return lines;
}

}  // namespace

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

void require_parameters(const DiagramOptions& options, std::string_view command, std::string_view advice) {
  if (!options.parameters.empty()) {
    return;
  }
  Diagnostics ignored;  // told when the command runs
  const Program program = compile_file(options.file, {.top = options.top, .any_order = options.any_order}, ignored);
  std::vector<Note> lines = first_lines(program.graph);
  const std::string file = std::filesystem::path(options.file).stem().string() + ".toml";
  std::string mend =
      lines.empty()
          ? std::string("first give the diagram a parameter that a fit can move, as K of a HY_GAIN: it has none.")
          : fmt::format("{} For this diagram {} may begin with these lines:", advice, file);
  Diagnostics missing;
  missing.error(
      error::bad_usage, {},
      fmt::format("hysteron {}: --params is missing, the file that names the parameters to be fitted.", command),
      std::move(mend), std::move(lines));
  throw InputError(std::move(missing));
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
