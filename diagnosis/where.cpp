#include "diagnosis/where.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/candidates.hpp"
#include "diagnosis/insertion.hpp"
#include "diagnosis/parallel.hpp"
#include "diagnosis/screening.hpp"
#include "diagnosis/signals.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double same_direction = 10.0 * std::numbers::pi / 180.0;

/// The signals that are added to an edge, from the signal on it.
std::vector<RecordSignals> probes_of(const RecordSignals& signal, double sample_time) {
  const Extent extent = extent_of(signal, sample_time);
  const double range = extent.range() > 0.0 ? extent.range() : 1.0;
  const double middle = 0.5 * (extent.low + extent.high);
  const double fastest = extent.rates[99] > 0.0 ? extent.rates[99] * sample_time : range;
  std::vector<RecordSignals> probes(9, signal);
  for (std::size_t e = 0; e < signal.size(); ++e) {
    const std::vector<double>& x = signal[e];
    double slow = x.front();
    double rate = 0.0;
    const double slowness = 1.0 / std::max(10.0, 0.05 * static_cast<double>(x.size()));
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double u = 2.0 * (x[k] - middle) / range;
      rate += 0.3 * ((k > 0 ? x[k] - x[k - 1] : 0.0) / fastest - rate);
      slow += slowness * (u - slow);
      const double values[] = {1.0,
                               u,
                               u * u,
                               u * u * u,
                               rate,
                               std::tanh(20.0 * rate),
                               std::abs(rate),
                               slow,
                               static_cast<double>(k) / static_cast<double>(x.size())};
      for (std::size_t j = 0; j < probes.size(); ++j) {
        probes[j][e][k] = values[j];
      }
    }
  }
  return probes;
}

struct Explained {
  std::string edge{};
  double share = 0.0;
  VectorXd direction{};  ///< of length 1, what of the residual it explains
};

Explained explain(const Task& task, const Explanation& calibrated, const std::string& top,
                  const language::SourceFile& source, const Edge& edge, std::uint32_t block,
                  const Background& background) {
  Explained result{.edge = edge.name};
  const std::string input = free_name(source.blocks[block], "ADDED_SIGNAL");
  const std::string instance = free_name(source.blocks[block], "ADDED");
  std::shared_ptr<const Program> program;
  try {
    program = compiled(
        with_effect(
            source, edge,
            {.block = "HY_SUM", .instance = instance, .input = "IN1", .wires = {{"IN2", input}}, .new_input = input}),
        top, {});
  } catch (const InputError&) {
    return result;
  }
  const auto node = std::ranges::find_if(program->graph.nodes, [&](const Node& one) { return one.path == instance; });
  if (node == program->graph.nodes.end()) {
    return result;
  }
  const VectorXd known = calibrated.fit.x.head(std::ssize(task.known));
  const RecordSignals signal = wire_signals(task, *program, {program->graph.wire(*node, 0)}, known).front();
  const double sample_time = task.records.front().sample_time();
  const Extent extent = extent_of(signal, sample_time);
  const double size = 1e-3 * (extent.range() > 0.0 ? extent.range() : 1.0);
  const std::vector<RecordSignals> probes = probes_of(signal, sample_time);
  MatrixXd changes(background.residuals().size(), std::ssize(probes));
  for (std::size_t j = 0; j < probes.size(); ++j) {
    Task driven = task;
    for (std::size_t e = 0; e < driven.records.size(); ++e) {
      std::vector<double> values = probes[j][e];
      for (double& v : values) {
        v *= size;
      }
      driven.records[e].add({.name = input, .values = std::move(values)});
    }
    Model model(driven, *program);
    VectorXd residuals;
    if (!model.residuals(calibrated.fit.x, residuals)) {
      return result;
    }
    changes.col(static_cast<Index>(j)) = residuals - background.residuals();
    const double length = changes.col(static_cast<Index>(j)).norm();
    if (length > 0.0) {
      changes.col(static_cast<Index>(j)) /= length;
    }
  }
  const VectorXd bound = VectorXd::Constant(changes.cols(), std::numeric_limits<double>::infinity());
  VectorXd alpha;
  const double gain = background.gain(changes, -bound, bound, alpha);
  result.share = background.unexplained() > 0.0 ? std::clamp(gain / background.unexplained(), 0.0, 1.0) : 0.0;
  result.direction = background.projected(changes * alpha);
  const double length = result.direction.norm();
  if (length > 0.0) {
    result.direction /= length;
  }
  return result;
}

}  // namespace

std::vector<EdgeFinding> where(const Task& task, const Explanation& calibrated, const std::string& top,
                               unsigned threads) {
  Diagnostics diagnostics;
  const auto source =
      std::make_shared<const language::SourceFile>(language::parse("text", calibrated.variant.text, diagnostics));
  const Definitions definitions = define(source, diagnostics);
  const std::uint32_t index = top_definition(definitions, top);
  std::vector<Edge> edges = edges_of(definitions, index);
  std::erase_if(edges, [&](const Edge& edge) { return edge.definition != index; });
  Model model(task, *calibrated.variant.program);
  const Background background(model, calibrated.fit);
  std::vector<Explained> list(edges.size());
  in_parallel(edges.size(), threads,
              [&](std::size_t i) { list[i] = explain(task, calibrated, top, *source, edges[i], index, background); });
  std::erase_if(list, [](const Explained& one) { return !(one.share > 0.0); });
  std::ranges::stable_sort(list, [](const Explained& a, const Explained& b) { return a.share > b.share; });
  std::vector<EdgeFinding> result;
  for (const Explained& one : list) {
    EdgeFinding finding{.edge = one.edge, .share = one.share};
    for (const Explained& other : list) {
      if (other.edge != one.edge && std::abs(one.direction.dot(other.direction)) > std::cos(same_direction)) {
        finding.group.push_back(other.edge);
      }
    }
    result.push_back(std::move(finding));
  }
  return result;
}

}  // namespace hysteron::diagnosis
