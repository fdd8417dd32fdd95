#include "codegen/backends/reference/block_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "codegen/backends/reference/block_response.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

struct GroupText {
  Group group;
  std::string_view name;
  std::string_view meaning;
};

constexpr std::array groups{
    GroupText{Group::Memory, "memory", "hysteresis, MEM elements, momentum and branching points"},
    GroupText{Group::Arithmetic, "arithmetic", "constants, sums, products"},
    GroupText{Group::Function, "function", "elementary functions"},
    GroupText{Group::Shaping, "shaping", "limits, dead band, tables, switches, quantizer, backlash"},
    GroupText{Group::Dynamics, "dynamics", "derivatives, integrals, delays, lags"},
    GroupText{Group::Control, "control", "controller and reference signals"},
    GroupText{Group::Logic, "logic", "comparisons, logic, edges, latches"},
    GroupText{Group::Time, "time", "timers and counters, exact in steps"},
    GroupText{Group::Rate, "rate", "borders between parts that run at different rates"}};

/// Text as Markdown shows it: no character of it is markup.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '*' || c == '<' || c == '|') {
      result += '\\';
    }
    result += c;
  }
  return result;
}

std::string type_text(const Field& field) {
  return field.length > 1 ? fmt::format("ARRAY [0..{}] OF {}", field.length - 1, type_name(field.type))
                          : std::string(type_name(field.type));
}

std::string unit_text(const Field& field) {
  return field.unit.empty() ? std::string() : fmt::format("`{}`", field.unit);
}

std::string default_text(const Field& field) {
  if (field.required) {
    return field.length > 1 ? "none: to be set" : "none: to be connected";
  }
  return value_text(field, field.preset);
}

bool any_neutral(std::span<const Field> fields) {
  return std::ranges::any_of(fields, [](const Field& field) { return field.has_neutral(); });
}

bool any_effect(std::span<const Field> fields) {
  return std::ranges::any_of(fields, [](const Field& field) { return !field.effect.empty(); });
}

bool any_role(std::span<const Field> fields) {
  return std::ranges::any_of(fields, [](const Field& field) { return field.role != FieldRole::Number; });
}

bool any_range(std::span<const Field> fields) {
  return std::ranges::any_of(fields, [](const Field& field) { return !range_text(field).empty(); });
}

enum class Kind : std::uint8_t { Input, Parameter, Output, State };

/// A table of fields; a column that would be empty is left out.
std::string table(std::span<const Field> fields, Kind kind) {
  const bool has_default = kind == Kind::Input || kind == Kind::Parameter;
  const bool has_range = any_range(fields);
  const bool has_neutral = any_neutral(fields);
  const bool has_effect = any_effect(fields);
  const bool has_role = any_role(fields);
  std::string text = "| name | type | unit |";
  std::string rule = "| --- | --- | --- |";
  const auto column = [&](bool is_there, std::string_view name) {
    text += is_there ? fmt::format(" {} |", name) : "";
    rule += is_there ? " --- |" : "";
  };
  column(has_range, "range");
  column(has_default, "default");
  column(has_neutral, "neutral");
  column(has_effect, "effect");
  column(has_role, "role");
  column(true, "meaning");
  text += "\n" + rule + "\n";
  for (const Field& field : fields) {
    text += fmt::format("| `{}` | {} | {} |", field.name, type_text(field), unit_text(field));
    text += has_range ? fmt::format(" {} |", range_text(field)) : "";
    text += has_default ? fmt::format(" {} |", default_text(field)) : "";
    text += has_neutral ? fmt::format(" {} |", field.has_neutral() ? value_text(field, field.neutral) : "") : "";
    text += !has_effect            ? ""
            : field.effect.empty() ? " |"
                                   : fmt::format(" `{}`, {} |", field.effect, name_of(field.family));
    text += !has_role ? "" : field.role == FieldRole::Number ? " |" : fmt::format(" {} |", text_of(field.role).name);
    text += fmt::format(" {} |\n", escaped(field.meaning));
  }
  return text;
}

/// Which output depends on which input within the same step.
std::string feedthrough(const BlockType& block) {
  if (block.inputs.empty()) {
    return "The block has no inputs.\n";
  }
  std::string text = "| |";
  std::string rule = "| --- |";
  for (const Field& input : block.inputs) {
    text += fmt::format(" `{}` |", input.name);
    rule += " :-: |";
  }
  text += "\n" + rule + "\n";
  bool any_free = false;
  for (std::size_t o = 0; o < block.outputs.size(); ++o) {
    text += fmt::format("| `{}` |", block.outputs[o].name);
    bool is_free = true;
    for (std::size_t i = 0; i < block.inputs.size(); ++i) {
      const bool through = block.trace.feedthrough[o].contains(i);
      is_free = is_free && !through;
      text += through ? " ● |" : " |";
    }
    any_free = any_free || (is_free && !block.states.empty());
    text += "\n";
  }
  text += "\n●: the output of a step depends on the input of the same step.";
  text += any_free ? " An output without a mark can close a loop.\n" : "\n";
  return text;
}

/// The effects of a family, each with the blocks that have it.
std::string members_of(Family family, std::string_view folder) {
  std::map<std::string_view, std::vector<std::string>> members;
  for (const BlockType& block : block_types()) {
    const std::string link = fmt::format("[{0}]({1}/{0}.md)", block.about.name, folder);
    const auto add = [&](std::string_view effect, Family of) {
      if (of == family && (members[effect].empty() || members[effect].back() != link)) {
        members[effect].push_back(link);
      }
    };
    add(block.about.effect, block.about.family);
    for (const Field& field : block.params) {
      add(field.effect, field.family);
    }
  }
  std::string text;
  for (const auto& [effect, blocks] : members) {
    text += fmt::format("{}`{}` ({})", text.empty() ? "" : ", ", effect, fmt::join(blocks, ", "));
  }
  return text;
}

/// A list such as `a; b; c`, one part a line.
std::string lines_of(std::string_view parts) {
  std::string text;
  while (!parts.empty()) {
    const auto end = std::min(parts.find("; "), parts.size());
    text += std::string(parts.substr(0, end)) + "\n";
    parts.remove_prefix(std::min(end + 2, parts.size()));
  }
  return text;
}

}  // namespace

std::string_view group_name(Group group) {
  const auto* const found = std::ranges::find_if(groups, [&](const GroupText& one) { return one.group == group; });
  return found == groups.end() ? std::string_view() : found->name;
}

std::string range_text(const Field& field) {
  const bool low = std::isfinite(field.minimum);
  const bool high = std::isfinite(field.maximum);
  if (low && high && !field.above_minimum) {
    return fmt::format("{} to {}", number_text(field.minimum), number_text(field.maximum));
  }
  return fmt::format("{}{}{}{}{}", low ? (field.above_minimum ? "above " : "at least ") : "",
                     low ? number_text(field.minimum) : "", low && high ? " and " : "", high ? "at most " : "",
                     high ? number_text(field.maximum) : "");
}

std::string limits_of_effect(const BlockType& block, std::string_view quote) {
  std::string text;
  if (block.about.of_record) {
    text += " It is the record's: a diagnosis tries it at the inputs and outputs of a diagram alone.";
  }
  if (!block.about.untried.empty()) {
    text += fmt::format(" A diagnosis tries it where it is asked for it ({}--effects{}): {}.", quote, quote,
                        block.about.untried);
  }
  for (const Field& field : block.params) {
    const bool low = std::isfinite(field.effect_minimum);
    if (low || std::isfinite(field.effect_maximum)) {
      text += fmt::format(" A diagnosis tries {}{}{}{}{} up to {}: beyond, it would be another effect.", quote,
                          field.name, quote, low ? " from " : "", low ? number_text(field.effect_minimum) : "",
                          number_text(field.effect_maximum));
    }
  }
  return text;
}

std::string value_text(const Field& field, double value) {
  return field.type == Type::Bool ? (value != 0.0 ? "TRUE" : "FALSE") : number_text(value);
}

std::string block_page(const BlockType& block, const BlockPageOptions& options) {
  const About& about = block.about;
  const auto heading = [&](int below) { return std::string(static_cast<std::size_t>(options.heading + below), '#'); };
  std::string text = fmt::format("{} {}: {}\n\n```text\n{}```\n\n{}\n", heading(0), about.name, about.title,
                                 lines_of(about.equation), escaped(about.meaning));
  if (block.sized != nullptr) {
    text += "\nPins, parameters and states below are those of the example: how many there are, its lists say.\n";
  }
  if (!options.picture.empty()) {
    text += fmt::format("\n![Response of {}]({})\n\nThe picture is a run of the example below.\n", about.name,
                        options.picture);
  }
  const auto part = [&](std::string_view title, const std::string& body) {
    text += fmt::format("\n{} {}\n\n{}", heading(1), title, body);
  };
  if (!block.inputs.empty()) {
    part("Inputs", table(block.inputs, Kind::Input));
  }
  if (!block.params.empty()) {
    part("Parameters", table(block.params, Kind::Parameter));
  }
  part("Outputs", table(block.outputs, Kind::Output));
  part("Feedthrough", feedthrough(block));
  if (!block.states.empty()) {
    part("States", table(block.states, Kind::State));
  }
  if (!about.delay.empty()) {
    part("Delay and gain", escaped(about.delay) + "\n");
  }
  if (!about.effect.empty()) {
    part("Effect",
         fmt::format("`{}`, of the family `{}`, between `XIN` and `XOUT`. With every parameter at its neutral "
                     "setting the block passes its input through unchanged.{}\n",
                     about.effect, name_of(about.family), limits_of_effect(block, "`")));
  }
  if (!about.enriches.empty()) {
    part("Replaces",
         fmt::format("`{}`, of which it has every port and parameter. With every further effect at its neutral "
                     "setting both give the same bits.\n",
                     about.enriches));
  }
  part("Example", fmt::format("```st\n{}```\n", response_diagram(block)));
  if (!about.source.empty()) {
    part("Source", escaped(about.source) + "\n");
  }
  return text;
}

std::string family_index(std::string_view folder) {
  std::string text =
      "### Effects by family\n\nA family is what a record tells before it tells the member. A diagram's own effect "
      "names its\nfamily by `@family`.\n\n| family | what it is | effects |\n| --- | --- | --- |\n";
  for (const FamilyText& one : family_texts) {
    text += fmt::format("| `{}` | {} | {} |\n", one.name, escaped(one.meaning), members_of(one.family, folder));
  }
  return text;
}

std::string block_index(std::string_view folder) {
  std::string text;
  for (const GroupText& group : groups) {
    std::vector<const BlockType*> members = documented_blocks();
    std::erase_if(members, [&](const BlockType* block) { return block->about.group != group.group; });
    std::ranges::sort(members, {}, [](const BlockType* block) { return block->about.name; });
    auto title = std::string(group.name);
    title.front() = static_cast<char>(title.front() - 'a' + 'A');
    text += fmt::format("{}### {}: {}\n\n| block | title |\n| --- | --- |\n", text.empty() ? "" : "\n", title,
                        group.meaning);
    for (const BlockType* const block : members) {
      text += fmt::format("| [{0}]({1}/{0}.md) | {2} |\n", block->about.name, folder, escaped(block->about.title));
    }
  }
  return text;
}

}  // namespace hysteron
