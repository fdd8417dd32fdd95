#include "diagnosis/findings/where.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "diagnosis/effects/added_signal.hpp"
#include "diagnosis/effects/signals.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/search/loop_noise.hpp"
#include "diagnosis/search/screening.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double same_direction = 10.0 * std::numbers::pi / 180.0;

/// Of a slow copy, as the share of a step that one sample closes.
double slowness(std::size_t samples) {
  return 1.0 / std::max(10.0, 0.05 * static_cast<double>(samples));
}

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
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double u = 2.0 * (x[k] - middle) / range;
      rate += 0.3 * ((k > 0 ? x[k] - x[k - 1] : 0.0) / fastest - rate);
      slow += slowness(x.size()) * (u - slow);
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

/// The values of an input or of a column that nothing uses, and a slow copy, over its range; none where it rests.
std::vector<RecordSignals> probes_of(const Task& task, const std::string& column) {
  RecordSignals as_it_is;
  for (const records::Record& record : task.records) {
    const records::Column* const found = record.find(column);
    if (found == nullptr) {
      return {};
    }
    as_it_is.push_back(found->values);
  }
  const Extent extent = extent_of(as_it_is, task.records.front().sample_time());
  if (!(extent.range() > 0.0)) {
    return {};
  }
  RecordSignals slow_copy = as_it_is;
  for (std::size_t e = 0; e < as_it_is.size(); ++e) {
    double slow = (as_it_is[e].front() - extent.begin) / extent.range();
    for (std::size_t k = 0; k < as_it_is[e].size(); ++k) {
      as_it_is[e][k] = (as_it_is[e][k] - extent.begin) / extent.range();
      slow += slowness(as_it_is[e].size()) * (as_it_is[e][k] - slow);
      slow_copy[e][k] = slow;
    }
  }
  return {std::move(as_it_is), std::move(slow_copy)};
}

struct Explained {
  std::string edge{};
  double share = 0.0;
  VectorXd direction{};  ///< of length 1, what of the residual it explains
};

Explained explain(const Task& task, const Explanation& calibrated, const std::string& top,
                  const language::SourceFile& source, const Edge& edge, const std::vector<RecordSignals>& couplings,
                  const Background& background) {
  Explained result{.edge = edge.name};
  const std::optional<AddedSignal> added = with_added_signal(source, edge, top, calibrated.variant);
  if (!added) {
    return result;
  }
  const VectorXd known = calibrated.fit.x.head(std::ssize(task.known));
  const RecordSignals signal = wire_signals(task, *added->program, {added->before}, known).front();
  const double sample_time = task.records.front().sample_time();
  const Extent extent = extent_of(signal, sample_time);
  const double size = 1e-3 * (extent.range() > 0.0 ? extent.range() : 1.0);
  std::vector<RecordSignals> probes = probes_of(signal, sample_time);
  probes.insert(probes.end(), couplings.begin(), couplings.end());
  MatrixXd changes(background.residuals().size(), std::ssize(probes));
  for (std::size_t j = 0; j < probes.size(); ++j) {
    RecordSignals scaled = probes[j];
    for (Signal& values : scaled) {
      for (double& v : values) {
        v *= size;
      }
    }
    const VectorXd residuals = residuals_with(task, *added, scaled, {}, calibrated.fit.x);
    if (residuals.size() == 0) {
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

/// What of the calibrated residual the effects that were fitted close, each alone on its edge.
std::map<std::string, double> closed_alone(const Search& found) {
  std::map<std::string, double> result;
  for (const Explanation& one : found.explanations) {
    if (one.variant.effects.size() == 1) {
      double& most = result[one.variant.effects.front().edge];
      most = std::max(most, 1.0 - one.fit.cost / found.calibrated.fit.cost);
    }
  }
  return result;
}

}  // namespace

std::vector<EdgeFinding> where(const Task& task, const Search& found, const std::string& top,
                               const std::vector<std::string>& columns, const std::vector<EffectFinding>& effects,
                               unsigned threads) {
  const Explanation& calibrated = found.calibrated;
  Diagnostics diagnostics;
  const auto source =
      std::make_shared<const language::SourceFile>(language::parse("text", calibrated.variant.text, diagnostics));
  const Definitions definitions = define(source, diagnostics);
  const std::uint32_t index = top_definition(definitions, top);
  std::vector<Edge> edges = edges_of(definitions, index);
  std::erase_if(edges, [&](const Edge& edge) { return edge.definition != index; });
  std::vector<RecordSignals> couplings;
  std::vector<std::string> names = columns;
  const Explanation given = without_noise(calibrated, top);
  for (const Port& input : given.variant.program->graph.inputs) {
    names.push_back(input.name);
  }
  for (const std::string& name : names) {
    std::ranges::move(probes_of(task, name), std::back_inserter(couplings));
  }
  Model model(task, *calibrated.variant.program);
  const Background background(model, calibrated.fit);
  std::vector<Explained> list(edges.size());
  in_parallel(edges.size(), threads, [&](std::size_t i) {
    list[i] = explain(task, calibrated, top, *source, edges[i], couplings, background);
  });
  std::map<std::string, double> closed = closed_alone(found);
  for (const EffectFinding& effect : effects) {
    closed[effect.edge] = std::max(closed[effect.edge], effect.share);
  }
  for (const auto& [name, share] : closed) {
    const Edge* const edge = find_edge(edges, name);
    if (edge != nullptr) {
      double& spanned = list[static_cast<std::size_t>(edge - edges.data())].share;
      spanned = std::clamp(share, spanned, 1.0);
    }
  }
  std::erase_if(list, [](const Explained& one) { return !(one.share > 0.0); });
  std::ranges::stable_sort(list, [](const Explained& a, const Explained& b) { return a.share > b.share; });
  std::vector<EdgeFinding> result;
  for (const Explained& one : list) {
    EdgeFinding finding{.edge = one.edge, .share = one.share};
    for (const Explained& other : list) {
      if (other.edge != one.edge && one.direction.size() == other.direction.size() &&
          std::abs(one.direction.dot(other.direction)) > std::cos(same_direction)) {
        finding.group.push_back(other.edge);
      }
    }
    result.push_back(std::move(finding));
  }
  return result;
}

}  // namespace hysteron::diagnosis
