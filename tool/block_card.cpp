#include "tool/block_card.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "codegen/backends/reference/block_page.hpp"
#include "codegen/cosimulation/fmu.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/graph/names.hpp"
#include "support/utf8.hpp"
#include "support/wrapped.hpp"

namespace hysteron::tool {
namespace {

/// Of paragraphs, where a terminal is no narrower.
constexpr std::size_t page_width = 100;
/// Behind the columns of a pin; where there is less, its words stand below.
constexpr std::size_t least_room = 24;

std::string type_text(const Field& field) {
  return field.length > 1 ? fmt::format("ARRAY [0..{}] OF {}", field.length - 1, type_name(field.type))
                          : std::string(type_name(field.type));
}

/// A paragraph behind an indent; none without words.
std::string paragraph(std::string_view words, std::size_t indent, std::size_t width) {
  return words.empty() ? std::string() : wrapped(std::string(indent, ' ') + std::string(words), width) + "\n";
}

/// The columns of a pin and what is said of it: beside them, or below where a terminal is too narrow; 0: it is none.
std::string pin_line(const std::string& columns, const std::string& words, std::size_t terminal) {
  constexpr std::size_t below = 6;
  const std::size_t at = character_count(columns);
  if (!words.empty() && (terminal == 0 || at + least_room <= terminal)) {
    return columns + paragraph(words, at, terminal).substr(at);
  }
  return columns.substr(0, columns.find_last_not_of(' ') + 1) + "\n" + paragraph(words, below, terminal);
}

/// What is to be known of a field besides its meaning: range, default, neutral setting.
std::string limits_text(const Field& field, bool is_output) {
  std::vector<std::string> parts;
  if (const auto range = range_text(field); !range.empty()) {
    parts.push_back(range);
  }
  if (!is_output) {
    parts.push_back(!field.required    ? "default " + value_text(field, field.preset)
                    : field.length > 1 ? "must be set"
                                       : "must be connected");
  }
  if (field.has_neutral()) {
    parts.push_back("neutral at " + value_text(field, field.neutral));
  }
  if (!field.effect.empty()) {
    parts.push_back(fmt::format("effect {}, of the family {}", field.effect, name_of(field.family)));
  }
  if (field.role != FieldRole::Number) {
    parts.push_back(fmt::format("role {}", text_of(field.role).name));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::size_t widest(std::span<const Field> fields, std::string (*text)(const Field&)) {
  std::size_t width = 0;
  for (const Field& field : fields) {
    width = std::max(width, character_count(text(field)));
  }
  return width;
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, character_count(text)), ' ');
}

std::string section(std::string_view title, std::span<const Field> fields, bool are_outputs, std::size_t terminal) {
  if (fields.empty()) {
    return {};
  }
  const auto name_text = [](const Field& field) { return std::string(field.name); };
  const auto unit_text = [](const Field& field) { return std::string(field.unit); };
  const auto names = widest(fields, name_text);
  const auto types = widest(fields, type_text);
  const auto units = widest(fields, unit_text);
  std::string text = fmt::format("\n{}\n", title);
  for (const Field& field : fields) {
    const auto limits = limits_text(field, are_outputs);
    text += pin_line(
        fmt::format("  {}  {}  {}  ", padded(name_text(field), names), padded(type_text(field), types),
                    padded(unit_text(field), units)),
        fmt::format("{}{}", field.meaning, limits.empty() || field.meaning.empty() ? limits : "; " + limits), terminal);
  }
  return text;
}

/// Of an FMU: what it is, which names differ, and what is left out.
std::string fmu_text(const BlockType& block) {
  const cosimulation::Description& about = block.fmu->description();
  std::string text = fmt::format("\nFMU of FMI {}.0{}\n", about.version,
                                 about.tool.empty() ? std::string() : fmt::format(", made by {}", about.tool));
  text += fmt::format("  NAME : HY_FMU;  (* @file {} *)\n", block.fmu->path());
  if (about.internal_step > 0.0) {
    text += fmt::format("  it computes every {} s: the sample time is a multiple of that\n", about.internal_step);
  }
  std::string names;
  const auto add = [&](std::string_view name, std::string_view original) {
    names += name == original ? "" : fmt::format("  {} is {} of the FMU\n", name, original);
  };
  for (std::size_t pin = 0; pin < block.pin_count(); ++pin) {
    add(block.pin(pin).name, name_in_fmu(block, pin));
  }
  for (std::size_t output = 0; output < block.outputs.size(); ++output) {
    add(block.outputs[output].name, output_name_in_fmu(block, output));
  }
  text += names.empty() ? "" : "\nnames\n" + names;
  text += about.left_out.empty() ? "" : "\nleft out\n";
  for (const cosimulation::LeftOut& one : about.left_out) {
    text += fmt::format("  {}: {}\n", one.name, one.reason);
  }
  return text;
}

std::string feedthrough_line(const BlockType& block, std::size_t output) {
  const auto inputs = feedthrough_inputs(block, output);
  return fmt::format(
      "{}: {}", block.outputs[output].name,
      inputs.empty() ? std::string("no input, so it can close a loop") : fmt::format("{}", fmt::join(inputs, ", ")));
}

nlohmann::json field_json(const Field& field, bool is_output) {
  nlohmann::json json = {{"name", field.name},
                         {"type", type_name(field.type)},
                         {"unit", field.unit},
                         {"meaning", field.meaning},
                         {"length", field.length}};
  if (std::isfinite(field.minimum)) {
    json[field.above_minimum ? "above" : "minimum"] = field.minimum;
  }
  if (std::isfinite(field.maximum)) {
    json["maximum"] = field.maximum;
  }
  if (field.has_neutral()) {
    json["neutral"] = field.neutral;
  }
  if (!field.effect.empty()) {
    json["effect"] = field.effect;
    json["family"] = name_of(field.family);
  }
  if (field.role != FieldRole::Number) {
    json["role"] = text_of(field.role).name;
  }
  if (!is_output && !field.required) {
    json["default"] = field.preset;
  }
  return json;
}

nlohmann::json fields_json(std::span<const Field> fields, bool are_outputs) {
  auto list = nlohmann::json::array();
  for (const Field& field : fields) {
    list.push_back(field_json(field, are_outputs));
  }
  return list;
}

}  // namespace

std::vector<std::string_view> feedthrough_inputs(const BlockType& block, std::size_t output) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < block.inputs.size(); ++i) {
    if (block.trace.feedthrough[output].contains(i)) {
      names.push_back(block.inputs[i].name);
    }
  }
  return names;
}

std::string card_text(const BlockType& block, std::size_t terminal) {
  const std::size_t width = terminal == 0 ? page_width : std::min(page_width, terminal);
  const About& about = block.about;
  std::string text = fmt::format("{}: {} ({})\n\n", about.name, about.title, group_name(about.group));
  text +=
      paragraph(about.equation, 2, width) + (about.equation.empty() ? "" : "\n") + paragraph(about.meaning, 0, width);
  text += section("inputs", block.inputs, false, terminal);
  text += section("parameters", block.params, false, terminal);
  text += section("outputs", block.outputs, true, terminal);
  text += "\nfeedthrough: inputs that an output depends on within the same step\n";
  for (std::size_t i = 0; i < block.outputs.size(); ++i) {
    text += "  " + feedthrough_line(block, i) + "\n";
  }
  if (!about.delay.empty()) {
    text += "\ndelay and gain\n" + paragraph(about.delay, 2, width);
  }
  if (!about.effect.empty()) {
    text += "\neffect\n" + paragraph(fmt::format("{}, of the family {}, between XIN and XOUT.{}", about.effect,
                                                 name_of(about.family), limits_of_effect(block, "")),
                                     2, width);
  }
  if (!about.enriches.empty()) {
    text += fmt::format("\ncan replace\n  {}, to the bit while every further effect is neutral\n", about.enriches);
  }
  if (block.fmu != nullptr) {
    text += fmu_text(block);
  }
  if (!about.source.empty()) {
    text += "\nsource\n" + paragraph(about.source, 2, width);
  }
  return text;
}

nlohmann::json card_json(const BlockType& block) {
  const About& about = block.about;
  nlohmann::json feedthrough = nlohmann::json::object();
  for (std::size_t i = 0; i < block.outputs.size(); ++i) {
    feedthrough[std::string(block.outputs[i].name)] = feedthrough_inputs(block, i);
  }
  return {{"name", about.name},
          {"title", about.title},
          {"group", group_name(about.group)},
          {"equation", about.equation},
          {"meaning", about.meaning},
          {"delay", about.delay},
          {"effect", about.effect},
          {"family", name_of(about.family)},
          {"enriches", about.enriches},
          {"source", about.source},
          {"rate_transition", about.rate_transition},
          {"inputs", fields_json(block.inputs, false)},
          {"parameters", fields_json(block.params, false)},
          {"outputs", fields_json(block.outputs, true)},
          {"feedthrough", feedthrough}};
}

}  // namespace hysteron::tool
