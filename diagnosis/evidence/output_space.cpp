#include "diagnosis/evidence/output_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/parameters/apply.hpp"
#include "diagnosis/effects/motions.hpp"
#include "diagnosis/evidence/roles.hpp"
#include "diagnosis/model/parallel.hpp"
#include "tuning/machine_dual.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t lanes = most_derivatives;
using Lanes = Dual<static_cast<int>(lanes)>;

}  // namespace

Program with_values(const Task& task, const Program& program, const VectorXd& known) {
  Program result = program;
  parameters::apply(task.file, result.graph);
  for (std::size_t j = 0; j < task.known.size(); ++j) {
    set_parameter(result.graph, task.known[j].path, known[static_cast<Index>(j)]);
  }
  return result;
}

bool is_port(const Graph& graph, const Edge& edge) {
  const auto is_named = [&](const Port& port) {
    return language::same_name(edge.name, port.name) ||
           std::ranges::any_of(edge.aliases,
                               [&](const std::string& alias) { return language::same_name(alias, port.name); });
  };
  return std::ranges::any_of(graph.inputs, is_named) || std::ranges::any_of(graph.outputs, is_named);
}

Space::Place place_of(const Task& task, const Program& there, const SummedEdge& edge, const Graph& graph) {
  const std::vector<std::vector<std::string>> units = units::Solution(there.graph, there.schedule).outputs();
  const auto sum = find_node(there.graph, edge.instance) - there.graph.nodes.data();
  const auto unit_of = [&](const Wire& wire) -> std::string {
    if (wire.from == Wire::From::Input) {
      return there.graph.inputs[wire.index].unit;
    }
    const bool has_unit = wire.from == Wire::From::Node && wire.port < units[wire.index].size();
    return has_unit ? units[wire.index][wire.port] : std::string();
  };
  const auto is_motion = [](const std::string& unit) {
    const Quantity quantity = quantity_of(unit);
    return quantity.position || quantity.velocity;
  };
  const bool asks_for_motion = std::ranges::any_of(
      task.outputs, [&](const std::string& output) { return is_motion(find_port(graph.outputs, output)->unit); });
  const Port* const input = followed_input(there.graph, edge.before);
  const bool is_given = !asks_for_motion && input != nullptr && is_motion(input->unit);
  return {.edge = edge.edge,
          .unit = units[static_cast<std::size_t>(sum)].front(),
          .is_port = is_port(graph, edge.edge),
          .is_integral = is_integral(there.graph, edge.before),
          .is_balance = is_balance(there.graph, edge.before, edge.instance),
          .is_of_velocity = quantity_of(unit_of(without_gains(there.graph, edge.before))).velocity,
          .is_given_motion = is_given,
          .is_differentiated = is_given && leads_to_rates(there.graph, edge.instance)};
}

OutputSpace::OutputSpace(const Task& task, const std::string& top, const Explanation& fitted,
                         const std::vector<std::string>& unused, unsigned threads)
    : task_(task), fitted_(fitted) {
  const std::vector<Edge> edges = edges_of_text(fitted.variant.text, top);
  const VectorXd known = fitted.fit.x.head(std::ssize(task.known));
  std::vector<std::optional<SummedEdge>> added(edges.size());
  std::vector<Place> places(edges.size());
  in_parallel(edges.size(), threads, [&](std::size_t i) {
    if (!edges[i].prefix.empty()) {
      return;
    }
    added[i] = with_sum(fitted.variant.text, edges[i], top, fitted.variant);
    if (!added[i] || added[i]->before.from == Wire::From::Nothing) {
      added[i].reset();
      return;
    }
    places[i] = place_of(task, *added[i]->program, *added[i], fitted.variant.program->graph);
    places[i].carried = wire_signals(task, *added[i]->program, {added[i]->before}, known).front();
  });
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (added[i]) {
      places_.push_back(std::move(places[i]));
      added_.push_back(std::move(*added[i]));
    }
  }
  // As the diagram runs: a measured output that drives a law would explain itself.
  const Program& program = *fitted.variant.program;
  Task inputs_only = task;
  inputs_only.outputs.clear();
  drivers_ = measured_signals(inputs_only, program, unused);
  InnerSignals inner = inner_signals(task, program);
  for (const std::string& output : task.outputs) {
    const Port& port = *find_port(program.graph.outputs, output);
    inner.wires.push_back(port.wire);
    inner.names.push_back(port.name);
    inner.units.push_back(port.unit);
  }
  add_inner(drivers_, inner, wire_signals(task, program, inner.wires, known), task.records.front().sample_time());
}

MatrixXd OutputSpace::of(std::size_t place, std::span<const RecordSignals> signals) const {
  const SummedEdge& added = added_[place];
  const Program program = with_values(task_, *added.program, fitted_.fit.x.head(std::ssize(task_.known)));
  const Graph& graph = program.graph;
  const auto input = static_cast<std::size_t>(find_port(graph.inputs, added.input) - graph.inputs.data());
  std::vector<std::size_t> outputs;
  for (const std::string& name : task_.outputs) {
    outputs.push_back(static_cast<std::size_t>(find_port(graph.outputs, name) - graph.outputs.data()));
  }
  Index rows = 0;
  for (const records::Record& record : task_.records) {
    rows += static_cast<Index>(record.size());
  }
  MatrixXd result(rows * std::ssize(task_.outputs), std::ssize(signals));
  const Index first_state = std::ssize(task_.known) + std::ssize(fitted_.variant.further);
  for (std::size_t begin = 0; begin < signals.size(); begin += lanes) {
    const std::size_t width = std::min(lanes, signals.size() - begin);
    Index first = 0;
    for (std::size_t e = 0; e < task_.records.size(); ++e) {
      Diagnostics diagnostics;  // the record was read by this diagram before
      Program here = program;
      settle_sample_time(task_.records[e], here, diagnostics);
      const Drive drive = drive_from(task_.records[e], here, {}, diagnostics);
      Machine<Lanes> machine(here, drive.sample_time);
      machine.reset();
      for (std::size_t s = 0; s < task_.initial_states.size(); ++s) {
        const auto at = first_state + static_cast<Index>(e * task_.initial_states.size() + s);
        if (at < fitted_.fit.x.size()) {
          *machine.real_state(task_.initial_states[s]) = Lanes(fitted_.fit.x[at]);
        }
      }
      for (std::size_t step = 0; step < drive.steps; ++step) {
        for (std::size_t i = 0; i < drive.inputs.size(); ++i) {
          if (i != input && (step == 0 || drive.inputs[i].size() > 1)) {
            machine.set_input(i, Lanes(at_step(drive.inputs[i], step)));
          }
        }
        Lanes::Gradient seeds{};
        for (std::size_t k = 0; k < width; ++k) {
          seeds[k] = signals[begin + k][e][step];
        }
        machine.set_input(input, Lanes(0.0, seeds));
        machine.step();
        for (std::size_t o = 0; o < outputs.size(); ++o) {
          const Lanes y = machine.output(outputs[o]);
          const double scale = task_.scales.empty() ? 1.0 : task_.scales[o];
          const Index row = static_cast<Index>(o) * rows + first + static_cast<Index>(step);
          for (std::size_t k = 0; k < width; ++k) {
            result(row, static_cast<Index>(begin + k)) = y.derivative(static_cast<int>(k)) / scale;
          }
        }
      }
      first += static_cast<Index>(drive.steps);
    }
  }
  for (const Index row : task_.left_out) {
    result.row(row).setZero();
  }
  return result.allFinite() ? result : MatrixXd();
}

}  // namespace hysteron::diagnosis
