#include "diagnosis/evidence/tangent_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tuning/machine_dual.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t tangents_at_once = most_derivatives;
using Tangents = Dual<static_cast<int>(tangents_at_once)>;

}  // namespace

TangentRun::TangentRun(const Task& task, Program program, std::vector<std::string> states, std::string_view input)
    : task_(task), program_(std::move(program)), states_(std::move(states)) {
  const Graph& graph = program_.graph;
  input_ = static_cast<std::size_t>(find_port(graph.inputs, input) - graph.inputs.data());
  for (const std::string& name : task.outputs) {
    outputs_.push_back(static_cast<std::size_t>(find_port(graph.outputs, name) - graph.outputs.data()));
  }
  for (const Unknown& unknown : task.known) {
    known_.push_back(static_cast<std::size_t>(find_parameter(graph, unknown.path)));
  }
}

std::vector<std::string> TangentRun::states_of(const Graph& graph, bool& complete) {
  std::vector<std::string> result;
  complete = true;
  for (const Node& node : graph.nodes) {
    if (node.block == nullptr) {
      continue;
    }
    complete = complete && node.rate == Rate{} && node.block->fmu == nullptr;  // an FMU hides its states
    for (const Field& field : node.block->states) {
      complete = complete && field.length == 1;
      if (field.type == Type::Real && field.length == 1) {
        result.push_back(fmt::format("{}.{}", node.path, field.name));
      }
    }
  }
  return result;
}

template <class S, class Visit>
void TangentRun::run(std::size_t record, const Course* course, std::span<const Variable> seeded,
                     const Visit& visit) const {
  Diagnostics diagnostics;  // the record was read by this diagram before
  Program here = program_;
  settle_sample_time(task_.records[record], here, diagnostics);
  const Drive drive = drive_from(task_.records[record], here, {}, diagnostics);
  Machine<S> machine(here, drive.sample_time);
  const auto with_seed = [&](double value, Kind kind, std::size_t index) {
    if constexpr (!std::is_same_v<S, double>) {
      for (std::size_t lane = 0; lane < seeded.size(); ++lane) {
        if (seeded[lane].kind == kind && seeded[lane].index == index) {
          return S::variable(value, static_cast<int>(lane));
        }
      }
    }
    return S(value);
  };
  for (std::size_t j = 0; j < known_.size(); ++j) {
    machine.set_parameter(known_[j], with_seed(program_.graph.parameters[known_[j]].value.front(), Kind::Parameter, j));
  }
  machine.reset();
  std::vector<S*> states;
  for (const std::string& path : states_) {
    states.push_back(machine.real_state(path));
  }
  for (std::size_t step = 0; step < drive.steps; ++step) {
    const auto column = static_cast<Index>(step);
    for (std::size_t i = 0; course != nullptr && i < states.size(); ++i) {
      *states[i] = with_seed(course->states(static_cast<Index>(i), column), Kind::State, i);
    }
    for (std::size_t i = 0; i < drive.inputs.size(); ++i) {
      const double value = i == input_ && course != nullptr ? course->missing[column] : at_step(drive.inputs[i], step);
      machine.set_input(i, with_seed(value, Kind::Signal, i));
    }
    visit(machine, states, step, true);
    machine.step();
    visit(machine, states, step, false);
  }
}

TangentRun::Course TangentRun::free_run(std::size_t record) const {
  const auto steps = static_cast<Index>(task_.records[record].size());
  Course result{.states = MatrixXd(states(), steps), .missing = VectorXd::Zero(steps)};
  run<double>(record, nullptr, {}, [&](auto& /*machine*/, const auto& at, std::size_t step, bool before) {
    for (std::size_t i = 0; before && i < at.size(); ++i) {
      result.states(static_cast<Index>(i), static_cast<Index>(step)) = *at[i];
    }
  });
  return result;
}

TangentRun::Steps TangentRun::along(std::size_t record, const Course& course,
                                    std::span<const Variable> variables) const {
  const auto steps = static_cast<Index>(task_.records[record].size());
  const Index rows = states() + std::ssize(outputs_);
  const auto width = std::ssize(variables);
  Steps result{.values = MatrixXd(rows, steps), .slopes = MatrixXd(rows, steps * width)};
  for (std::size_t first = 0; first < variables.size(); first += tangents_at_once) {
    const auto seeded = variables.subspan(first, std::min(tangents_at_once, variables.size() - first));
    run<Tangents>(record, &course, seeded, [&](auto& machine, const auto& at, std::size_t step, bool before) {
      if (before) {
        return;
      }
      const auto column = static_cast<Index>(step);
      for (Index row = 0; row < rows; ++row) {
        const Tangents value = row < states() ? *at[static_cast<std::size_t>(row)]
                                              : machine.output(outputs_[static_cast<std::size_t>(row - states())]);
        result.values(row, column) = value.value();
        for (std::size_t lane = 0; lane < seeded.size(); ++lane) {
          result.slopes(row, column * width + static_cast<Index>(first + lane)) =
              value.derivative(static_cast<int>(lane));
        }
      }
    });
  }
  return result;
}

MatrixXd TangentRun::held(std::size_t record, std::size_t input) const {
  MatrixXd result(std::ssize(outputs_), static_cast<Index>(task_.records[record].size()));
  const Variable variable{.kind = Kind::Signal, .index = input};
  run<Tangents>(record, nullptr, {&variable, 1}, [&](auto& machine, const auto& /*at*/, std::size_t step, bool before) {
    for (std::size_t o = 0; !before && o < outputs_.size(); ++o) {
      result(static_cast<Index>(o), static_cast<Index>(step)) = machine.output(outputs_[o]).derivative(0);
    }
  });
  return result;
}

std::vector<Signal> TangentRun::wires_along(std::size_t record, const Course& course,
                                            const std::vector<Wire>& wires) const {
  std::vector<Signal> result(wires.size(), Signal(task_.records[record].size()));
  run<double>(record, &course, {}, [&](auto& machine, const auto& /*at*/, std::size_t step, bool before) {
    for (std::size_t i = 0; !before && i < wires.size(); ++i) {
      result[i][step] = machine.value(wires[i]);
    }
  });
  return result;
}

}  // namespace hysteron::diagnosis
