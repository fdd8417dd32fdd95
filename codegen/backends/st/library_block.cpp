#include "codegen/backends/st/library_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "codegen/backends/st/comment.hpp"
#include "codegen/graph/lowering.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/graph/text_order.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/trace/sized_block.hpp"

namespace hysteron {
namespace {

/// The instance of the block; no pin has such a name.
constexpr std::string_view core = "CORE";

constexpr std::size_t head_width = 116;

std::string declaration(const Field& field, bool with_value) {
  const bool has_value = with_value && !field.required && std::isfinite(field.preset);
  return fmt::format("    {} : {}{};\n", field.name, type_name(field.type),
                     has_value ? " := " + literal_text(field.type, field.preset) : "");
}

/// The name of its POU: of a block with sizes, with these behind it.
std::string name_of(const BlockType& block) {
  if (block.sized == nullptr) {
    return std::string(block.about.name);
  }
  const Sizes& z = block.sized->sizes;
  return fmt::format("{}{}_{}_{}{}", block.about.name, z.n > 0 ? fmt::format("_{}", z.n) : "", z.m, z.p,
                     z.direct ? "_D" : "");
}

/// The same for a block whose pins are elements of vectors, which a text names by their vectors.
Program wrapper_of_sized(const BlockType& block, std::int64_t sample_time_ns) {
  Program program;
  Graph& graph = program.graph;
  graph.name = name_of(block);
  graph.source = std::make_shared<const language::SourceFile>();
  graph.sample_time_ns = sample_time_ns;
  GraphBuilder builder(graph);
  const std::uint32_t node = builder.block(block, std::string(core), {}, {});
  for (std::uint32_t i = 0; i < block.pin_count(); ++i) {
    const Field& field = block.pin(i);
    Wire& wire = graph.wires[graph.nodes[node].first_wire + i];
    if (i < block.inputs.size()) {
      graph.inputs.push_back({.name = std::string(field.name), .type = field.type, .preset = field.preset});
      wire = {Wire::From::Input, field.type, 0, i};
    } else {
      graph.parameters.push_back({.path = fmt::format("{}.{}", core, field.name),
                                  .field = field,
                                  .value = std::vector<double>(field.length, field.preset)});
      wire = {Wire::From::Parameter, field.type, 0, static_cast<std::uint32_t>(graph.parameters.size() - 1)};
    }
  }
  const auto outputs = static_cast<std::uint16_t>(block.outputs.size());
  for (std::uint16_t i = 0; i < outputs; ++i) {
    graph.outputs.push_back({.name = std::string(block.outputs[i].name),
                             .type = block.outputs[i].type,
                             .wire = {Wire::From::Node, block.outputs[i].type, i, node}});
  }
  Diagnostics none;
  program.schedule = schedule(graph, none);
  return program;
}

/// A diagram that hands its inputs to one instance.
Program wrapper_of(const BlockType& block, std::int64_t sample_time_ns) {
  if (block.sized != nullptr) {
    return wrapper_of_sized(block, sample_time_ns);
  }
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
  return compile_text(text, {.any_order = true});
}

void take_description(std::vector<Port>& ports, std::span<const Field> fields) {
  for (std::size_t i = 0; i < ports.size(); ++i) {
    ports[i].meaning = fields[i].meaning;
    ports[i].unit = fields[i].unit.find('\'') == std::string_view::npos ? fields[i].unit : "";
  }
}

// --- the head ---

void append_paragraph(std::string& text, std::string_view words) {
  std::size_t width = 0;
  while (!words.empty()) {
    const std::string_view word = words.substr(0, words.find(' '));
    words.remove_prefix(std::min(words.size(), word.size() + 1));
    if (width == 0 || width + word.size() >= head_width) {
      text += width == 0 ? "   " : "\n   ";
      width = 3;
    } else {
      text += ' ';
      ++width;
    }
    text += word;
    width += word.size();
  }
  text += '\n';
}

std::string names_of(const BlockType& block, const std::vector<bool>& outputs) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i]) {
      names.push_back(block.outputs[i].name);
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string head_of(const BlockType& block, const std::vector<bool>& ahead, std::string_view name) {
  std::string text = fmt::format("(* {}: {}; generated by Hysteron.\n\n", name, block.about.title);
  append_paragraph(text, st_comment(block.about.equation));
  append_paragraph(text, st_comment(block.about.meaning));
  if (const std::string memory = names_of(block, ahead); !memory.empty()) {
    append_paragraph(text,
                     fmt::format("Memory: {}. Read it before the call, which moves it on to the next step.", memory));
  }
  const std::vector<bool> plain = outputs_of_memory(block, true);
  const std::vector<bool> now = outputs_of_memory(block, false);
  if (ahead == plain && plain != now) {
    append_paragraph(text, fmt::format("Where a pin that decides {} in the step is connected, use {}_NOW, and read it "
                                       "behind the call.",
                                       names_of(block, plain), name_of(block)));
  } else if (ahead != plain) {
    append_paragraph(text, fmt::format("As {}, with pins connected that decide outputs in the step.", name_of(block)));
  }
  return text + "*)\n";
}

/// What outputs of memory are before the first call, where the parameters are those that the block has by itself.
std::vector<double> first_values(const Program& program) {
  Machine<double> machine(program);
  machine.step();
  std::vector<double> values;
  for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
    values.push_back(machine.output(i));
  }
  return values;
}

}  // namespace

StPou library_pou(const BlockType& block, std::int64_t sample_time_ns, const StOptions& options) {
  Program program = wrapper_of(block, sample_time_ns);
  const std::vector<double> first = options.library ? first_values(program) : std::vector<double>();
  program.graph.name = name_of(block);
  take_description(program.graph.inputs, block.inputs);
  take_description(program.graph.outputs, block.outputs);
  for (Parameter& parameter : program.graph.parameters) {
    parameter.path.erase(0, core.size() + 1);
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    const bool ahead = i < options.outputs_ahead.size() && options.outputs_ahead[i];
    program.graph.outputs[i].preset = ahead ? first[i] : 0.0;
  }
  if (options.library) {
    for (Node& node : program.graph.nodes) {
      node.path.clear();
    }
  }
  StOptions own = options;
  own.keeps_pins = true;
  return make_st_pou(program, own).block;
}

std::vector<bool> outputs_of_memory(const BlockType& block, bool open_pins) {
  std::vector<bool> memory;
  for (std::size_t output = 0; output < block.outputs.size(); ++output) {
    bool decided = false;
    for (std::size_t pin = 0; pin < block.inputs.size(); ++pin) {
      decided =
          decided || (block.trace.feedthrough[output].contains(pin) && (!open_pins || block.inputs[pin].required));
    }
    memory.push_back(!decided && has_memory(block.trace, output));
  }
  return memory;
}

LibraryText::LibraryText(std::int64_t sample_time_ns, StOptions options)
    : sample_time_ns_(sample_time_ns), options_(std::move(options)) {
  options_.library = true;
  options_.calls = nullptr;
}

const LibraryBlock& LibraryText::block(const BlockType& type, const std::vector<bool>& ahead) {
  std::size_t others = 1;
  for (const LibraryBlock& one : blocks_) {
    if (one.block == &type && one.ahead == ahead) {
      return one;
    }
    others += one.block == &type ? 1 : 0;
  }
  LibraryBlock made{.block = &type, .ahead = ahead, .name = name_of(type)};
  if (ahead != outputs_of_memory(type, true)) {
    made.name += ahead == outputs_of_memory(type, false) ? "_NOW" : fmt::format("_NOW_{}", others);
  }
  options_.outputs_ahead = ahead;
  made.pou = library_pou(type, sample_time_ns_, options_);
  made.pou.name = made.name;
  made.pou.head = head_of(type, ahead, made.name);
  for (const StSection& section : made.pou.sections) {
    for (const StVariable& one : section.variables) {
      made.sample_time = made.sample_time || (section.keyword == "VAR_INPUT" && one.name == "TS");
    }
  }
  blocks_.push_back(std::move(made));
  return blocks_.back();
}

std::vector<const LibraryBlock*> LibraryText::list() const {
  std::vector<const LibraryBlock*> sorted;
  for (const LibraryBlock& one : blocks_) {
    sorted.push_back(&one);
  }
  std::ranges::sort(sorted, {}, &LibraryBlock::name);
  return sorted;
}

}  // namespace hysteron
