#include "lsp/annotations.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "codegen/language/annotation.hpp"

namespace hysteron::lsp {
namespace {

using nlohmann::json;

// CompletionItemKind of LSP 3.17.
constexpr int kind_unit = 11;
constexpr int kind_property = 10;

/// Units that a diagram often has; any product of SI symbols is one.
constexpr std::array<std::string_view, 34> usual{
    "m",   "mm",   "um", "nm",     "m/s", "mm/s", "m/s^2", "rad", "deg",   "rad/s", "rpm", "N",
    "N*m", "N/m",  "kg", "kg*m^2", "V",   "mV",   "A",     "Ohm", "N*m/A", "W",     "Pa",  "bar",
    "K",   "degC", "s",  "ms",     "1/s", "Hz",   "L/min", "%",   "count", "1"};

}  // namespace

json annotation_completion(std::string_view text, const language::SourceFile& tree, const language::Span& comment,
                           std::size_t offset) {
  json items = json::array();
  const std::string_view before = text.substr(comment.offset, offset - comment.offset);
  const auto at = before.rfind('@');
  if (at == std::string_view::npos) {
    return items;
  }
  const std::string_view typed = before.substr(at + 1);
  const auto blank = typed.find_first_of(" \t");
  if (blank == std::string_view::npos) {
    for (const language::AnnotationKey& key : language::annotation_keys()) {
      items.push_back({{"label", key.name}, {"kind", kind_property}, {"detail", key.meaning}});
    }
    return items;
  }
  const auto value = typed.find_first_not_of(" \t", blank);
  const bool is_second_word =
      value != std::string_view::npos && typed.find_first_of(" \t", value) != std::string_view::npos;
  if (typed.substr(0, blank) != "unit" || is_second_word) {
    return items;
  }
  std::vector<std::string> units;
  const auto add = [&](std::string_view unit, std::string_view detail) {
    if (!unit.empty() && std::ranges::find(units, unit) == units.end()) {
      units.emplace_back(unit);
      items.push_back({{"label", unit}, {"kind", kind_unit}, {"detail", detail}});
    }
  };
  for (const language::FunctionBlock& block : tree.blocks) {
    for (const language::Variable& variable : block.variables) {
      for (const language::Annotation& one : variable.annotations) {
        const bool is_this = one.span.offset <= offset && offset <= one.span.offset + one.span.length;
        add(one.key == "unit" && !is_this ? one.value : std::string_view(), "a unit of this file");
      }
    }
  }
  for (const std::string_view unit : usual) {
    add(unit, "a unit");
  }
  return items;
}

}  // namespace hysteron::lsp
