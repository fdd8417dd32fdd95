#include "codegen/backends/reference/block_response.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "codegen/backends/reference/block_stimuli.hpp"
#include "codegen/compile.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/element_name.hpp"

namespace hysteron {
namespace {

/// `@every` of the slower part, where the block is a border between two rates.
constexpr int slow_every = 10;

std::string short_name(const BlockType& block) {
  return std::string(block.about.name.substr(std::string_view("HY_").size()));
}

std::vector<const Field*> shown_outputs(const BlockType& block, const Stimulus& stimulus) {
  std::vector<const Field*> list;
  for (const Field& output : block.outputs) {
    const bool is_error = output.name == "ERROR" || output.name == "ERRORID";
    const bool chosen = std::ranges::find(stimulus.shown, output.name) != stimulus.shown.end();
    if (stimulus.shown.empty() ? !is_error : chosen) {
      list.push_back(&output);
    }
  }
  return list;
}

std::string duration_text(double seconds) {
  return fmt::format("{:g}ms", seconds * 1e3);
}

std::string declarations(std::string_view section, const std::vector<std::string>& lines) {
  return lines.empty() ? std::string() : fmt::format("{}\n{}\nEND_VAR\n", section, fmt::join(lines, "\n"));
}

/// The instances and calls: the block itself, and at a border between rates the way there and back.
std::string body(const BlockType& block, const Stimulus& stimulus) {
  if (block.about.rate_transition) {
    return fmt::format(
        "VAR\nTO_SLOW : HY_SAMPLE; (* @every {} *)\nTO_FAST : HY_HOLD;\nEND_VAR\n"
        "TO_SLOW(XIN := {});\nTO_FAST(XIN := TO_SLOW.XOUT);\nXOUT := TO_FAST.XOUT;\n",
        slow_every, stimulus.pins.front().pin);
  }
  std::vector<std::string> arguments;
  for (const DrivenPin& driven : stimulus.pins) {
    arguments.push_back(fmt::format("{} := {}", driven.pin, driven.pin));
  }
  const std::string settings = stimulus.settings.empty() ? std::string() : fmt::format(" := ({})", stimulus.settings);
  std::string text =
      fmt::format("VAR\nBLOCK : {}{};\nEND_VAR\nBLOCK({});\n", block.about.name, settings, fmt::join(arguments, ", "));
  for (const Field* const output : shown_outputs(block, stimulus)) {
    text += fmt::format("{} := BLOCK.{};\n", output->name, output->name);
  }
  return text;
}

const Field& input_of(const BlockType& block, std::string_view name) {
  const auto found = std::ranges::find_if(block.inputs, [&](const Field& input) { return input.name == name; });
  if (found == block.inputs.end()) {
    throw std::invalid_argument(fmt::format("{} has no input {}", block.about.name, name));
  }
  return *found;
}

/// The ports of a diagram for pins, those that are elements of a vector as that vector.
std::vector<std::string> ports_of(std::span<const Field> fields) {
  std::vector<std::string> ports;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto element = element_of(fields[i].name);
    if (!element) {
      ports.push_back(fmt::format("{} : {};", fields[i].name, type_name(fields[i].type)));
      continue;
    }
    const auto of_next = i + 1 < fields.size() ? element_of(fields[i + 1].name) : std::nullopt;
    if (!of_next || of_next->vector != element->vector) {
      ports.push_back(
          fmt::format("{} : ARRAY[0..{}] OF {};", element->vector, element->index, type_name(fields[i].type)));
    }
  }
  return ports;
}

/// An instance of a block with sizes, with all of its pins.
std::string sized_diagram(const BlockType& block) {
  const std::vector<std::string> inputs = ports_of(block.inputs);
  const std::vector<std::string> outputs = ports_of(block.outputs);
  std::string arguments;
  std::string results;
  const auto name_of = [](const std::string& port) { return port.substr(0, port.find(' ')); };
  for (const std::string& port : inputs) {
    arguments += fmt::format("{0}{1} := {1}", arguments.empty() ? "" : ", ", name_of(port));
  }
  for (const std::string& port : outputs) {
    results += fmt::format("{0} := BLOCK.{0};\n", name_of(port));
  }
  return fmt::format(
      "FUNCTION_BLOCK SHOW_{} (* @ts 1ms *)\n{}{}VAR\nBLOCK : {} := ({});\nEND_VAR\nBLOCK({});\n{}END_FUNCTION_BLOCK\n",
      short_name(block), declarations("VAR_INPUT", inputs), declarations("VAR_OUTPUT", outputs), block.about.name,
      block.sized->kind->example, arguments, results);
}

/// In the house's layout.
std::string laid_out(const BlockType& block, const std::string& text) {
  Diagnostics diagnostics;
  std::string formatted = format_text(std::string(block.about.name), text, diagnostics, {.any_order = true});
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  return formatted;
}

}  // namespace

std::string response_diagram(const BlockType& block) {
  if (block.sized != nullptr) {
    return laid_out(block, sized_diagram(block));
  }
  const Stimulus stimulus = stimulus_of(block);
  std::vector<std::string> inputs;
  for (const DrivenPin& driven : stimulus.pins) {
    inputs.push_back(fmt::format("{} : {};", driven.pin, type_name(input_of(block, driven.pin).type)));
  }
  std::vector<std::string> outputs;
  for (const Field* const output : shown_outputs(block, stimulus)) {
    outputs.push_back(fmt::format("{} : {};", output->name, type_name(output->type)));
  }
  const std::string text =
      fmt::format("FUNCTION_BLOCK SHOW_{} (* @ts {} *)\n{}{}{}END_FUNCTION_BLOCK\n", short_name(block),
                  duration_text(stimulus.sample_time), declarations("VAR_INPUT", inputs),
                  declarations("VAR_OUTPUT", outputs), body(block, stimulus));
  return laid_out(block, text);
}

BlockResponse block_response(const BlockType& block) {
  const Stimulus stimulus = stimulus_of(block);
  Machine<double> machine(compile_text(response_diagram(block)));
  BlockResponse response{.sample_time = stimulus.sample_time, .abscissa = std::string(stimulus.abscissa)};
  for (const DrivenPin& driven : stimulus.pins) {
    response.traces.push_back(
        {.name = std::string(driven.pin), .type = input_of(block, driven.pin).type, .is_input = true});
  }
  for (const Field* const output : shown_outputs(block, stimulus)) {
    response.traces.push_back({.name = std::string(output->name), .type = output->type});
  }
  for (int step = 0; step < stimulus.steps; ++step) {
    for (std::size_t i = 0; i < stimulus.pins.size(); ++i) {
      const double value = stimulus.pins[i].wave.at(step, stimulus.steps, stimulus.sample_time);
      machine.set_input(i, value);
      response.traces[i].values.push_back(value);
    }
    machine.step();
    for (std::size_t i = stimulus.pins.size(); i < response.traces.size(); ++i) {
      response.traces[i].values.push_back(machine.output(i - stimulus.pins.size()));
    }
  }
  return response;
}

}  // namespace hysteron
