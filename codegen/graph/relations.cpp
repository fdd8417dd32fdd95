#include "codegen/graph/relations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "support/numbers.hpp"

namespace hysteron {
namespace {

constexpr double longest_rounded = 1.0 + 1e-12;  ///< a dead time of exactly so many samples may be rounded up

/// Which parameters of a block hang together, by their places. Found once, by the roles in its description.
struct Relations {
  std::optional<std::size_t> low{};        ///< of two bounds
  std::optional<std::size_t> high{};       ///< both or none
  std::optional<std::size_t> count{};      ///< the points of a table that are used
  std::vector<std::size_t> columns{};      ///< the arrays of a table; the first must rise
  std::optional<std::size_t> dead_time{};  ///< in s, of a block that holds `samples` of the past
  std::size_t samples = 0;
};

std::optional<std::size_t> place_of(std::span<const Field> fields, FieldRole role) {
  const auto found = std::ranges::find(fields, role, &Field::role);
  return found == fields.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - fields.begin()));
}

Relations relations_of(const BlockType& block) {
  Relations result;
  result.low = place_of(block.params, FieldRole::LowerBound);
  result.high = place_of(block.params, FieldRole::UpperBound);
  if (!result.low || !result.high) {
    result.low = result.high = std::nullopt;
  }
  result.count = place_of(block.params, FieldRole::PointCount);
  if (result.count) {
    for (std::size_t i = 0; i < block.params.size(); ++i) {
      if (block.params[i].length > 1) {
        result.columns.push_back(i);
      }
    }
  }
  if (const auto past = place_of(block.states, FieldRole::PastInputs)) {
    result.dead_time = place_of(block.params, FieldRole::DeadTime);
    result.samples = block.states[*past].length;
  }
  return result;
}

const Relations& known_relations(const BlockType& block) {
  static const std::unordered_map<const BlockType*, Relations> all = [] {
    std::unordered_map<const BlockType*, Relations> map;
    for (const BlockType& type : block_types()) {
      map.emplace(&type, relations_of(type));
    }
    return map;
  }();
  static const Relations none{};  // an FMU says nothing of what its parameters are to each other
  return block.fmu != nullptr || block.sized != nullptr ? none : all.at(&block);
}

}  // namespace

std::vector<Contradiction> contradictions(const BlockType& block, std::string_view instance,
                                          std::span<const std::span<const double>> values, double period) {
  const Relations& relations = known_relations(block);
  std::vector<Contradiction> found;
  const auto is_given = [&](std::optional<std::size_t> param) { return param && !values[*param].empty(); };
  const auto name = [&](std::size_t param) { return fmt::format("{}.{}", instance, block.params[param].name); };

  for (std::size_t param = 0; param < values.size(); ++param) {
    if (block.sized != nullptr && block.params[param].name == "DEN" && !values[param].empty() &&
        values[param].front() == 0.0) {
      found.push_back({param, fmt::format("{} begins with 0, which the others are divided by", name(param)),
                       "Its first number belongs to the highest power: give one that is not 0."});
    }
  }

  if (is_given(relations.low) && is_given(relations.high)) {
    const double low = values[*relations.low].front();
    const double high = values[*relations.high].front();
    if (low > high) {
      found.push_back({*relations.low,
                       fmt::format("{} = {} is above {} = {}", name(*relations.low), number_text(low),
                                   block.params[*relations.high].name, number_text(high)),
                       "The lower bound must not be above the upper one."});
    }
  }

  const auto count =
      is_given(relations.count) ? static_cast<std::size_t>(std::max(values[*relations.count].front(), 0.0)) : 0;
  for (const std::size_t column : relations.columns) {
    if (const std::size_t size = values[column].size(); size > 0 && count > size) {
      found.push_back(
          {column,
           fmt::format("{} has {} values, {} = {}", name(column), size, block.params[*relations.count].name, count),
           "Give every point that counts its value, or count fewer."});
    }
  }
  if (is_given(relations.count) && !relations.columns.empty()) {
    const std::size_t column = relations.columns.front();
    auto points = values[column];
    points = count > 0 && count < points.size() ? points.first(count) : points;
    const auto fall = std::ranges::adjacent_find(points, [](double a, double b) { return !(b > a); });
    if (fall != points.end()) {
      found.push_back(
          {column,
           fmt::format("{} does not rise: {} follows on {}, as number {} of {}", name(column), number_text(*(fall + 1)),
                       number_text(*fall), fall - points.begin() + 2, points.size()),
           "Sort the points of the table by this column, and leave out those that stand twice."});
    }
  }

  if (is_given(relations.dead_time) && period > 0.0) {
    const double wanted = values[*relations.dead_time].front();
    const double longest = static_cast<double>(relations.samples) * period;
    if (wanted > longest * longest_rounded) {
      found.push_back(
          {*relations.dead_time,
           fmt::format("{} = {} s is longer than the {} samples of {} s that {} holds", name(*relations.dead_time),
                       number_text(wanted), relations.samples, number_text(period), block.about.name),
           fmt::format("At this sample time {} is at most {} s; let the part run less often by @every, or "
                       "connect two in series.",
                       block.params[*relations.dead_time].name, number_text(longest))});
    }
  }
  return found;
}

std::vector<RisingNumbers> rising_numbers(const Graph& graph) {
  using Number = RisingNumbers::Number;
  std::vector<RisingNumbers> found;
  for (const Node& node : graph.nodes) {
    if (node.block == nullptr || node.block->params.empty()) {
      continue;
    }
    const Relations& relations = known_relations(*node.block);
    const auto number = [&](std::optional<std::size_t> param, std::size_t element = 0) -> std::optional<Number> {
      const Wire* const wire = param ? &graph.wire(node, node.block->inputs.size() + *param) : nullptr;
      if (wire != nullptr && wire->from == Wire::From::Literal) {
        return Number{.constant = graph.literals[wire->index]};
      }
      if (wire != nullptr && wire->from == Wire::From::Parameter) {
        return Number{.parameter = wire->index, .element = element};
      }
      return std::nullopt;
    };
    const auto add = [&](RisingNumbers one) {
      const bool varies = std::ranges::any_of(one.numbers, [](const Number& n) { return n.parameter.has_value(); });
      if (varies || (one.count && one.count->parameter)) {
        found.push_back(std::move(one));
      }
    };
    const auto low = number(relations.low);
    if (const auto high = number(relations.high); low && high) {
      add({.numbers = {*low, *high}});
    }
    if (const auto count = number(relations.count); count && !relations.columns.empty()) {
      const auto first = number(relations.columns.front());
      RisingNumbers column{.strictly = true, .count = count};
      const std::size_t length = first && first->parameter ? graph.parameters[*first->parameter].value.size() : 0;
      for (std::size_t element = 0; element < length; ++element) {
        column.numbers.push_back(*number(relations.columns.front(), element));
      }
      add(std::move(column));
    }
    const double period = period_of(graph, node);
    if (const auto wanted = number(relations.dead_time); wanted && period > 0.0) {
      add({.numbers = {*wanted, {.constant = static_cast<double>(relations.samples) * period * longest_rounded}}});
    }
  }
  return found;
}

}  // namespace hysteron
