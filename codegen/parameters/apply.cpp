#include "codegen/parameters/apply.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "codegen/graph/relations.hpp"
#include "codegen/parameters/elements.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::parameters {
namespace {

/// More names than these are not listed in a message.
constexpr std::size_t most_names = 8;

std::string_view type_in_words(const Field& field) {
  if (field.length > 1) {
    return "a list of numbers";
  }
  switch (field.type) {
    case Type::Bool:
      return "true or false";
    case Type::Real:
      return "a number";
    default:
      return "a whole number";
  }
}

std::string kind_of(const Value& value) {
  if (const auto* const list = std::get_if<std::vector<double>>(&value)) {
    return fmt::format("a list of {}", list->size());
  }
  if (const auto* const truths = std::get_if<std::vector<bool>>(&value)) {
    return fmt::format("a list of {} truths", truths->size());
  }
  if (const auto* const truth = std::get_if<bool>(&value)) {
    return *truth ? "true" : "false";
  }
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
    return fmt::format("{}", *whole);
  }
  return number_text(std::get<double>(value));
}

std::string example_of(const Field& field) {
  if (field.length > 1) {
    return fmt::format("{} = [0.0, 1.0]", field.name);
  }
  switch (field.type) {
    case Type::Bool:
      return fmt::format("{} = true", field.name);
    case Type::Real:
      return fmt::format("{} = {}", field.name, real_literal(field.preset));
    default:
      return fmt::format("{} = {}", field.name, number_text(field.preset));
  }
}

/// The numbers of a value, where it is of a field's type.
std::optional<std::vector<double>> numbers_of(const Value& value, const Field& field) {
  const auto* const list = std::get_if<std::vector<double>>(&value);
  if ((list != nullptr) != (field.length > 1) || std::holds_alternative<std::vector<bool>>(value)) {
    return std::nullopt;  // no block has a list of truths for a parameter
  }
  if (list != nullptr) {
    return *list;
  }
  if (const auto* const truth = std::get_if<bool>(&value)) {
    return field.type == Type::Bool ? std::optional(std::vector{*truth ? 1.0 : 0.0}) : std::nullopt;
  }
  if (field.type == Type::Bool) {
    return std::nullopt;
  }
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
    return std::vector{static_cast<double>(*whole)};
  }
  return field.type == Type::Real ? std::optional(std::vector{std::get<double>(value)}) : std::nullopt;
}

struct NamedPin {
  const Node* instance = nullptr;
  bool is_input = false;  ///< of the block, which is no parameter even where nothing is connected to it
};

/// The instance that a path names by its front, if it has the pin that it names by its end.
NamedPin find_pin(const Graph& graph, std::string_view path) {
  const auto dot = path.rfind('.');
  if (dot == std::string_view::npos) {
    return {};
  }
  for (const Node& node : graph.nodes) {
    if (node.block != nullptr && equal_ignoring_case(node.path, path.substr(0, dot))) {
      for (std::size_t i = 0; i < node.block->pin_count(); ++i) {
        if (equal_ignoring_case(node.block->pin(i).name, path.substr(dot + 1))) {
          return {.instance = &node, .is_input = i < node.block->inputs.size()};
        }
      }
    }
  }
  return {};
}

const Node* find_instance(const Graph& graph, std::string_view path) {
  const auto found = std::ranges::find_if(
      graph.nodes, [&](const Node& node) { return node.block != nullptr && equal_ignoring_case(node.path, path); });
  return found == graph.nodes.end() ? nullptr : &*found;
}

/// The first parameter of an instance that a file can set; empty where there is none.
std::string first_parameter(const Graph& graph, std::string_view instance) {
  const std::string front = in_capitals(instance) + ".";
  const auto found = std::ranges::find_if(
      graph.parameters, [&](const Parameter& one) { return in_capitals(one.path).starts_with(front); });
  return found == graph.parameters.end() ? std::string() : found->path;
}

/// A table [fit.PID] without a line below it names nothing that could be fitted.
void report_unknown_fit(const Graph& graph, const FitSetting& fit, Diagnostics& diagnostics) {
  const bool is_empty = !fit.minimum && !fit.maximum && !fit.start && !fit.scale;
  const std::string parameter = first_parameter(graph, fit.path);
  if (!is_empty || parameter.empty()) {
    report_unknown_parameter(graph, fit.path, fit.place, diagnostics);
    return;
  }
  diagnostics.error(error::nothing_to_fit, fit.place,
                    fmt::format("[fit.{0}] is empty: it names no parameter of {0}.", fit.path),
                    fmt::format("write below it {} = {{}}, or with bounds, as {{min = 0.0, max = 10.0}}.",
                                parameter.substr(fit.path.size() + 1)));
}

bool is_input(const Graph& graph, std::string_view path) {
  return std::any_of(graph.inputs.begin(), graph.inputs.end(),
                     [&](const Port& input) { return equal_ignoring_case(input.name, path); });
}

/// False where the value was refused.
bool set(const ParameterValue& given, Parameter& parameter, Diagnostics& diagnostics) {
  const Field& field = parameter.field;
  const auto numbers = numbers_of(given.value, field);
  if (!numbers) {
    diagnostics.error(error::wrong_value_type, given.value_place,
                      fmt::format("{} takes {}, not {}.", parameter.path, type_in_words(field), kind_of(given.value)),
                      fmt::format("write it as in {}.", example_of(field)));
    return false;
  }
  if (numbers->size() > field.length || (field.filled && numbers->size() < field.length)) {
    diagnostics.error(error::wrong_value_type, given.value_place,
                      fmt::format("{} takes {}{} numbers, here are {}.", parameter.path, field.filled ? "" : "at most ",
                                  field.length, numbers->size()),
                      numbers->size() > field.length ? "leave some out." : "give all of them, row by row.");
    return false;
  }
  for (const double number : *numbers) {
    if (const auto fault = range_fault(field, number); !fault.empty()) {
      diagnostics.error(error::parameter_out_of_range, given.value_place,
                        fmt::format("{} = {} lies outside of its range.", parameter.path, number_text(number)),
                        fmt::format("{} {}.", field.name, fault));
      return false;
    }
  }
  std::fill(parameter.value.begin(), parameter.value.end(), 0.0);
  std::copy(numbers->begin(), numbers->end(), parameter.value.begin());
  return true;
}

}  // namespace

Value value_for(const Field& field, double number) {
  if (field.type == Type::Bool && (number == 0.0 || number == 1.0)) {
    return number != 0.0;
  }
  const bool whole = number == std::floor(number) && std::fabs(number) < 0x1p53;
  return field.type != Type::Real && field.type != Type::Bool && whole ? Value(static_cast<std::int64_t>(number))
                                                                       : Value(number);
}

std::string range_fault(const Field& field, double value) {
  double low = field.minimum;
  double high = field.maximum;
  if (field.type == Type::Int) {
    low = std::max<double>(low, std::numeric_limits<std::int32_t>::min());
    high = std::min<double>(high, std::numeric_limits<std::int32_t>::max());
  } else if (field.type == Type::Word) {
    low = std::max<double>(low, 0.0);
    high = std::min<double>(high, std::numeric_limits<std::uint16_t>::max());
  }
  const bool too_low = field.above_minimum ? !(value > low) : !(value >= low);
  if (!too_low && value <= high) {
    return {};
  }
  const auto at_least =
      low > -infinity ? fmt::format("{} {}", field.above_minimum ? "above" : "at least", number_text(low)) : "";
  const auto at_most = high < infinity ? fmt::format("at most {}", number_text(high)) : "";
  return fmt::format("must be {}{}{}", at_least, at_least.empty() || at_most.empty() ? "" : " and ", at_most);
}

void report_unknown_parameter(const Graph& graph, std::string_view path, const Place& place, Diagnostics& diagnostics) {
  const auto [node, is_pin_input] = find_pin(graph, path);
  if (is_pin_input) {
    diagnostics.error(error::unknown_key, place,
                      fmt::format("{} is an input of {}, not a parameter.", path, node->block->about.name),
                      "remove it here, or connect an input of the diagram to that pin and mark it (* @param *).",
                      {{.place = graph.place(node->span), .text = fmt::format("{} in the diagram", node->path)}});
    return;
  }
  if (node != nullptr) {
    diagnostics.error(error::unknown_key, place,
                      fmt::format("{} is not free to be set: the diagram connects or fixes it.", path),
                      "remove it here, or remove what the diagram gives to that pin.",
                      {{.place = graph.place(node->span), .text = fmt::format("{} in the diagram", node->path)}});
    return;
  }
  if (const Node* const instance = find_instance(graph, path)) {
    const std::string parameter = first_parameter(graph, path);
    diagnostics.error(error::unknown_key, place,
                      fmt::format("{} is a {}, not a parameter.", path, instance->block->about.name),
                      parameter.empty() ? "remove it; the diagram gives all of its parameters."
                                        : fmt::format("name a parameter of it, such as {}.", parameter));
    return;
  }
  if (is_input(graph, path)) {
    diagnostics.error(error::unknown_key, place, fmt::format("{} is an input of the diagram, not a parameter.", path),
                      "give it a column in the record, or mark it (* @param *) in the diagram.");
    return;
  }
  std::vector<std::string> known;
  known.reserve(graph.parameters.size());
  for (const Parameter& parameter : graph.parameters) {
    known.push_back(parameter.path);
  }
  std::string mend = "remove it; the diagram has no parameters.";
  if (const auto near = nearest_name(path, known); !near.empty()) {
    mend = fmt::format("did you mean {}?", near);
  } else if (!known.empty()) {
    const auto shown = std::min(known.size(), most_names);
    mend =
        fmt::format("the parameters are {}{}.", fmt::join(known.begin(), known.begin() + static_cast<int>(shown), ", "),
                    shown < known.size() ? fmt::format(" and {} more", known.size() - shown) : "");
  }
  diagnostics.error(error::unknown_key, place, fmt::format("{} has no parameter {}.", graph.name, path),
                    std::move(mend));
}

std::optional<InitialState> find_state(const Graph& graph, std::string_view path, const Place& place,
                                       Diagnostics& diagnostics) {
  std::vector<std::string> known;
  for (std::uint32_t node = 0; node < graph.nodes.size(); ++node) {
    const BlockType* const block = graph.nodes[node].block;
    for (std::uint32_t state = 0; block != nullptr && state < block->states.size(); ++state) {
      const Field& field = block->states[state];
      if (field.type != Type::Real || field.length > 1) {
        continue;
      }
      known.push_back(fmt::format("{}.{}", graph.nodes[node].path, field.name));
      if (equal_ignoring_case(known.back(), path)) {
        return InitialState{.node = node, .state = state};
      }
    }
  }
  const auto near = nearest_name(path, known);
  std::string mend = "remove it; no block of the diagram has a state that is a real number.";
  if (!near.empty()) {
    mend = fmt::format("did you mean {}?", near);
  } else if (!known.empty()) {
    const auto shown = std::min(known.size(), most_names);
    mend = fmt::format("the states are {}{}.",
                       fmt::join(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                       shown < known.size() ? fmt::format(" and {} more", known.size() - shown) : "");
  }
  diagnostics.error(error::unknown_key, place,
                    fmt::format("{} has no state {} that is a real number.", graph.name, path), std::move(mend));
  return std::nullopt;
}

namespace {

void set_state(const ParameterValue& given, Graph& graph, Diagnostics& diagnostics) {
  auto state = find_state(graph, given.path, given.place, diagnostics);
  if (!state) {
    return;
  }
  const Field& field = graph.nodes[state->node].block->states[state->state];
  const auto numbers = numbers_of(given.value, field);
  if (!numbers) {
    diagnostics.error(error::wrong_value_type, given.value_place,
                      fmt::format("{} takes a number, not {}.", given.path, kind_of(given.value)),
                      fmt::format("write it as in {} = 0.0.", field.name));
    return;
  }
  state->value = numbers->front();
  if (const auto fault = range_fault(field, state->value); !fault.empty()) {
    diagnostics.error(error::parameter_out_of_range, given.value_place,
                      fmt::format("{} = {} lies outside of its range.", given.path, number_text(state->value)),
                      fmt::format("{} {}.", field.name, fault));
    return;
  }
  std::erase_if(graph.initial_states,
                [&](const InitialState& one) { return one.node == state->node && one.state == state->state; });
  graph.initial_states.push_back(*state);
}

/// A bound that the parameter itself cannot take is a slip. At a bound that is excluded, as 0 where it must be above 0,
/// a fit keeps away from it.
void check_bounds(const FitSetting& fit, const Parameter& parameter, Diagnostics& diagnostics) {
  const Field& field = parameter.field;
  for (const auto* const bound : {&fit.minimum, &fit.maximum}) {
    if (*bound && std::isfinite((*bound)->value) &&
        ((*bound)->value < field.minimum || (*bound)->value > field.maximum)) {
      diagnostics.error(error::parameter_out_of_range, (*bound)->place,
                        fmt::format("The fit of {} has the bound {}, outside of the parameter's own range.",
                                    parameter.path, number_text((*bound)->value)),
                        fmt::format("{} {}.", field.name, range_fault(field, (*bound)->value)));
    }
  }
}

/// The values that the file sets among the parameters that they hang together with, which may stand in the diagram.
void check_relations(const Graph& graph, const std::vector<const ParameterValue*>& set_by, Diagnostics& diagnostics) {
  for (const Node& node : graph.nodes) {
    if (node.block == nullptr || node.block->params.empty()) {
      continue;
    }
    const ParameterValue* last = nullptr;
    const auto given_to = [&](std::size_t param) {
      const Wire& wire = graph.wire(node, node.block->inputs.size() + param);
      return wire.from == Wire::From::Parameter ? set_by[wire.index] : nullptr;
    };
    for (std::size_t param = 0; param < node.block->params.size(); ++param) {
      const ParameterValue* const given = given_to(param);
      last = given != nullptr ? given : last;
    }
    if (last == nullptr) {
      continue;
    }
    const auto values = numbers_of_params(graph, node, [&](std::size_t parameter) {
      const auto* const given = set_by[parameter];
      const auto* const list = given != nullptr ? std::get_if<std::vector<double>>(&given->value) : nullptr;
      const std::span<const double> all(graph.parameters[parameter].value);
      return list != nullptr ? all.first(list->size()) : all;
    });
    for (Contradiction& one : contradictions(*node.block, node.path, values, period_of(graph, node))) {
      const ParameterValue* const given = given_to(one.param);
      diagnostics.error(error::parameter_out_of_range, (given != nullptr ? given : last)->value_place,
                        std::move(one.cause), std::move(one.mend));
    }
  }
}

}  // namespace

void apply(const ParameterFile& as_written, Graph& graph, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.all().size();
  const ParameterFile file = by_element(as_written, graph, diagnostics);
  bool all_set = diagnostics.all().size() == before;
  std::vector<const ParameterValue*> set_by(graph.parameters.size(), nullptr);
  std::unordered_map<std::string, std::size_t> by_path;
  for (std::size_t i = 0; i < graph.parameters.size(); ++i) {
    by_path.emplace(graph.parameters[i].path, i);
  }
  for (const ParameterValue& given : file.values) {
    const auto found = by_path.find(in_capitals(given.path));
    if (found == by_path.end()) {
      report_unknown_parameter(graph, given.path, given.place, diagnostics);
    } else {
      const bool is_set = set(given, graph.parameters[found->second], diagnostics);
      set_by[found->second] = &given;
      all_set = all_set && is_set;
    }
  }
  if (all_set && !file.values.empty()) {
    check_relations(graph, set_by, diagnostics);
  }
  for (const ParameterValue& given : file.initial) {
    set_state(given, graph, diagnostics);
  }
  for (const FitSetting& fit : file.fits) {
    const auto found = by_path.find(in_capitals(fit.path));
    if (found == by_path.end()) {
      report_unknown_fit(graph, fit, diagnostics);
    } else {
      check_bounds(fit, graph.parameters[found->second], diagnostics);
    }
  }
}

void apply(const ParameterFile& file, Graph& graph) {
  Diagnostics diagnostics;
  apply(file, graph, diagnostics);
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
}

}  // namespace hysteron::parameters
