#include "codegen/backends/shared/routine.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/element_name.hpp"

namespace hysteron {
namespace {

class RoutineBuilder {
 public:
  RoutineBuilder(const Program& program, RoutineOptions options)
      : program_(program), graph_(program.graph), options_(std::move(options)) {}

  Routine run() {
    place_cells();
    make_room();
    write_reset();
    write_initial_states();
    routine_.tape.forget();
    const auto first_of_step = static_cast<ValueId>(routine_.tape.size());
    for (const Action& action : program_.schedule.actions) {
      write_action(action);
    }
    for (std::uint32_t i = 0; i < graph_.outputs.size(); ++i) {
      const Wire& wire = graph_.outputs[i].wire;
      routine_.step.push_back({.kind = Statement::Kind::SetOutput,
                               .target = i,
                               .value = is_ahead(i) ? value_ahead(wire) : value_of_wire(wire)});
    }
    finish_routine(routine_, first_of_step);
    return std::move(routine_);
  }

 private:
  static constexpr std::uint32_t unknown = no_value;

  // --- what lives from step to step ---

  void place_cells() {
    first_cell_.resize(graph_.nodes.size());
    first_output_.resize(graph_.nodes.size());
    laid_.resize(graph_.nodes.size());
    std::uint32_t outputs = 0;
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      const Node& node = graph_.nodes[index];
      first_output_[index] = outputs;
      outputs += static_cast<std::uint32_t>(output_count(node));
      first_cell_[index] = static_cast<std::uint32_t>(routine_.cells.size());
      if (node.block != nullptr) {
        for (std::uint32_t state = 0; state < node.block->states.size(); ++state) {
          routine_.cells.push_back(
              {.instance = node.path, .field = node.block->states[state], .node = index, .place = state});
        }
      }
      routine_.longest_period = std::lcm(routine_.longest_period, node.rate.every);
    }
    outputs_.assign(outputs, unknown);
    held_.assign(outputs, unknown);
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      const Node& node = graph_.nodes[index];
      if (node.rate == Rate{}) {
        continue;
      }
      for (std::uint32_t port = 0; port < output_count(node); ++port) {  // read also in steps in which it does not run
        held_[first_output_[index] + port] = static_cast<std::uint32_t>(routine_.cells.size());
        Field field;
        field.name = node.block != nullptr ? node.block->outputs[port].name : std::string_view("VALUE");
        field.type = output_type(node, port);
        field.meaning = "last value";
        routine_.cells.push_back({.instance = node.path, .field = field, .node = index, .held = true, .place = port});
      }
    }
    add_counter(routine_);
  }

  /// The values of a node are at most those of its trace, once for the reset and once for the step, and its wires.
  void make_room() {
    std::size_t values = 0;
    std::size_t statements = 0;
    for (const Node& node : graph_.nodes) {
      values += node.wire_count + 1 + (node.block != nullptr ? 2 * node.block->trace.tape.size() : 0);
      statements += 2 + (node.block != nullptr ? node.block->outputs.size() + 2 * node.block->states.size() : 0);
    }
    routine_.tape.reserve(values);
    routine_.step.reserve(statements);
  }

  // --- values ---

  ValueId value_of_wire(const Wire& wire) {
    Tape& tape = routine_.tape;
    switch (wire.from) {
      case Wire::From::Literal: {
        const Op op = literal_op(wire.type);
        return tape.literal(op, graph_.literals[wire.index]);
      }
      case Wire::From::Parameter:
        return tape.leaf(Op::Parameter, wire.type, wire.index);
      case Wire::From::Input:
        return tape.leaf(Op::Input, wire.type, wire.index);
      default: {
        const std::uint32_t output = first_output_[wire.index] + wire.port;
        return held_[output] != unknown ? tape.leaf(Op::Cell, wire.type, held_[output]) : outputs_[output];
      }
    }
  }

  /// A value of a block's trace, laid into the routine's tape.
  ValueId lay(std::uint32_t index, ValueId id, std::vector<ValueId>& laid) {
    if (laid[id] != no_value) {
      return laid[id];
    }
    const Node& node = graph_.nodes[index];
    const Value& value = node.block->trace.tape[id];
    ValueId result = no_value;
    switch (value.op) {
      case Op::Pin:
        result = value_of_wire(graph_.wire(node, value.index));
        break;
      case Op::Cell:
        result = routine_.tape.leaf(Op::Cell, value.type, first_cell_[index] + value.index);
        break;
      case Op::SampleTime:
        result = routine_.tape.leaf(Op::SampleTime, Type::Real, node.rate.every);
        break;
      case Op::RealLiteral:
      case Op::IntLiteral:
      case Op::BoolLiteral:
      case Op::WordLiteral:
        result = routine_.tape.literal(value.op, value.literal);
        break;
      default: {
        std::array<ValueId, 3> args{no_value, no_value, no_value};
        for (std::size_t i = 0; i < args.size(); ++i) {
          if (value.args[i] != no_value) {
            args[i] = lay(index, value.args[i], laid);
          }
        }
        result = routine_.tape.apply(value.op, args[0], args[1], args[2]);
      }
    }
    return laid[id] = result;
  }

  [[nodiscard]] bool is_ahead(std::uint32_t output) const {
    return output < options_.outputs_ahead.size() && options_.outputs_ahead[output];
  }

  /// An output worked out once more, behind the assignments to all cells.
  ValueId value_ahead(const Wire& wire) {
    const BlockTrace& trace = graph_.nodes[wire.index].block->trace;
    routine_.tape.forget();
    std::vector<ValueId> laid(trace.tape.size(), no_value);
    return lay(wire.index, trace.outputs[wire.port], laid);
  }

  // --- actions ---

  void write_action(const Action& action) {
    const Node& node = graph_.nodes[action.node];
    const bool slow = node.rate != Rate{};
    routine_.tape.forget();
    if (slow) {
      routine_.step.push_back({.kind = Statement::Kind::BeginRate, .rate = node.rate});
      laid_[action.node].clear();  // what was computed in an earlier scope cannot be named here
    }
    routine_.step.push_back({.kind = Statement::Kind::Section, .target = action.node});
    if (node.block == nullptr) {
      write_operation(action.node);
    } else {
      std::vector<ValueId>& laid = laid_[action.node];
      if (laid.empty()) {
        laid.assign(node.block->trace.tape.size(), no_value);
      }
      if (action.kind != Action::Kind::Update) {
        write_outputs(action.node, laid);
      }
      if (action.kind != Action::Kind::Output) {
        write_update(action.node, laid);
        laid = {};
      }
    }
    if (slow) {
      routine_.step.push_back({.kind = Statement::Kind::EndRate});
    }
  }

  void write_operation(std::uint32_t index) {
    const Node& node = graph_.nodes[index];
    std::array<ValueId, 3> args{no_value, no_value, no_value};
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      args[pin] = value_of_wire(graph_.wire(node, pin));
    }
    const ValueId value = routine_.tape.apply(node.op, args[0], args[1], args[2]);
    set_output(index, 0, value, {}, false);
  }

  /// An output gets a name of its own; outputs of a slower part become cells.
  void set_output(std::uint32_t index, std::size_t port, ValueId value, std::string_view name, bool always_named) {
    const std::uint32_t output = first_output_[index] + static_cast<std::uint32_t>(port);
    if (held_[output] != unknown) {
      routine_.step.push_back({.kind = Statement::Kind::SetCell, .target = held_[output], .value = value});
      return;
    }
    outputs_[output] = value;
    const Op op = routine_.tape[value].op;
    const bool constant = is_literal(op) || op == Op::Input || op == Op::Parameter || op == Op::SampleTime;
    if (!constant) {
      if (always_named) {
        mark_defined(value);
      }
      routine_.step.push_back(
          {.kind = Statement::Kind::Define, .always = always_named, .target = index, .value = value, .field = name});
    }
  }

  void write_outputs(std::uint32_t index, std::vector<ValueId>& laid) {
    const Node& node = graph_.nodes[index];
    const BlockTrace& trace = node.block->trace;
    for (std::size_t port = 0; port < trace.outputs.size(); ++port) {
      if (outputs_[first_output_[index] + port] != unknown || !known(node, trace.feedthrough[port])) {
        continue;
      }
      set_output(index, port, lay(index, trace.outputs[port], laid), node.block->outputs[port].name, true);
    }
  }

  [[nodiscard]] bool known(const Node& node, PinSet pins) const {
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      const Wire& wire = graph_.wire(node, pin);
      if (pins.contains(pin) && wire.from == Wire::From::Node) {
        const std::uint32_t output = first_output_[wire.index] + wire.port;
        if (outputs_[output] == unknown && held_[output] == unknown) {
          return false;
        }
      }
    }
    return true;
  }

  void write_update(std::uint32_t index, std::vector<ValueId>& laid) {
    const Node& node = graph_.nodes[index];
    const BlockTrace& trace = node.block->trace;
    std::vector<Statement> sets;
    for (std::uint32_t state = 0; state < trace.next.size(); ++state) {
      if (trace.next[state] == no_value) {
        continue;
      }
      const ValueId value = lay(index, trace.next[state], laid);
      const std::uint32_t cell = first_cell_[index] + state;
      const Value& next = routine_.tape[value];
      if (next.op == Op::Cell && next.index == cell) {
        continue;  // does not change
      }
      sets.push_back({.kind = Statement::Kind::SetCell, .target = cell, .value = value});
    }
    for (const Store& store : trace.stores) {
      sets.push_back({.kind = Statement::Kind::StoreCell,
                      .target = first_cell_[index] + store.cell,
                      .value = lay(index, store.value, laid),
                      .index = store.index == no_value ? no_value : lay(index, store.index, laid)});
    }
    // A value that reads a cell which is set before it gets a name first, and with it those of the same vector.
    std::vector<bool> named(sets.size(), false);
    for (std::size_t later = 1; later < sets.size(); ++later) {
      bool reads_changed = false;
      for (std::size_t earlier = 0; earlier < later && !named[later]; ++earlier) {
        reads_changed = reads_changed || reads_cell(sets[later].value, sets[earlier].target) ||
                        (sets[later].index != no_value && reads_cell(sets[later].index, sets[earlier].target));
      }
      for (std::size_t i = 0; i < sets.size() && reads_changed; ++i) {
        if (!named[i] && (i == later || in_one_vector(sets[i], sets[later]))) {
          named[i] = true;
          name_first(index, sets[i].value, sets[i].target, "next");
          if (sets[i].index != no_value) {
            name_first(index, sets[i].index, sets[i].target, "place");
          }
        }
      }
    }
    routine_.step.insert(routine_.step.end(), sets.begin(), sets.end());
  }

  [[nodiscard]] bool in_one_vector(const Statement& a, const Statement& b) const {
    const auto one = element_of(routine_.cells[a.target].field.name);
    const auto other = element_of(routine_.cells[b.target].field.name);
    return one && other && one->vector == other->vector;
  }

  [[nodiscard]] bool defined(ValueId id) const { return id < defined_.size() && defined_[id]; }
  void mark_defined(ValueId id) {
    defined_.resize(routine_.tape.size(), false);
    defined_[id] = true;
  }

  void name_first(std::uint32_t node, ValueId value, std::uint32_t cell, std::string_view what) {
    if (!is_literal(routine_.tape[value].op)) {
      mark_defined(value);
      routine_.step.push_back({.kind = Statement::Kind::Define,
                               .always = true,
                               .target = node,
                               .value = value,
                               .field = routine_.cells[cell].field.name,
                               .what = what});
    }
  }

  bool reads_cell(ValueId root, std::uint32_t cell) {
    seen_.resize(routine_.tape.size(), 0);
    ++search_;
    std::vector<ValueId> stack{root};
    while (!stack.empty()) {
      const ValueId id = stack.back();
      stack.pop_back();
      if (seen_[id] == search_) {
        continue;
      }
      seen_[id] = search_;
      const Value& value = routine_.tape[id];
      if (value.op == Op::Cell && value.index == cell) {
        return true;
      }
      for (const ValueId arg : value.args) {
        if (arg != no_value && !defined(arg)) {
          stack.push_back(arg);
        }
      }
    }
    return false;
  }

  void write_reset() {
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      const Node& node = graph_.nodes[index];
      if (node.block == nullptr || node.block->states.empty()) {
        continue;
      }
      routine_.tape.forget();
      const BlockTrace& trace = node.block->trace;
      std::vector<ValueId> laid(trace.tape.size(), no_value);
      wired_parameters_at_reset(node, trace, laid);
      for (std::uint32_t state = 0; state < trace.initial.size(); ++state) {
        if (trace.initial[state] != no_value) {
          routine_.reset.push_back({.kind = Statement::Kind::SetCell,
                                    .target = first_cell_[index] + state,
                                    .value = lay(index, trace.initial[state], laid)});
        }
      }
      for (const Store& store : trace.initial_stores) {
        routine_.reset.push_back({.kind = Statement::Kind::StoreCell,
                                  .target = first_cell_[index] + store.cell,
                                  .value = lay(index, store.value, laid),
                                  .index = store.index == no_value ? no_value : lay(index, store.index, laid)});
      }
    }
    for (std::uint32_t cell = 0; cell < routine_.cells.size(); ++cell) {
      if (cell == routine_.counter && routine_.longest_period > 1) {
        routine_.reset.push_back(
            {.kind = Statement::Kind::SetCell, .target = cell, .value = routine_.tape.literal(Op::IntLiteral, 0)});
      } else if (routine_.cells[cell].held) {
        const Type type = routine_.cells[cell].field.type;
        const Op op = literal_op(type);
        routine_.reset.push_back(
            {.kind = Statement::Kind::SetCell, .target = cell, .value = routine_.tape.literal(op, 0)});
      }
    }
  }

  /// States that begin elsewhere than their block says.
  void write_initial_states() {
    for (const InitialState& given : graph_.initial_states) {
      const std::uint32_t cell = first_cell_[given.node] + given.state;
      std::erase_if(routine_.reset,
                    [&](const Statement& one) { return one.kind == Statement::Kind::SetCell && one.target == cell; });
      routine_.reset.push_back({.kind = Statement::Kind::SetCell,
                                .target = cell,
                                .value = routine_.tape.literal(Op::RealLiteral, given.value)});
    }
  }

  /// A parameter that is wired to a signal has no value at reset: it counts as 0, as in the interpreter.
  void wired_parameters_at_reset(const Node& node, const BlockTrace& trace, std::vector<ValueId>& laid) {
    for (ValueId id = 0; id < trace.tape.size(); ++id) {
      const Value& value = trace.tape[id];
      if (value.op != Op::Pin) {
        continue;
      }
      const auto from = graph_.wire(node, value.index).from;
      if (from == Wire::From::Node || from == Wire::From::Input) {
        const Op op = literal_op(value.type);
        laid[id] = routine_.tape.literal(op, 0);
      }
    }
  }

  const Program& program_;
  const Graph& graph_;
  RoutineOptions options_;
  Routine routine_;
  std::vector<std::uint32_t> first_cell_;
  std::vector<std::uint32_t> first_output_;
  std::vector<ValueId> outputs_;            ///< by output of any node
  std::vector<std::uint32_t> held_;         ///< by output: the cell that holds it between the steps of a slower rate
  std::vector<std::vector<ValueId>> laid_;  ///< by node: where the values of its trace are in the tape
  std::vector<bool> defined_;               ///< values that have a name by now: their cells were read before
  std::vector<std::uint32_t> seen_;         ///< by value: the last search that met it
  std::uint32_t search_ = 0;
};

}  // namespace

Routine make_routine(const Program& program, const RoutineOptions& options) {
  return RoutineBuilder(program, options).run();
}

bool has_infinite_parameter(const Graph& graph) {
  return std::ranges::any_of(graph.parameters, [](const Parameter& one) {
    return std::ranges::any_of(one.value, [](double value) { return !std::isfinite(value); });
  });
}

}  // namespace hysteron
