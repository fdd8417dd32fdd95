// What a body keeps from step to step: a cell for each variable that is read before it is written.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "codegen/graph/body/body.hpp"
#include "support/errors.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;

namespace {

std::string_view delay_of(Plain type) {
  switch (info(type).family) {
    case Family::Truth:
      return "HY_DELAY_BOOL";
    case Family::Number:
    case Family::Duration:
      return "HY_DELAY";
    default:
      return "HY_DELAY_DINT";
  }
}

/// The bits of a whole number, as a DINT has them.
std::int64_t bits_of(double number) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(number)));
}

/// What the bits of a type can be, read as a DINT.
std::pair<std::int64_t, std::int64_t> range_of(Plain type) {
  return {info(type).width == 32 ? lowest(Plain::Dint) : lowest(type), std::min(highest(type), highest(Plain::Dint))};
}

}  // namespace

std::pair<Value, std::uint32_t> Body::delay(Plain plain, double initial, const std::string& name, language::Span span) {
  std::string path = fmt::format("{}{}_LAST", around_.path, name);
  for (int n = 2; !node_paths_.insert(path).second; ++n) {
    path = fmt::format("{}{}_LAST_{}", around_.path, name, n);
  }
  const BlockType* const type = find_block_type(delay_of(plain));
  const std::uint32_t number = around_.builder.block(*type, path, around_.rate, span);
  const Node& node = around_.builder.graph().nodes[number];
  auto& wires = around_.builder.graph().wires;
  wires[node.first_wire + 1] = around_.builder.literal(Type::Bool, 0.0);
  wires[node.first_wire + 2] = computer_.literal(plain, initial).wire;
  Value last{.wire = {Wire::From::Node, type->outputs[0].type, 0, number}, .type = plain};
  if (is_integer(plain)) {
    std::tie(last.low, last.high) = range_of(plain);
  }
  return {last, number};
}

void Body::feed(std::uint32_t delay, const Value& next) {
  auto& graph = around_.builder.graph();
  graph.wires[graph.nodes[delay].first_wire] = next.wire;
}

Value Body::cell(std::uint32_t leaf) {
  Leaf& one = leaves_[leaf];
  if (!one.cell) {
    std::tie(one.cell, one.node) = delay(one.type, one.initial, one.path, one.span);
    if (around_.memory != nullptr && is_integer(one.type)) {
      const auto known = around_.memory->find(one.path);
      if (known != around_.memory->end()) {
        one.cell->low = known->second.low;
        one.cell->high = known->second.high;
      } else if (around_.proving) {
        one.cell->low = one.cell->high = bits_of(one.initial);
      }
    }
  }
  return *one.cell;
}

void Body::close_cells() {
  for (std::uint32_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    if (!leaves_[leaf].cell) {
      continue;
    }
    const Value kept = read(leaf);
    feed(leaves_[leaf].node, kept);
    if (const Leaf& one = leaves_[leaf]; is_integer(one.type)) {
      const auto [low, high] = range_of(one.type);
      kept_.push_back({one.path, bits_of(one.initial), {kept.low, kept.high}, {low, high}});
    }
  }
  for (const auto& [leaf, span] : open_pins_) {
    if (state_.values[leaf]) {
      refuse(error::refused_in_body, span,
             fmt::format("'{}' is assigned behind the call of its block", leaves_[leaf].path),
             "Assign it before the call.");
    }
  }
}

void Body::write(std::uint32_t leaf, const Value& value) {
  if (leaves_[leaf].constant) {
    refuse(error::double_drive, computer_.span(), fmt::format("'{}' cannot be assigned to", leaves_[leaf].path),
           "It is a constant: declare it between VAR and END_VAR of the block.");
  } else if (value.valid()) {
    state_.values[leaf] = value;
  }
}

}  // namespace hysteron::bodies
