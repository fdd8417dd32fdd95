// What a routine needs, and what nobody needs.
#include <algorithm>
#include <cmath>

#include "codegen/backends/shared/routine.hpp"

namespace hysteron {
namespace {

/// What is used once is written where it is used. An operand stands in the tape before its operation.
void count_uses(Routine& routine) {
  std::vector<std::uint32_t>& uses = routine.uses;
  uses.assign(routine.tape.size(), 0);
  const auto use = [&](ValueId id) {
    if (id != no_value) {
      ++uses[id];
    }
  };
  for (const auto* list : {&routine.reset, &routine.step}) {
    for (const Statement& statement : *list) {
      if (statement.kind != Statement::Kind::Define) {
        use(statement.value);
        use(statement.index);
      }
    }
  }
  for (const CallArgument& argument : routine.arguments) {
    use(argument.value);
  }
  for (auto id = static_cast<ValueId>(uses.size()); id-- > 0;) {
    if (uses[id] > 0) {
      std::ranges::for_each(routine.tape[id].args, use);
    }
  }
}

void count_operations(Routine& routine, ValueId first_of_step) {
  for (ValueId id = 0; id < routine.tape.size(); ++id) {
    const Value& value = routine.tape[id];
    if (routine.uses[id] == 0) {
      continue;
    }
    const bool of_step = id >= first_of_step;
    (of_step ? routine.used_by_step : routine.used_by_reset).set(static_cast<std::size_t>(value.op));
    routine.infinite_literals = routine.infinite_literals || !std::isfinite(value.literal);
    routine.reads_by_index =
        routine.reads_by_index || (value.op == Op::At && routine.tape[value.args[1]].op != Op::IntLiteral);
    if (of_step && !is_leaf(value.op)) {
      ++routine.operations;
      routine.function_calls += value.op >= Op::Exp && value.op <= Op::Power ? 1 : 0;
    }
  }
}

}  // namespace

Op literal_op(Type type) {
  switch (type) {
    case Type::Real:
      return Op::RealLiteral;
    case Type::Bool:
      return Op::BoolLiteral;
    case Type::Int:
      return Op::IntLiteral;
    default:
      return Op::WordLiteral;
  }
}

void add_counter(Routine& routine) {
  if (routine.longest_period > 1) {
    routine.counter = static_cast<std::uint32_t>(routine.cells.size());
    Field field;
    field.name = "STEPS";
    field.type = Type::Int;
    field.meaning = "steps since the beginning of the longest period";
    routine.cells.push_back({.field = field});
  }
}

void finish_routine(Routine& routine, ValueId first_of_step) {
  count_uses(routine);
  std::erase_if(routine.step, [&](const Statement& statement) {
    return statement.kind == Statement::Kind::Define && routine.uses[statement.value] == 0;
  });
  count_operations(routine, first_of_step);
}

}  // namespace hysteron
