#include "codegen/backends/shared/value_shapes.hpp"

#include <algorithm>
#include <bit>

namespace hysteron {
namespace {

std::vector<PortGroup> by_member(const std::vector<PortGroup>& groups) {
  std::vector<PortGroup> list;
  for (const PortGroup& group : groups) {
    list.insert(list.end(), group.length, group);
  }
  return list;
}

std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t golden = 0x9E3779B97F4A7C15ULL;  // 2^64 divided by the golden ratio, as boost::hash_combine
  return a ^ (b + golden + (a << 6U) + (a >> 2U));
}

}  // namespace

void ValueShapes::find_groups(const Graph& graph, const Routine& routine) {
  cell_group_ = by_member(cell_groups(routine.cells));
  input_group_ = by_member(port_groups(graph.inputs));
}

std::uint64_t ValueShapes::shape_of_name(const Value& value) {
  return mixed(0, static_cast<std::uint64_t>(value.type));
}

std::uint64_t ValueShapes::shape_inside(const Tape& tape, ValueId id) const {
  const Value& value = tape[id];
  const std::uint64_t kind = mixed(static_cast<std::uint64_t>(value.op) + 1, static_cast<std::uint64_t>(value.type));
  switch (value.op) {
    case Op::Cell:
      return has_place_[id] ? mixed(kind, cell_group_[value.index].first) : shape_of_name(value);
    case Op::Input:
      return has_place_[id] ? mixed(kind, input_group_[value.index].first) : shape_of_name(value);
    case Op::At:
      if (is_literal(tape[value.args[1]].op)) {
        return mixed(kind, shape_[value.args[0]]);
      }
      break;
    default:
      break;
  }
  std::uint64_t result = mixed(mixed(kind, value.index), std::bit_cast<std::uint64_t>(value.literal));
  for (const ValueId arg : value.args) {
    result = arg == no_value ? result : mixed(result, shape_[arg]);
  }
  return result;
}

bool ValueShapes::place_inside(const Tape& tape, ValueId id) const {
  const Value& value = tape[id];
  switch (value.op) {
    case Op::Cell:
      return cell_group_[value.index].is_array();
    case Op::Input:
      return input_group_[value.index].is_array();
    case Op::At:
      return is_literal(tape[value.args[1]].op);
    default:
      return std::ranges::any_of(value.args, [&](ValueId arg) {
        return arg != no_value && (in_array_[arg] || (!named_[arg] && has_place_[arg]));
      });
  }
}

std::vector<ValueShapes::Term> ValueShapes::terms(const Routine& routine, ValueId sum) const {
  std::vector<Term> list;
  ValueId at = sum;
  while (adds(routine.tape[at].op) && (at == sum || (!named_[at] && routine.uses[at] == 1))) {
    list.push_back({.value = routine.tape[at].args[1], .minus = routine.tape[at].op == Op::Subtract});
    at = routine.tape[at].args[0];
  }
  list.push_back({.value = at});
  std::ranges::reverse(list);
  return list;
}

std::size_t ValueShapes::terms_alike_from(std::span<const Term> terms) const {
  std::size_t count = 1;
  while (count < terms.size() && terms[count].minus == terms[0].minus &&
         shape_[terms[count].value] == shape_[terms[0].value]) {
    ++count;
  }
  return count;
}

bool ValueShapes::has_loop(std::span<const ValueId> rows) const {
  std::size_t count = 1;
  for (std::size_t i = 1; i < rows.size() && count < shortest_loop; ++i) {
    count = has_place_[rows[i]] && inside_[rows[i]] == inside_[rows[i - 1]] ? count + 1 : 1;
  }
  return count >= shortest_loop;
}

bool ValueShapes::is_long(const Routine& routine, ValueId id) const {
  const std::vector<Term> list = terms(routine, id);
  for (std::size_t i = 0; i + shortest_loop <= list.size();) {
    const std::size_t count = terms_alike_from(std::span(list).subspan(i));
    if (count >= shortest_loop && !named_[list[i].value] && has_place_[list[i].value]) {
      return true;
    }
    i += count;
  }
  return false;
}

}  // namespace hysteron
