#include "diagnosis/evidence/missing_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnosis/effects/motions.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/search/start_states.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of the edge's range, the change of w from sample to sample, from rough to smooth in half decades.
constexpr int steps_tried = 11;
constexpr std::size_t samples_for_step = 6000;
/// A nonlinear diagram is linearised again about the course that was found.
constexpr int rounds = 3;

}  // namespace

LinearSystem MissingSpace::linearised(const TangentRun& run, std::size_t record,
                                      const TangentRun::Course& course) const {
  LinearSystem system{.states = run.states(), .outputs = std::ssize(task_.outputs)};
  std::vector<TangentRun::Variable> variables;
  for (Index i = 0; i < run.states(); ++i) {
    variables.push_back({.kind = TangentRun::Kind::State, .index = static_cast<std::size_t>(i)});
  }
  variables.push_back({.kind = TangentRun::Kind::Signal, .index = run.input()});
  TangentRun::Steps steps = run.along(record, course, variables);
  const Index z = run.states() + 1;
  system.constants = std::move(steps.values);
  system.a = std::move(steps.slopes);
  for (Index k = 0; k < system.constants.cols(); ++k) {
    const auto slopes = system.a.middleCols(k * z, z);
    system.constants.col(k) -= slopes.leftCols(z - 1) * course.states.col(k) + slopes.col(z - 1) * course.missing[k];
  }
  system.measured.resize(system.outputs, system.constants.cols());
  for (std::size_t o = 0; o < task_.outputs.size(); ++o) {
    const std::vector<double>& values = task_.records[record].column(task_.outputs[o]).values;
    system.measured.row(static_cast<Index>(o)) = Eigen::Map<const VectorXd>(values.data(), std::ssize(values));
  }
  system.noise.resize(system.outputs);
  for (Index o = 0; o < system.outputs; ++o) {
    const double deviation = noise_[static_cast<std::size_t>(o)];
    system.noise[o] = deviation * deviation;
  }
  return system;
}

std::unique_ptr<MissingSpace> MissingSpace::of_bottleneck(const Task& task, const std::string& top,
                                                          const Explanation& fitted,
                                                          const std::vector<std::string>& unused, unsigned threads) {
  // A parameter of one record alone has no slope over all of them.
  if (std::ranges::any_of(task.known, [](const Unknown& one) { return one.record.has_value(); })) {
    return nullptr;
  }
  std::vector<std::string> driven;
  for (const Port& input : fitted.variant.program->graph.inputs) {
    if (input.type == Type::Real && task.records.front().find(input.name) != nullptr) {
      driven.push_back(input.name);
    }
  }
  std::optional<Bottleneck> bottleneck = bottleneck_of(task, top, fitted.variant, driven, threads);
  if (!bottleneck) {
    return nullptr;
  }
  auto space = std::unique_ptr<MissingSpace>(new MissingSpace(task, std::move(*bottleneck)));
  return space->solve(fitted, unused, threads) ? std::move(space) : nullptr;
}

bool MissingSpace::solve(const Explanation& fitted, const std::vector<std::string>& unused, unsigned threads) {
  const VectorXd known = fitted.fit.x.head(std::ssize(task_.known));
  const Program program = with_values(task_, *bottleneck_.edge.program, known);
  bool complete = false;
  const std::vector<std::string> states = TangentRun::states_of(program.graph, complete);
  if (!complete || states.size() > 24) {
    return false;
  }
  const TangentRun run(task_, program, states, bottleneck_.edge.input);
  for (const std::string& output : task_.outputs) {
    RecordSignals values;
    for (const records::Record& record : task_.records) {
      values.push_back(record.column(output).values);
    }
    const Extent extent = extent_of(values, task_.records.front().sample_time());
    noise_.push_back(std::max(noise_of(values), 1e-9 * std::max(extent.range(), 1e-30)));
  }
  const std::size_t records = task_.records.size();
  std::vector<std::string> free = dynamic_states(program.graph);
  VectorXd ranges = VectorXd::Zero(std::ssize(states));
  scale_ = 0.0;
  for (std::size_t e = 0; e < records; ++e) {
    courses_.push_back(run.free_run(e));
    const Signal carried = run.wires_along(e, courses_.back(), {bottleneck_.edge.before}).front();
    const auto [low, high] = std::ranges::minmax(carried);
    scale_ = std::max({scale_, high - low, 1e-3 * std::abs(high)});
    ranges = ranges.cwiseMax(courses_.back().states.rowwise().maxCoeff() - courses_.back().states.rowwise().minCoeff());
  }
  if (!(scale_ > 0.0) || !std::isfinite(scale_) || !ranges.allFinite()) {
    return false;
  }
  const auto prepare = [&](std::size_t e) {
    LinearSystem system = linearised(run, e, courses_[e]);
    system.first = run.free_run(e).states.col(0);
    system.spread = VectorXd::Zero(std::ssize(states) + 1);
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (std::ranges::find(free, states[i]) != free.end()) {
        system.spread[static_cast<Index>(i)] = 10.0 * ranges[static_cast<Index>(i)];
      }
    }
    system.spread[std::ssize(states)] = 10.0 * scale_;
    return system;
  };
  for (int round = 0; round < rounds; ++round) {
    systems_.assign(records, {});
    in_parallel(records, threads, [&](std::size_t e) { systems_[e] = prepare(e); });
    if (round == 0) {
      LinearSystem part = systems_.front();
      const Index length = std::min<Index>(part.steps(), samples_for_step);
      part.measured = part.measured.leftCols(length).eval();
      double best = -std::numeric_limits<double>::infinity();
      for (int k = 0; k < steps_tried; ++k) {
        const double step = scale_ * std::pow(10.0, -0.5 * k);
        if (const double here = Smoother(part, step).log_likelihood(); here > best) {
          best = here;
          step_ = step;
        }
      }
      if (!(step_ > 0.0)) {
        return false;
      }
    }
    double moved = 0.0;
    smoothers_.clear();
    for (std::size_t e = 0; e < records; ++e) {
      smoothers_.emplace_back(systems_[e], step_);
      const MatrixXd found = smoothers_[e].smoothed();
      if (!found.allFinite()) {
        return false;
      }
      moved = std::max(moved, (found.bottomRows(1).transpose() - courses_[e].missing).norm() /
                                  std::max(found.bottomRows(1).norm(), 1e-300));
      courses_[e] = {.states = found.topRows(std::ssize(states)), .missing = found.bottomRows(1).transpose()};
    }
    if (round > 0 && moved < 1e-3) {
      break;
    }
  }
  // Signals along the courses.
  const Graph& graph = program.graph;
  std::vector<Wire> wires;
  const InnerSignals inner = inner_signals(task_, program);
  wires = inner.wires;
  InnerSignals listed = inner;
  for (const std::string& output : task_.outputs) {
    const Port& port = *find_port(graph.outputs, output);
    wires.push_back(port.wire);
    listed.names.push_back(port.name);
    listed.units.push_back(port.unit);
  }
  std::vector<RecordSignals> values(wires.size());
  std::vector<RecordSignals> deviations(wires.size());
  for (std::size_t e = 0; e < records; ++e) {
    std::vector<Signal> along = run.wires_along(e, courses_[e], wires);
    TangentRun::Course raised = courses_[e];
    raised.states += smoothers_[e].deviations().topRows(std::ssize(states));
    std::vector<Signal> raised_along = run.wires_along(e, raised, wires);
    for (std::size_t i = 0; i < wires.size(); ++i) {
      for (std::size_t k = 0; k < along[i].size(); ++k) {
        raised_along[i][k] = std::abs(raised_along[i][k] - along[i][k]);
      }
      deviations[i].push_back(std::move(raised_along[i]));
      values[i].push_back(std::move(along[i]));
    }
  }
  Task inputs_only = task_;
  inputs_only.outputs.clear();
  drivers_ = measured_signals(inputs_only, program, unused);
  add_inner(drivers_, listed, std::move(values), task_.records.front().sample_time(), std::move(deviations));

  Index rows = 0;
  for (const TangentRun::Course& course : courses_) {
    rows += course.missing.size();
  }
  missing_.resize(rows);
  known_.resize(rows, std::ssize(task_.known));
  Index row = 0;
  std::vector<TangentRun::Variable> parameters;
  for (std::size_t j = 0; j < task_.known.size(); ++j) {
    parameters.push_back({.kind = TangentRun::Kind::Parameter, .index = j});
  }
  for (std::size_t e = 0; e < records; ++e) {
    const Index steps = courses_[e].missing.size();
    missing_.segment(row, steps) = courses_[e].missing;
    const TangentRun::Steps slopes = run.along(e, courses_[e], parameters);
    for (Index j = 0; j < known_.cols(); ++j) {
      MatrixXd way(slopes.slopes.rows(), steps);
      for (Index k = 0; k < steps; ++k) {
        way.col(k) = slopes.slopes.col(k * known_.cols() + j);
      }
      known_.block(row, j, steps, 1) = smoothers_[e].missing_for(way, MatrixXd::Ones(steps, 1));
    }
    row += steps;
  }
  // A parameter that only scales what is needed there, a gain between it and the output, would make all gaps small.
  VectorXd needed(rows);
  Index begin = 0;
  for (std::size_t e = 0; e < records; ++e) {
    const Signal carried = run.wires_along(e, courses_[e], {bottleneck_.edge.before}).front();
    needed.segment(begin, std::ssize(carried)) =
        Eigen::Map<const VectorXd>(carried.data(), std::ssize(carried)) + courses_[e].missing;
    begin += std::ssize(carried);
  }
  constexpr double scales_alone = 0.999;
  for (Index j = 0; j < known_.cols(); ++j) {
    const double both = known_.col(j).dot(needed);
    if (both * both > scales_alone * known_.col(j).squaredNorm() * needed.squaredNorm()) {
      known_.col(j).setZero();
    }
  }
  // Places: the bottleneck itself, then what leads over it.
  const auto add_place = [&](const SummedEdge& edge, const std::string& input) {
    const Program there = with_values(task_, *edge.program, known);
    const TangentRun other(task_, there, states, bottleneck_.edge.input);
    const auto at = static_cast<std::size_t>(find_port(there.graph.inputs, input) - there.graph.inputs.data());
    Place place = place_of(task_, there, edge, fitted.variant.program->graph);
    const TangentRun::Variable variable{.kind = TangentRun::Kind::Signal, .index = at};
    ways_.emplace_back();
    for (std::size_t e = 0; e < records; ++e) {
      ways_.back().push_back(other.along(e, courses_[e], {&variable, 1}).slopes);
      place.carried.push_back(other.wires_along(e, courses_[e], {edge.before}).front());
    }
    places_.push_back(std::move(place));
  };
  add_place(bottleneck_.edge, bottleneck_.edge.input);
  for (const SummedEdge& edge : bottleneck_.behind_it) {
    add_place(edge, edge.input);
  }
  return missing_.allFinite() && known_.allFinite();
}

MatrixXd MissingSpace::of(std::size_t place, std::span<const RecordSignals> signals) const {
  MatrixXd result(missing_.size(), std::ssize(signals));
  constexpr Index together = 16;
  for (Index first = 0; first < std::ssize(signals); first += together) {
    const Index width = std::min(together, std::ssize(signals) - first);
    Index row = 0;
    for (std::size_t e = 0; e < systems_.size(); ++e) {
      const Index steps = courses_[e].missing.size();
      MatrixXd entering(steps, width);
      for (Index k = 0; k < width; ++k) {
        entering.col(k) = Eigen::Map<const VectorXd>(signals[static_cast<std::size_t>(first + k)][e].data(), steps);
      }
      result.block(row, first, steps, width) = smoothers_[e].missing_for(ways_[place][e], entering);
      row += steps;
    }
  }
  return result.allFinite() ? result : MatrixXd();
}

}  // namespace hysteron::diagnosis
