#include "codegen/backends/plcopen/library_block.hpp"

#include <fmt/format.h>

#include <cmath>

#include "codegen/graph/names.hpp"

namespace hysteron::plcopen {
namespace {

/// The instance of the block; no pin has such a name.
constexpr std::string_view core = "CORE";

std::string declaration(const Field& field, bool with_value) {
  const bool has_value = with_value && !field.required && std::isfinite(field.preset);
  return fmt::format("    {} : {}{};\n", field.name, type_name(field.type),
                     has_value ? " := " + literal_text(field.type, field.preset) : "");
}

}  // namespace

StPou library_pou(const BlockType& block, std::int64_t sample_time_ns, const StOptions& options) {
  std::string inputs;
  std::string arguments;
  for (const Field& field : block.inputs) {
    inputs += declaration(field, true);
    arguments += fmt::format("{}{} := {}", arguments.empty() ? "" : ", ", field.name, field.name);
  }
  std::string outputs;
  std::string results;
  for (const Field& field : block.outputs) {
    outputs += declaration(field, false);
    results += fmt::format("  {} := {}.{};\n", field.name, core, field.name);
  }
  const std::string text = fmt::format(
      "FUNCTION_BLOCK LIBRARY  (* @ts {}ns *)\n{}  VAR_OUTPUT\n{}  END_VAR\n  VAR\n    {} : {};\n  END_VAR\n\n"
      "  {}({});\n{}END_FUNCTION_BLOCK\n",
      sample_time_ns, inputs.empty() ? "" : fmt::format("  VAR_INPUT\n{}  END_VAR\n", inputs), outputs, core,
      block.about.name, core, arguments, results);
  Program program = compile_text(text, {.any_order = true});
  program.graph.name = block.about.name;
  for (Port& port : program.graph.inputs) {
    for (const Field& field : block.inputs) {
      if (field.name == port.name) {
        port.meaning = field.meaning;
        port.unit = field.unit.find('\'') == std::string_view::npos ? field.unit : "";
      }
    }
  }
  for (Port& port : program.graph.outputs) {
    for (const Field& field : block.outputs) {
      if (field.name == port.name) {
        port.meaning = field.meaning;
        port.unit = field.unit.find('\'') == std::string_view::npos ? field.unit : "";
      }
    }
  }
  for (Parameter& parameter : program.graph.parameters) {
    parameter.path.erase(0, core.size() + 1);
  }
  return make_st_pou(program, options).block;
}

}  // namespace hysteron::plcopen
