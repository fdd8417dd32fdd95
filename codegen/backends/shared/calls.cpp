#include "codegen/backends/shared/calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "codegen/graph/loop_cutter.hpp"
#include "codegen/graph/text_order.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

constexpr std::uint32_t none = no_value;

class CallBuilder {
 public:
  explicit CallBuilder(const Program& program) : graph_(program.graph) {}

  CallRoutine run() {
    refuse_initial_states();
    place_cells();
    find_settings();
    for (const BlockInstance& one : made_.instances) {
      write_reset_call(one.node);
    }
    reset_cells();
    routine().tape.forget();
    const auto first_of_step = static_cast<ValueId>(routine().tape.size());
    sort();
    write_copies();
    for (const Task& task : order_) {
      if (task.is_output) {
        routine().step.push_back({.kind = Statement::Kind::SetOutput,
                                  .target = task.index,
                                  .value = value_of_wire(graph_.outputs[task.index].wire)});
      } else {
        write_node(task.index);
      }
    }
    finish_routine(routine(), first_of_step);
    return std::move(made_);
  }

 private:
  /// A call of a block, an operation, or an assignment to an output.
  struct Task {
    bool is_output = false;
    std::uint32_t index = 0;
  };

  Routine& routine() { return made_.routine; }
  [[nodiscard]] std::uint32_t output_of(const Wire& wire) const { return first_output_[wire.index] + wire.port; }

  void refuse_initial_states() {
    Diagnostics diagnostics;
    for (const InitialState& given : graph_.initial_states) {
      const Node& node = graph_.nodes[given.node];
      diagnostics.error(error::no_network, graph_.place(node.span),
                        fmt::format("{}.{} begins where the parameter file says, and {} has no input for it", node.path,
                                    node.block->states[given.state].name, node.block->about.name),
                        "Leave out --structured, or leave out this line of [initial].");
    }
    if (diagnostics.has_errors()) {
      throw InputError(std::move(diagnostics));
    }
  }

  // --- what lives from step to step ---

  void place_cells() {
    const auto add = [&](std::uint32_t index, std::size_t port, bool held) {
      const Node& node = graph_.nodes[index];
      CellInfo cell{.instance = node.path, .node = index, .held = held};
      cell.field.name = node.block != nullptr ? node.block->outputs[port].name : std::string_view("VALUE");
      cell.field.type = output_type(node, port);
      cell.field.meaning = held ? "last value" : "";
      routine().cells.push_back(cell);
    };
    std::uint32_t outputs = 0;
    for (const Node& node : graph_.nodes) {
      first_output_.push_back(outputs);
      outputs += static_cast<std::uint32_t>(output_count(node));
    }
    outputs_.assign(outputs, no_value);
    cells_.assign(outputs, none);
    held_.assign(outputs, none);
    ahead_.assign(outputs, false);
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      const Node& node = graph_.nodes[index];
      if (node.block == nullptr) {
        continue;
      }
      BlockInstance instance{.node = index};
      for (std::size_t port = 0; port < output_count(node); ++port) {
        cells_[first_output_[index] + port] = static_cast<std::uint32_t>(routine().cells.size());
        ahead_[first_output_[index] + port] = is_remembered(graph_, node, port);
        instance.ahead.push_back(ahead_[first_output_[index] + port]);
        add(index, port, false);
      }
      made_.instances.push_back(std::move(instance));
    }
    made_.output_cells = static_cast<std::uint32_t>(routine().cells.size());
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      const Node& node = graph_.nodes[index];
      routine().longest_period = std::lcm(routine().longest_period, node.rate.every);
      for (std::size_t port = 0; node.rate != Rate{} && port < output_count(node); ++port) {
        held_[first_output_[index] + port] = static_cast<std::uint32_t>(routine().cells.size());
        add(index, port, true);
      }
    }
    add_counter(routine());
  }

  void reset_cells() {
    for (auto cell = made_.output_cells; cell < routine().cells.size(); ++cell) {
      routine().reset.push_back({.kind = Statement::Kind::SetCell,
                                 .target = cell,
                                 .value = routine().tape.literal(literal_op(routine().cells[cell].field.type), 0.0)});
    }
  }

  /// A parameter that belongs to one pin of one instance, and to nothing else, stands with its declaration.
  void find_settings() {
    std::vector<std::uint32_t> readers(graph_.parameters.size(), 0);
    const auto count = [&](const Wire& wire) {
      if (wire.from == Wire::From::Parameter) {
        ++readers[wire.index];
      }
    };
    std::ranges::for_each(graph_.wires, count);
    std::ranges::for_each(graph_.outputs, [&](const Port& port) { count(port.wire); });
    made_.is_setting.assign(graph_.parameters.size(), false);
    for (BlockInstance& one : made_.instances) {
      const Node& node = graph_.nodes[one.node];
      for (auto pin = static_cast<std::uint32_t>(node.block->inputs.size()); pin < node.wire_count; ++pin) {
        const Wire& wire = graph_.wire(node, pin);
        if (node.block->pin(pin).length > 1) {
          one.array_pins.push_back(pin);
        } else if (wire.from == Wire::From::Parameter && readers[wire.index] == 1 &&
                   language::same_name(graph_.parameters[wire.index].path,
                                       fmt::format("{}.{}", node.path, node.block->pin(pin).name))) {
          one.settings.push_back(wire.index);
          made_.is_setting[wire.index] = true;
        }
      }
    }
  }

  // --- the order of calls ---

  /// What must stand before a reader: the call, or the operation, that makes its value. A block that remembers it has
  /// it already.
  [[nodiscard]] std::uint32_t needed_by(const Wire& wire) const {
    return wire.from == Wire::From::Node && !ahead_[output_of(wire)] ? wire.index : none;
  }

  /// Outputs first, then the rest; last those blocks whose memory others read in the step: before their call.
  void sort() {
    done_.assign(graph_.nodes.size(), false);
    open_.assign(graph_.nodes.size(), false);
    std::vector<bool> late(graph_.nodes.size(), false);
    for (const BlockInstance& one : made_.instances) {
      late[one.node] = std::ranges::find(one.ahead, true) != one.ahead.end();
    }
    for (std::uint32_t i = 0; i < graph_.outputs.size(); ++i) {
      if (const std::uint32_t node = needed_by(graph_.outputs[i].wire); node != none) {
        visit(node);
      }
      order_.push_back({.is_output = true, .index = i});
    }
    for (const bool now : {false, true}) {
      for (std::uint32_t node = 0; node < graph_.nodes.size(); ++node) {
        if (late[node] == now) {
          visit(node);
        }
      }
    }
  }

  /// Depth first, without recursion: chains of operations are long.
  void visit(std::uint32_t root) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack;  // a node, and its next pin
    const auto enter = [&](std::uint32_t node) {
      if (open_[node]) {
        refuse_circle(node);
      }
      if (!done_[node]) {
        open_[node] = true;
        stack.emplace_back(node, 0);
      }
    };
    enter(root);
    while (!stack.empty()) {
      auto& [index, pin] = stack.back();
      const Node& node = graph_.nodes[index];
      if (pin < node.wire_count) {
        if (const std::uint32_t before = needed_by(graph_.wire(node, pin++)); before != none) {
          enter(before);
        }
        continue;
      }
      open_[index] = false;
      done_[index] = true;
      order_.push_back({.index = index});
      stack.pop_back();
    }
  }

  [[noreturn]] void refuse_circle(std::uint32_t node) const {
    const auto is_block = [&](std::uint32_t one) { return graph_.nodes[one].block != nullptr; };
    std::uint32_t named = node;
    for (std::uint32_t one = 0; one < graph_.nodes.size() && !is_block(named); ++one) {
      named = open_[one] && is_block(one) ? one : named;
    }
    Diagnostics diagnostics;
    diagnostics.error(error::no_network, graph_.place(graph_.nodes[named].span),
                      fmt::format("an input of {} waits for an output of the same block in the same step, so no single "
                                  "call computes both",
                                  graph_.nodes[named].owner()),
                      fmt::format("Leave out --structured, or put a {} into the wire between them.", loop_cutter));
    throw InputError(std::move(diagnostics));
  }

  // --- memory that is read behind its call ---

  /// An output of memory is copied before the step where something reads it behind the call, which moves it on.
  void write_copies() {
    std::vector<std::size_t> at(graph_.nodes.size(), 0);
    std::vector<std::size_t> latest(outputs_.size(), 0);  // by output: the last place that reads it
    const auto read = [&](const Wire& wire, std::size_t place) {
      if (wire.from == Wire::From::Node) {
        latest[output_of(wire)] = std::max(latest[output_of(wire)], place);
      }
    };
    for (std::size_t place = order_.size(); place-- > 0;) {
      const Task& task = order_[place];
      if (task.is_output) {
        read(graph_.outputs[task.index].wire, place);
        continue;
      }
      at[task.index] = place;
      const Node& node = graph_.nodes[task.index];
      const bool in_place = node.block == nullptr && held_[first_output_[task.index]] == none;
      // An operation may be written where its value is used, which is later.
      const std::size_t reads_at = in_place ? std::max(place, latest[first_output_[task.index]]) : place;
      for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
        read(graph_.wire(node, pin), reads_at);
      }
    }
    for (const BlockInstance& one : made_.instances) {
      const Rate rate = graph_.nodes[one.node].rate;
      for (std::uint32_t port = 0; port < one.ahead.size(); ++port) {
        const std::uint32_t output = first_output_[one.node] + port;
        if (!one.ahead[port]) {
          continue;
        }
        outputs_[output] = leaf_of(output);
        if (held_[output] != none) {
          routine().step.push_back({.kind = Statement::Kind::BeginRate, .rate = rate});
          routine().step.push_back(
              {.kind = Statement::Kind::SetCell, .target = held_[output], .value = outputs_[output]});
          routine().step.push_back({.kind = Statement::Kind::EndRate});
        } else if (latest[output] > at[one.node]) {
          routine().step.push_back({.kind = Statement::Kind::Define,
                                    .always = true,
                                    .target = one.node,
                                    .value = outputs_[output],
                                    .field = graph_.nodes[one.node].block->outputs[port].name});
        }
      }
    }
  }

  // --- values and statements ---

  ValueId leaf_of(std::uint32_t output) {
    return routine().tape.leaf(Op::Cell, routine().cells[cells_[output]].field.type, cells_[output]);
  }

  ValueId value_of_wire(const Wire& wire) {
    Tape& tape = routine().tape;
    switch (wire.from) {
      case Wire::From::Literal:
        return tape.literal(literal_op(wire.type), graph_.literals[wire.index]);
      case Wire::From::Parameter:
        return tape.leaf(Op::Parameter, wire.type, wire.index);
      case Wire::From::Input:
        return tape.leaf(Op::Input, wire.type, wire.index);
      default:
        return held_[output_of(wire)] != none ? tape.leaf(Op::Cell, wire.type, held_[output_of(wire)])
                                              : outputs_[output_of(wire)];
    }
  }

  /// Whether a pin has what the block takes by itself where nothing is connected.
  [[nodiscard]] bool is_left_open(const Field& field, const Wire& wire) const {
    return wire.from == Wire::From::Literal && !field.required &&
           std::bit_cast<std::uint64_t>(graph_.literals[wire.index]) == std::bit_cast<std::uint64_t>(field.preset);
  }

  void add_call(std::uint32_t index, std::vector<Statement>& list, bool reset) {
    const Node& node = graph_.nodes[index];
    Statement statement{.kind = Statement::Kind::Call, .target = index};
    statement.first_argument = static_cast<std::uint32_t>(routine().arguments.size());
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      const Wire& wire = graph_.wire(node, pin);
      const bool setting = wire.from == Wire::From::Parameter && made_.is_setting[wire.index];
      const bool signal = wire.from == Wire::From::Node || wire.from == Wire::From::Input;
      if (setting || is_left_open(node.block->pin(pin), wire) || (reset && signal && pin < node.block->inputs.size())) {
        continue;
      }
      // A parameter that is wired to a signal has no value at reset: it counts as 0, as in the interpreter.
      routine().arguments.push_back(
          {.pin = pin,
           .value = reset && signal ? routine().tape.literal(literal_op(wire.type), 0.0) : value_of_wire(wire)});
    }
    statement.argument_count = static_cast<std::uint32_t>(routine().arguments.size()) - statement.first_argument;
    list.push_back(statement);
  }

  void write_reset_call(std::uint32_t index) {
    if (!graph_.nodes[index].block->states.empty()) {
      add_call(index, routine().reset, true);
    }
  }

  void write_node(std::uint32_t index) {
    const Node& node = graph_.nodes[index];
    const bool slow = node.rate != Rate{};
    routine().tape.forget();
    if (slow) {
      routine().step.push_back({.kind = Statement::Kind::BeginRate, .rate = node.rate});
    }
    routine().step.push_back({.kind = Statement::Kind::Section, .target = index});
    if (node.block == nullptr) {
      std::array<ValueId, 3> args{no_value, no_value, no_value};
      for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
        args[pin] = value_of_wire(graph_.wire(node, pin));
      }
      set_output(index, 0, routine().tape.apply(node.op, args[0], args[1], args[2]));
    } else {
      add_call(index, routine().step, false);
      for (std::uint32_t port = 0; port < output_count(node); ++port) {
        if (!ahead_[first_output_[index] + port]) {
          set_output(index, port, leaf_of(first_output_[index] + port));
        }
      }
    }
    if (slow) {
      routine().step.push_back({.kind = Statement::Kind::EndRate});
    }
    routine().tape.forget();
  }

  void set_output(std::uint32_t index, std::uint32_t port, ValueId value) {
    const std::uint32_t output = first_output_[index] + port;
    if (held_[output] != none) {
      routine().step.push_back({.kind = Statement::Kind::SetCell, .target = held_[output], .value = value});
      return;
    }
    outputs_[output] = value;
    if (!is_leaf(routine().tape[value].op)) {
      routine().step.push_back({.kind = Statement::Kind::Define, .target = index, .value = value});
    }
  }

  const Graph& graph_;
  CallRoutine made_;
  std::vector<std::uint32_t> first_output_;
  std::vector<ValueId> outputs_;      ///< by output of any node: its value, where it has one by now
  std::vector<std::uint32_t> cells_;  ///< by output of a block: what it is called
  std::vector<std::uint32_t> held_;   ///< by output of a slower part: what holds it
  std::vector<bool> ahead_;           ///< by output
  std::vector<Task> order_;
  std::vector<bool> done_;
  std::vector<bool> open_;
};

}  // namespace

CallRoutine make_calls(const Program& program) {
  return CallBuilder(program).run();
}

}  // namespace hysteron
