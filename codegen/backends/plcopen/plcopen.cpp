#include "codegen/backends/plcopen/plcopen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/backends/plcopen/known_values.hpp"
#include "codegen/backends/plcopen/network.hpp"
#include "codegen/backends/plcopen/placing.hpp"
#include "codegen/backends/plcopen/project_xml.hpp"
#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/st/library_block.hpp"
#include "codegen/backends/st/pou.hpp"
#include "codegen/graph/definition.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

using plcopen::Flavour;
using plcopen::Pou;

/// A comment without its marks.
std::string words_of(std::string comment) {
  const auto erase = [&](std::string_view mark, std::size_t at) {
    if (at != std::string::npos) {
      comment.erase(at, mark.size());
    }
  };
  erase("*)", comment.rfind("*)"));
  erase("(* ", comment.find("(* "));
  while (comment.ends_with('\n') || comment.ends_with(' ')) {
    comment.pop_back();
  }
  return comment;
}

Pou with_text(StPou made, bool is_program = false) {
  return {.name = std::move(made.name),
          .is_program = is_program,
          .documentation = words_of(std::move(made.head)),
          .sections = std::move(made.sections),
          .body = std::move(made.body)};
}

std::string annotations_of(const language::FunctionBlock& block) {
  std::string text;
  for (const auto& one : block.annotations) {
    text += fmt::format("{}@{} {}", text.empty() ? "" : " ", one.key, one.value);
  }
  return text;
}

/// A program that hands its own variables to one instance.
Pou caller_of(const plcopen::Network& network) {
  Pou caller{.name = network.name + "_PROGRAM", .is_program = true};
  const std::string instance = network.name + "_1";
  StSection own{.keyword = "VAR", .variables = {{.name = instance, .type = network.name}}};
  std::string arguments;
  std::string results;
  for (const StSection& section : network.sections) {
    for (const StVariable& one : section.variables) {
      if (section.keyword == "VAR_INPUT") {
        arguments += fmt::format("{}{} := {}", arguments.empty() ? "" : ", ", one.name, one.name);
      } else if (section.keyword == "VAR_OUTPUT") {
        results += fmt::format("  {} := {}.{};\n", one.name, instance, one.name);
      } else {
        continue;
      }
      own.variables.push_back(one);
    }
  }
  caller.sections.push_back(std::move(own));
  caller.body = fmt::format("  {}({});\n{}", instance, arguments, results);
  return caller;
}

/// A wire of a network carries one value: a vector is its elements there, X_0 of X[0]. A block whose pins are vectors
/// has none of the library to stand for it. Steps of a sequential body are no wires at all.
void refuse_what_is_no_wire(const Program& program) {
  Diagnostics diagnostics;
  Diagnostics ignored;
  const Definitions definitions = define(program.graph.source, ignored);
  const plcopen::KnownValues values(program, definitions);
  for (const std::uint32_t index : definitions.callees_first) {
    const Definition& definition = definitions.list[index];
    if (!values.is_used(index)) {
      continue;
    }
    const language::Name& name = definition.block->name;
    if (definition.block->sequential) {
      diagnostics.error(error::no_network, definitions.source->place(name.span),
                        fmt::format("'{}' has a sequential body, and a network has wires alone", name.text),
                        "Generate with --body st.");
      continue;
    }
    const auto found = std::ranges::find_if(
        definition.variables, [](const Declared& one) { return one.block != nullptr && one.block->sized != nullptr; });
    if (found != definition.variables.end()) {
      diagnostics.error(
          error::no_network, definitions.source->place(found->variable->name.span),
          fmt::format("'{}' has a block that takes its sizes from lists, {}", name.text, found->variable->name.text),
          "Generate with --body st: a wire of a network carries one value.");
    }
  }
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
}

void add_networks(const Program& program, const PlcopenOptions& options, const StOptions& text,
                  plcopen::Project& project) {
  refuse_what_is_no_wire(program);
  plcopen::Networks made =
      plcopen::make_networks(program, {.float32 = options.float32, .small_literals = text.dialect.small_literals});
  plcopen::take_places(options.place(plcopen::placing_dot(made.list)), made.list);
  for (const auto& used : made.library) {
    StOptions own = text;
    own.outputs_ahead = used.ahead;
    project.pous.push_back(with_text(library_pou(*used.block, program.graph.sample_time_ns, own)));
  }
  const Pou caller = caller_of(made.list.back());
  for (plcopen::Network& network : made.list) {
    std::string documentation;
    for (const auto& block : program.graph.source->blocks) {
      if (language::same_name(block.name.text, network.name)) {
        documentation = annotations_of(block);
      }
    }
    project.pous.push_back({.name = network.name,
                            .documentation = std::move(documentation),
                            .sections = std::move(network.sections),
                            .body = std::move(network.elements)});
  }
  project.pous.push_back(caller);
}

}  // namespace

bool is_plcopen_dialect(std::string_view name) {
  return plcopen::find_flavour(name) != nullptr;
}

std::string plcopen_dialect_names() {
  return plcopen::flavour_names();
}

std::vector<GeneratedFile> generate_plcopen(const Program& program, const PlcopenOptions& options) {
  require_generable(program.graph);
  const Flavour& flavour = *plcopen::find_flavour(options.dialect);
  const StDialect dialect = *st_dialect(flavour.st_dialect);
  const StOptions text{.dialect = dialect, .float32 = options.float32};
  plcopen::Project project{.name = program.graph.name, .cycle_ns = program.graph.sample_time_ns};
  if (options.body == PlcopenBody::Network) {
    add_networks(program, options, text, project);
  } else {
    StBlockAndCaller made = make_st_pou(program, text);
    project.pous.push_back(with_text(std::move(made.block)));
    project.pous.push_back(with_text(std::move(made.caller), true));
  }
  if (flavour.runs) {
    project.program = project.pous.back().name;
  } else {
    project.pous.pop_back();
  }
  const std::string file = flavour.file.empty() ? identifier_text({program.graph.name}, LetterCase::Lower) + ".xml"
                                                : std::string(flavour.file);
  return {{file, plcopen::project_xml(project, flavour)}};
}

}  // namespace hysteron
