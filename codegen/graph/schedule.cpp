#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "codegen/graph/components.hpp"
#include "codegen/graph/loop_cutter.hpp"
#include "codegen/graph/outermost.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

constexpr auto none = std::numeric_limits<std::uint32_t>::max();

/// A part of a node's work that is done at once: some outputs, the update, or both.
struct Task {
  std::uint32_t node = 0;
  PinSet pins{};                     ///< the pins that must be known
  bool outputs = false;              ///< computes outputs
  bool update = false;               ///< moves the state on
  std::uint32_t after_first = none;  ///< tasks of the same node that must come before: [after_first, after_end)
  std::uint32_t after_end = none;
};

/// How finely a node's work is divided. Coarse is best for speed and reading; loops may need it finer.
enum class Division : std::uint8_t { Whole, Feedthrough, Ports };

class Scheduler {
 public:
  /// `places` is empty, or stands beside the wires.
  Scheduler(const Graph& graph, const OuterPlaces& places, Diagnostics& diagnostics)
      : graph_(graph), places_(places), diagnostics_(diagnostics) {
    first_output_.reserve(graph.nodes.size() + 1);
    std::uint32_t count = 0;
    for (const Node& node : graph.nodes) {
      first_output_.push_back(count);
      count += static_cast<std::uint32_t>(output_count(node));
    }
    provider_.resize(count);
  }

  Schedule run() {
    std::vector<Division> division(graph_.nodes.size(), Division::Whole);
    for (const Division finer : {Division::Feedthrough, Division::Ports}) {
      divide(division);
      find_loops();
      if (loops_.empty()) {
        break;
      }
      for (const auto& loop : loops_) {
        for (const std::uint32_t task : loop) {
          division[tasks_[task].node] = finer;
        }
      }
    }
    if (!loops_.empty()) {
      divide(division);
      find_loops();
    }
    if (!loops_.empty()) {
      for (const auto& loop : loops_) {
        report(loop);
      }
      return {};
    }
    return emit();
  }

 private:
  // --- tasks ---

  [[nodiscard]] PinSet connected(const Node& node, PinSet pins) const {
    PinSet result;
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      if (pins.contains(pin) && graph_.wire(node, pin).from == Wire::From::Node) {
        result.insert(pin);
      }
    }
    return result;
  }

  static PinSet all_pins(const Node& node) {
    PinSet pins;
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      pins.insert(pin);
    }
    return pins;
  }

  void divide(const std::vector<Division>& division) {
    tasks_.clear();
    first_task_.clear();
    for (std::uint32_t index = 0; index < graph_.nodes.size(); ++index) {
      first_task_.push_back(static_cast<std::uint32_t>(tasks_.size()));
      const Node& node = graph_.nodes[index];
      const auto own = [&](std::size_t port, std::size_t task) {
        provider_[first_output_[index] + port] = static_cast<std::uint32_t>(task);
      };
      if (node.block == nullptr) {
        own(0, tasks_.size());
        tasks_.push_back({.node = index, .pins = connected(node, all_pins(node)), .outputs = true});
        continue;
      }
      const BlockTrace& trace = node.block->trace;
      const bool memory = !node.block->states.empty();
      const auto first = static_cast<std::uint32_t>(tasks_.size());
      PinSet late;
      bool has_late = false;
      bool has_early = false;
      for (std::size_t port = 0; port < trace.outputs.size(); ++port) {
        const PinSet pins = connected(node, trace.feedthrough[port]);
        late |= pins;
        (pins.empty() ? has_early : has_late) = true;
      }
      if (has_early) {
        tasks_.push_back({.node = index, .outputs = true});
      }
      if (division[index] == Division::Ports) {
        for (std::size_t port = 0; port < trace.outputs.size(); ++port) {
          const PinSet pins = connected(node, trace.feedthrough[port]);
          own(port, pins.empty() ? first : tasks_.size());
          if (!pins.empty()) {
            tasks_.push_back({.node = index, .pins = pins, .outputs = true});
          }
        }
      } else {
        for (std::size_t port = 0; port < trace.outputs.size(); ++port) {
          own(port, connected(node, trace.feedthrough[port]).empty() ? first : tasks_.size());
        }
        if (has_late) {
          const bool whole = division[index] == Division::Whole && memory;
          tasks_.push_back({.node = index,
                            .pins = whole ? connected(node, all_pins(node)) : late,
                            .outputs = true,
                            .update = whole});
        }
      }
      const auto end = static_cast<std::uint32_t>(tasks_.size());
      if (memory && (end == first || !tasks_.back().update)) {
        tasks_.push_back({.node = index, .pins = connected(node, trace.update_pins), .update = true});
      }
      Task& last = tasks_.back();
      if (last.update) {
        last.after_first = first;
        last.after_end = static_cast<std::uint32_t>(tasks_.size() - 1);
      }
    }
  }

  /// Calls visit(task, pin) for all that a task depends on; pin is `none` for an earlier task of the same node.
  template <class Visit>
  void for_each_dependence(std::uint32_t index, Visit visit) const {
    const Task& task = tasks_[index];
    const Node& node = graph_.nodes[task.node];
    if (!task.pins.empty()) {
      for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
        if (task.pins.contains(pin)) {
          const Wire& wire = graph_.wire(node, pin);
          visit(provider_[first_output_[wire.index] + wire.port], pin);
        }
      }
    }
    for (std::uint32_t other = task.after_first; other < task.after_end; ++other) {
      visit(other, none);
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> dependences(std::uint32_t index) const {
    std::vector<std::uint32_t> list;
    for_each_dependence(index, [&](std::uint32_t task, std::uint32_t /*pin*/) { list.push_back(task); });
    return list;
  }

  // --- loops: tasks that need each other, or themselves ---

  void find_loops() {
    loops_.clear();
    std::vector<bool> to_itself(tasks_.size(), false);
    auto components = components_of(static_cast<std::uint32_t>(tasks_.size()), [&](std::uint32_t task) {
      std::vector<std::uint32_t> needed = dependences(task);
      to_itself[task] = std::ranges::find(needed, task) != needed.end();
      return needed;
    });
    for (std::vector<std::uint32_t>& loop : components) {
      if (loop.size() > 1 || to_itself[loop.front()]) {
        std::ranges::sort(loop);
        loops_.push_back(std::move(loop));
      }
    }
  }

  /// The shortest circle through the first task of a loop, as tasks each of which depends on the next.
  [[nodiscard]] std::vector<std::uint32_t> shortest_circle(const std::vector<std::uint32_t>& loop) const {
    const std::uint32_t start = loop.front();
    std::vector<std::uint32_t> came_from(tasks_.size(), none);
    std::vector<std::uint32_t> queue{start};
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (const std::uint32_t other : dependences(queue[head])) {
        if (other == start) {
          std::vector<std::uint32_t> circle;
          for (std::uint32_t task = queue[head]; task != start; task = came_from[task]) {
            circle.push_back(task);
          }
          circle.push_back(start);
          std::ranges::reverse(circle);
          return circle;
        }
        if (came_from[other] == none && std::ranges::binary_search(loop, other)) {
          came_from[other] = queue[head];
          queue.push_back(other);
        }
      }
    }
    return {start};
  }

  void report(const std::vector<std::uint32_t>& loop) {
    const auto circle = shortest_circle(loop);
    std::vector<std::string_view> owners;  // each once, where several operations of an expression follow each other
    struct Cut {
      OuterPlace place;
      std::string wire;
      bool inside = false;  ///< of one expression, where no delay can stand
    };
    std::vector<Cut> cuts;
    // Against the order of dependence, the way the signal flows.
    for (std::size_t i = circle.size(); i-- > 0;) {
      const Task& reader = tasks_[circle[i]];
      const std::uint32_t source = circle[(i + 1) % circle.size()];
      const Node& node = graph_.nodes[reader.node];
      for_each_dependence(circle[i], [&](std::uint32_t task, std::uint32_t pin) {
        if (task != source || pin == none || cuts.size() == circle.size()) {
          return;
        }
        const Wire& wire = graph_.wire(node, pin);
        const Node& from = graph_.nodes[wire.index];
        const std::uint32_t place = node.first_wire + pin;
        if (owners.empty() || owners.back() != from.owner()) {
          owners.push_back(from.owner());
        }
        cuts.push_back({places_.empty() ? OuterPlace{0, graph_.wire_spans[place]} : places_[place],
                        fmt::format("wire {} → {}: a {} here would cut the loop", output_name(from, wire.port),
                                    input_name(node, pin), loop_cutter),
                        node.block == nullptr && from.block == nullptr && node.owner() == from.owner()});
      });
    }
    if (owners.size() > 1 && owners.back() == owners.front()) {
      owners.pop_back();
    }
    owners.push_back(owners.empty() ? std::string_view() : owners.front());
    if (!std::ranges::all_of(cuts, &Cut::inside)) {
      std::erase_if(cuts, [](const Cut& cut) { return cut.inside; });
    }
    // A delay inside a block that is used twice would stand in both: only the outermost wires are shown.
    std::uint32_t outermost = none;
    for (const Cut& cut : cuts) {
      outermost = std::min(outermost, cut.place.level);
    }
    std::erase_if(cuts, [&](const Cut& cut) { return cut.place.level > outermost; });
    std::vector<Note> notes;
    notes.reserve(cuts.size());
    for (Cut& cut : cuts) {
      notes.push_back({graph_.place(cut.place.span), std::move(cut.wire)});
    }
    diagnostics_.error(
        error::algebraic_loop, graph_.place(cuts.empty() ? language::Span{} : cuts.front().place.span),
        fmt::format("algebraic loop: {}", fmt::join(owners, " → ")),
        fmt::format("Every value in this circle needs the others in the same step. Put a {} into one of its wires.",
                    loop_cutter),
        std::move(notes));
  }

  static std::string output_name(const Node& node, std::size_t port) {
    return node.block != nullptr ? fmt::format("{}.{}", node.path, node.block->outputs[port].name)
                                 : fmt::format("the expression of {}", node.owner());
  }
  static std::string input_name(const Node& node, std::size_t pin) {
    return node.block != nullptr ? fmt::format("{}.{}", node.path, node.block->pin(pin).name)
                                 : fmt::format("the expression of {}", node.owner());
  }

  // --- the order: depth first from the outputs, so that what is needed stands just before its use ---

  Schedule emit() {
    done_.assign(tasks_.size(), false);
    Schedule result;
    for (const Port& output : graph_.outputs) {
      if (output.wire.from == Wire::From::Node) {
        emit_from(provider_[first_output_[output.wire.index] + output.wire.port], result);
      }
    }
    for (std::uint32_t task = 0; task < tasks_.size(); ++task) {
      emit_from(task, result);
    }
    return result;
  }

  void emit_from(std::uint32_t root, Schedule& result) {
    struct Visit {
      std::uint32_t task;
      std::uint32_t next;
      std::vector<std::uint32_t> depends;
    };
    std::vector<Visit> stack;
    const auto enter = [&](std::uint32_t task) {
      if (!done_[task]) {
        done_[task] = true;
        stack.push_back({task, 0, dependences(task)});
      }
    };
    enter(root);
    while (!stack.empty()) {
      Visit& visit = stack.back();
      if (visit.next < visit.depends.size()) {
        enter(visit.depends[visit.next++]);
        continue;
      }
      act(visit.task, result);
      stack.pop_back();
    }
  }

  void act(std::uint32_t index, Schedule& result) {
    finished_.resize(tasks_.size(), false);
    finished_[index] = true;
    const Task& task = tasks_[index];
    if (task.update) {
      if (!updated_early_.empty() && updated_early_[task.node]) {
        return;
      }
      result.actions.push_back({task.outputs ? Action::Kind::Step : Action::Kind::Update, task.node});
      return;
    }
    // The last outputs of a node whose update could follow at once: one action instead of two.
    const Node& node = graph_.nodes[task.node];
    if (node.block == nullptr || node.block->states.empty()) {
      result.actions.push_back({Action::Kind::Step, task.node});
      return;
    }
    const std::uint32_t last = last_task(task.node);
    bool ready = tasks_[last].update && last != index;
    if (ready) {
      // What the update reads of this very task is known only behind it: a delay that is wired to itself.
      for_each_dependence(last, [&](std::uint32_t other, std::uint32_t pin) {
        ready = ready && finished_[other] && (other != index || pin == none);
      });
    }
    if (ready) {
      updated_early_.resize(graph_.nodes.size(), false);
      updated_early_[task.node] = true;
      done_[last] = true;
      finished_[last] = true;
      result.actions.push_back({Action::Kind::Step, task.node});
    } else {
      result.actions.push_back({Action::Kind::Output, task.node});
    }
  }

  [[nodiscard]] std::uint32_t last_task(std::uint32_t node) const {
    return (node + 1 < first_task_.size() ? first_task_[node + 1] : static_cast<std::uint32_t>(tasks_.size())) - 1;
  }

  const Graph& graph_;
  const OuterPlaces& places_;
  Diagnostics& diagnostics_;
  std::vector<std::uint32_t> first_output_;  ///< by node, into provider_
  std::vector<std::uint32_t> provider_;      ///< by output of any node: the task that computes it
  std::vector<std::uint32_t> first_task_;
  std::vector<Task> tasks_;
  std::vector<std::vector<std::uint32_t>> loops_;
  std::vector<bool> done_;
  std::vector<bool> finished_;
  std::vector<bool> updated_early_;
};

}  // namespace

Schedule schedule(const Graph& graph, const OuterPlaces& places, Diagnostics& diagnostics) {
  return Scheduler(graph, places, diagnostics).run();
}

Schedule schedule(const Graph& graph, Diagnostics& diagnostics) {
  return schedule(graph, {}, diagnostics);
}

bool has_feedthrough(const Graph& graph, const Node& node, std::size_t output) {
  for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
    const bool depends = node.block == nullptr || node.block->trace.feedthrough[output].contains(pin);
    const auto from = graph.wire(node, pin).from;
    if (depends && (from == Wire::From::Node || from == Wire::From::Input)) {
      return true;
    }
  }
  return false;
}

std::vector<bool> outputs_with_feedthrough(const Graph& graph) {
  // Depth first over outputs of nodes: does any path within the step end at an input?
  std::vector<std::uint32_t> first;
  std::uint32_t count = 0;
  for (const Node& node : graph.nodes) {
    first.push_back(count);
    count += static_cast<std::uint32_t>(output_count(node));
  }
  enum class Mark : std::uint8_t { New, No, Yes };
  std::vector<Mark> marks(count, Mark::New);
  struct Visit {
    std::uint32_t node;
    std::uint16_t port;
    std::uint32_t pin;
  };
  const auto search = [&](const Wire& from) {
    if (from.from != Wire::From::Node) {
      return from.from == Wire::From::Input;
    }
    std::vector<Visit> stack{{from.index, from.port, 0}};
    marks[first[from.index] + from.port] = marks[first[from.index] + from.port] == Mark::Yes ? Mark::Yes : Mark::No;
    while (!stack.empty()) {
      auto& [index, port, pin] = stack.back();
      const Node& node = graph.nodes[index];
      Mark& mark = marks[first[index] + port];
      if (mark == Mark::Yes || pin == node.wire_count) {
        const bool yes = mark == Mark::Yes;
        stack.pop_back();
        if (yes && !stack.empty()) {
          marks[first[stack.back().node] + stack.back().port] = Mark::Yes;
        }
        continue;
      }
      const std::uint32_t at = pin++;
      if (node.block != nullptr && !node.block->trace.feedthrough[port].contains(at)) {
        continue;
      }
      const Wire& wire = graph.wire(node, at);
      if (wire.from == Wire::From::Input) {
        mark = Mark::Yes;
      } else if (wire.from == Wire::From::Node) {
        Mark& other = marks[first[wire.index] + wire.port];
        if (other == Mark::Yes) {
          mark = Mark::Yes;
        } else if (other == Mark::New) {
          other = Mark::No;
          stack.push_back({wire.index, wire.port, 0});
        }
      }
    }
    return marks[first[from.index] + from.port] == Mark::Yes;
  };
  std::vector<bool> result;
  for (const Port& output : graph.outputs) {
    result.push_back(search(output.wire));
  }
  return result;
}

}  // namespace hysteron
