#include "diagnosis/evidence/summed_edge.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "codegen/parameters/apply.hpp"
#include "diagnosis/effects/insertion.hpp"
#include "diagnosis/evidence/tangent_run.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {
namespace {

/// Whether a way leads from one node to one of these outputs that does not lead over another node.
bool reaches(const Graph& graph, std::uint32_t from, std::uint32_t around, const std::vector<std::string>& outputs) {
  std::vector<bool> reached(graph.nodes.size(), false);
  reached[from] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
      for (std::size_t pin = 0; !reached[i] && i != around && pin < graph.nodes[i].wire_count; ++pin) {
        const Wire& wire = graph.wire(graph.nodes[i], pin);
        if (wire.from == Wire::From::Node && reached[wire.index]) {
          reached[i] = true;
          grown = true;
        }
      }
    }
  }
  return std::ranges::any_of(outputs, [&](const std::string& name) {
    const Wire& wire = find_port(graph.outputs, name)->wire;
    return wire.from == Wire::From::Node && reached[wire.index];
  });
}

std::uint32_t index_of(const Graph& graph, const std::string& instance) {
  return static_cast<std::uint32_t>(find_node(graph, instance) - graph.nodes.data());
}

bool is_of(const Edge& edge, const std::string& instance) {
  return edge.name.starts_with(instance + ".");
}

/// Whether what is added there comes to the outputs by states: what it does in the same step is little of what it does
/// in the end.
bool acts_through_states(const Task& task, const SummedEdge& edge) {
  bool complete = false;
  const std::vector<std::string> states = TangentRun::states_of(edge.program->graph, complete);
  if (!complete) {
    return false;
  }
  Program program = *edge.program;
  parameters::apply(task.file, program.graph);
  const TangentRun run(task, program, states, edge.input);
  const TangentRun::Variable added{.kind = TangentRun::Kind::Signal, .index = run.input()};
  const TangentRun::Course course = run.free_run(0);
  const MatrixXd at_once = run.along(0, course, {&added, 1}).slopes.bottomRows(std::ssize(task.outputs));
  const MatrixXd in_the_end = run.held(0, added.index);
  for (Index o = 0; o < at_once.rows(); ++o) {
    if (at_once.row(o).norm() > policy::at_once.value * in_the_end.row(o).norm()) {
      return false;
    }
  }
  return in_the_end.norm() > 0.0 && in_the_end.allFinite();
}

/// Whether every loop of the diagram leads over a node.
bool breaks_all_loops(const Graph& graph, std::uint32_t around) {
  std::vector<bool> done(graph.nodes.size(), false);
  done[around] = true;
  for (bool grown = true; grown;) {
    grown = false;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
      bool ready = !done[i];
      for (std::size_t pin = 0; ready && pin < graph.nodes[i].wire_count; ++pin) {
        const Wire& wire = graph.wire(graph.nodes[i], pin);
        ready = wire.from != Wire::From::Node || done[wire.index];
      }
      if (ready) {
        done[i] = true;
        grown = true;
      }
    }
  }
  return std::ranges::all_of(done, [](bool one) { return one; });
}

/// The fewest blocks with memory on a way from a node to one of these outputs.
std::size_t memories_between(const Graph& graph, std::uint32_t from, const std::vector<std::string>& outputs) {
  constexpr std::size_t far = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> fewest(graph.nodes.size(), far);
  fewest[from] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
      const std::size_t own = graph.nodes[i].block != nullptr && !graph.nodes[i].block->states.empty() ? 1 : 0;
      for (std::size_t pin = 0; i != from && pin < graph.nodes[i].wire_count; ++pin) {
        const Wire& wire = graph.wire(graph.nodes[i], pin);
        if (wire.from == Wire::From::Node && fewest[wire.index] != far && fewest[wire.index] + own < fewest[i]) {
          fewest[i] = fewest[wire.index] + own;
          changed = true;
        }
      }
    }
  }
  std::size_t result = far;
  for (const std::string& name : outputs) {
    const Wire& wire = find_port(graph.outputs, name)->wire;
    result = wire.from == Wire::From::Node ? std::min(result, fewest[wire.index]) : result;
  }
  return result;
}

}  // namespace

std::optional<SummedEdge> with_sum(const std::string& text, const Edge& edge, const std::string& top,
                                   const Variant& variant) {
  Diagnostics none;  // the text compiled before
  const language::SourceFile source = language::parse("text", text, none);
  const language::FunctionBlock& block = source.blocks[edge.definition];
  SummedEdge result{.edge = edge, .input = free_name(block, "MISSING"), .instance = free_name(block, "ADDED")};
  try {
    result.text = with_effect(source, edge,
                              {.block = "HY_SUM",
                               .instance = result.instance,
                               .input = "IN1",
                               .wires = {{"IN2", result.input}},
                               .new_input = result.input});
    Variant changed = variant;
    changed.text = result.text;
    result.program = compiled(changed, top);
  } catch (const InputError&) {
    return std::nullopt;
  }
  const Graph& graph = result.program->graph;
  const Node* const node = find_node(graph, result.instance);
  if (node == nullptr) {
    return std::nullopt;
  }
  result.before = graph.wire(*node, 0);
  return result;
}

std::optional<Bottleneck> bottleneck_of(const Task& task, const std::string& top, const Variant& variant,
                                        const std::vector<std::string>& driven, unsigned threads) {
  const std::vector<Edge> edges = edges_of_text(variant.text, top);
  std::vector<std::optional<Bottleneck>> found(edges.size());
  in_parallel(edges.size(), threads, [&](std::size_t i) {
    if (!edges[i].prefix.empty()) {
      return;
    }
    std::optional<SummedEdge> here = with_sum(variant.text, edges[i], top, variant);
    if (!here || !breaks_all_loops(here->program->graph, index_of(here->program->graph, here->instance)) ||
        !acts_through_states(task, *here)) {
      return;
    }
    Bottleneck result{.edge = std::move(*here)};
    std::size_t inputs = 0;
    for (const Edge& other : edges_of_text(result.edge.text, top)) {
      if (!other.prefix.empty() || is_of(other, result.edge.instance) ||
          language::same_name(other.name, result.edge.input)) {
        continue;
      }
      const bool is_driven =
          std::ranges::any_of(driven, [&](const std::string& name) { return language::same_name(name, other.name); });
      std::optional<SummedEdge> both = with_sum(result.edge.text, other, top, variant);
      if (!both) {
        continue;
      }
      const Graph& graph = both->program->graph;
      if (!reaches(graph, index_of(graph, both->instance), index_of(graph, result.edge.instance), task.outputs)) {
        result.behind_it.push_back(std::move(*both));
        inputs += is_driven ? 1 : 0;
      }
    }
    // That edge itself may be an input.
    inputs +=
        std::ranges::any_of(driven, [&](const std::string& name) { return language::same_name(name, edges[i].name); })
            ? 1
            : 0;
    if (inputs >= driven.size()) {
      found[i] = std::move(result);
    }
  });
  // Before as many integrals as can be, and of those with nothing but gains between them behind these.
  const auto rank = [&](const Bottleneck& one) {
    const Graph& graph = one.edge.program->graph;
    return std::pair(memories_between(graph, index_of(graph, one.edge.instance), task.outputs), one.behind_it.size());
  };
  std::optional<Bottleneck> best;
  for (std::optional<Bottleneck>& one : found) {
    if (one && (!best || rank(*one) > rank(*best))) {
      best = std::move(one);
    }
  }
  return best;
}

}  // namespace hysteron::diagnosis
