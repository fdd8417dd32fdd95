#include "diagnosis/findings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/noise_floor.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double normal_95 = 1.96;
/// A standard error of so many values says that there is no derivative.
constexpr double undetermined = 100.0;

/// Standard errors of all unknowns: s²(JᵀJ/τ + Λ)⁻¹ with the residual deviation s; ∞ where nothing determines one.
VectorXd standard_errors(const Model& model, const Fit& fit, double effective_samples) {
  const auto rows = static_cast<double>(fit.residuals.size());
  const double variance = fit.residuals.squaredNorm() / std::max(1.0, rows);
  const double tau = std::max(1.0, rows / std::max(1.0, effective_samples));
  MatrixXd normal = fit.jacobian.transpose() * fit.jacobian / (variance * tau);
  normal.diagonal() += model.prior().cwiseAbs2();
  VectorXd scale = normal.diagonal().cwiseSqrt();
  for (Index j = 0; j < scale.size(); ++j) {
    scale[j] = scale[j] > 0.0 ? scale[j] : 1.0;
  }
  const MatrixXd scaled = scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const MatrixXd inverse = (scaled + 1e-10 * MatrixXd::Identity(scaled.rows(), scaled.cols()))
                               .ldlt()
                               .solve(MatrixXd::Identity(scaled.rows(), scaled.cols()));
  return inverse.diagonal().cwiseAbs().cwiseSqrt().cwiseQuotient(scale);
}

ParameterFinding finding_of(const std::string& name, const std::string& unit, double value, double error, double lower,
                            double upper) {
  return {.name = name,
          .value = value,
          .low = std::max(lower, value - normal_95 * error),
          .high = std::min(upper, value + normal_95 * error),
          .unit = unit};
}

/// Where no derivative says what a parameter is worth, as with the dead band of a detector: how far it can go, the
/// others held, until the record speaks against it.
void widen_by_trial(Model& model, const Fit& fit, Index at, double effective_samples, ParameterFinding& finding) {
  constexpr double ratio = 1.1;
  constexpr int most_steps = 60;
  const double most = fit.cost * (1.0 + normal_95 * normal_95 / effective_samples);
  const auto end = [&](double factor) {
    double last = finding.value;
    VectorXd x = fit.x;
    VectorXd residuals;
    for (int step = 0; step < most_steps; ++step) {
      x[at] = std::clamp(last * factor, model.lower()[at], model.upper()[at]);
      if (x[at] == last || !model.residuals(x, residuals) || cost_of(model, x, residuals, nullptr) > most) {
        break;
      }
      last = x[at];
    }
    return last;
  };
  finding.low = end(finding.value > 0.0 ? 1.0 / ratio : ratio);
  finding.high = end(finding.value > 0.0 ? ratio : 1.0 / ratio);
}

std::string leaf(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}

/// ½Σr² of the best set with exactly these identifiers; NaN where none was fitted.
double cost_of_names(const Search& search, std::vector<std::string> names) {
  std::ranges::sort(names);
  if (names.empty()) {
    return search.calibrated.fit.cost;
  }
  for (const Explanation& one : search.explanations) {  // best first
    if (one.names() == names) {
      return one.fit.cost;
    }
  }
  return std::nan("");
}

/// Shapley shares of the effects of a set in what the set closes, from the sets that were fitted.
std::vector<double> shares_of(const Findings& findings, const Explanation& chosen) {
  const Search& search = findings.search;
  const std::size_t count = chosen.variant.effects.size();
  std::vector<std::string> names;
  for (const Applied& applied : chosen.variant.effects) {
    names.push_back(applied.effect);
  }
  std::vector<double> shares(count, 0.0);
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) {
    order[i] = i;
  }
  double orders = 0.0;
  do {
    std::vector<std::string> set;
    double before = search.calibrated.fit.cost;
    for (const std::size_t i : order) {
      set.push_back(names[i]);
      const double fitted = set.size() == count ? chosen.fit.cost : cost_of_names(search, set);
      const double after = std::isnan(fitted) ? before : std::min(before, fitted);
      shares[i] += before - after;
      before = after;
    }
    orders += 1.0;
  } while (std::ranges::next_permutation(order).found);
  const double gap = std::max(1e-300, search.calibrated.fit.cost - std::min(findings.floor_cost, chosen.fit.cost));
  for (double& share : shares) {
    share = std::clamp(share / orders / gap, 0.0, 1.0);
  }
  return shares;
}

Rival rival_of(const Task& task, const Weighed& weighed) {
  const Explanation& one = *weighed.explanation;
  Rival rival{
      .effects = one.names(),
      .improved_rms = std::sqrt(one.fit.residuals.squaredNorm() / static_cast<double>(one.fit.residuals.size())) *
                      task.scales.front(),
      .support = weighed.support,
      .probability = std::exp(std::min(0.0, weighed.support))};
  for (const Applied& applied : one.variant.effects) {
    rival.edges.push_back(applied.edge);
  }
  return rival;
}

}  // namespace

std::vector<ParameterFinding> nominal_findings(const Task& task) {
  std::vector<ParameterFinding> result;
  for (const Unknown& known : task.known) {
    result.push_back(
        {.name = known.path, .value = known.start, .low = known.start, .high = known.start, .unit = known.unit});
  }
  return result;
}

std::vector<ParameterFinding> calibration_findings(const Findings& findings) {
  const Explanation& kept = *findings.judgement.chosen;
  const Model model(findings.task, *kept.variant.program, kept.variant.further);
  const VectorXd errors = standard_errors(model, kept.fit, findings.judgement.effective_samples);
  std::vector<ParameterFinding> result;
  for (std::size_t j = 0; j < findings.task.known.size(); ++j) {
    const auto at = static_cast<Index>(j);
    result.push_back(finding_of(findings.task.known[j].path, model.problem().parameters[j].unit, kept.fit.x[at],
                                errors[at], model.lower()[at], model.upper()[at]));
  }
  return result;
}

std::vector<EffectFinding> effect_findings(const Findings& findings) {
  const Explanation& chosen = *findings.judgement.chosen;
  Model model(findings.task, *chosen.variant.program, chosen.variant.further);
  const double samples = findings.judgement.effective_samples;
  const VectorXd errors = standard_errors(model, chosen.fit, samples);
  const std::vector<double> shares = shares_of(findings, chosen);
  std::vector<EffectFinding> result;
  for (std::size_t i = 0; i < chosen.variant.effects.size(); ++i) {
    const Applied& applied = chosen.variant.effects[i];
    EffectFinding finding{.id = applied.effect, .edge = applied.edge, .share = shares[i]};
    for (std::size_t j = 0; j < chosen.variant.further.size(); ++j) {
      const Unknown& unknown = chosen.variant.further[j];
      const Index at = model.first_further() + static_cast<Index>(j);
      const bool own = std::ranges::find(applied.paths, unknown.path) != applied.paths.end();
      if (!own || !std::isfinite(chosen.fit.x[at])) {  // another effect's, or a bound that is not there
        continue;
      }
      finding.parameters.push_back(finding_of(leaf(unknown.path), unknown.unit, chosen.fit.x[at], errors[at],
                                              model.lower()[at], model.upper()[at]));
      if (errors[at] > undetermined * std::abs(chosen.fit.x[at])) {
        widen_by_trial(model, chosen.fit, at, samples, finding.parameters.back());
      }
    }
    std::set<std::string> same(applied.twins.begin(), applied.twins.end());
    for (const Weighed& other : findings.judgement.same) {
      for (const Applied& there : other.explanation->variant.effects) {
        if (there.effect == applied.effect && there.edge != applied.edge) {
          same.insert(there.edge);
        }
      }
    }
    finding.same_edges.assign(same.begin(), same.end());
    result.push_back(std::move(finding));
  }
  std::ranges::stable_sort(result, [](const EffectFinding& a, const EffectFinding& b) { return a.share > b.share; });
  return result;
}

std::vector<Rival> rival_findings(const Findings& findings) {
  std::vector<Rival> result;
  double total = 0.0;
  for (const Weighed& weighed : findings.judgement.rivals) {
    result.push_back(rival_of(findings.task, weighed));
    total += result.back().probability;
  }
  for (Rival& rival : result) {
    rival.probability /= total;
  }
  return result;
}

std::vector<Rival> fitted_findings(const Findings& findings) {
  constexpr std::size_t most = 40;
  std::vector<Rival> result;
  for (const Weighed& weighed : findings.judgement.fitted) {
    if (result.size() < most) {
      result.push_back(rival_of(findings.task, weighed));
    }
  }
  return result;
}

double confidence(const Findings& findings, const Diagnosis& so_far) {
  // An effect as large as the noise can hide in what depends on the machine's motion and is called noise.
  const double no_effect = 0.95 - 0.3 * findings.predictable;
  switch (so_far.verdict) {
    case Verdict::Named:
    case Verdict::Group:
    case Verdict::Partial: {
      const double first = so_far.rivals.empty() ? 0.0 : so_far.rivals.front().probability;
      const double strength = 1.0 - std::exp(-0.2 * std::max(0.0, findings.judgement.significance));
      const double closed = std::clamp(so_far.gap.closed, 0.0, 1.0);
      const double whole = so_far.verdict == Verdict::Partial ? 0.6 : 0.7 + 0.29 * closed;
      // What is left beyond any noise that the floor does not see was explained by nothing: the name is not the whole.
      const double size = so_far.gap.improved / so_far.gap.floor.value;
      const double explained = std::min(1.0, hidden_noise / std::max(size, 1e-9));
      return std::clamp(first * strength * whole * (1.0 - so_far.unknown_score) * explained, 0.0, 0.99);
    }
    case Verdict::None:
      return no_effect;
    case Verdict::Calibration: {
      // A parameter that has run far from its tuned value is no recalibration but another machine.
      double farthest = 0.0;
      for (std::size_t j = 0; j < so_far.calibration.size() && j < so_far.nominal.size(); ++j) {
        const double tuned = so_far.nominal[j].value;
        if (tuned != 0.0) {
          farthest = std::max(farthest, std::abs(so_far.calibration[j].value / tuned - 1.0));
        }
      }
      return farthest > 0.6 ? std::min(0.6, no_effect) : no_effect;
    }
    case Verdict::Unknown:
      return 0.7;
  }
  return 0.0;
}

std::vector<std::string> structural_reasons(const Diagnosis& so_far) {
  std::vector<std::string> reasons;
  for (const EffectFinding& effect : so_far.effects) {
    if (!effect.same_edges.empty()) {
      reasons.push_back(fmt::format(
          "{} at {} or at {}: the measured outputs are the same but for the noise. Measure a signal between them.",
          effect.id, effect.edge, fmt::join(effect.same_edges, ", ")));
    }
  }
  if (so_far.rivals.size() > 1) {
    std::vector<std::string> names;
    for (const Rival& rival : so_far.rivals) {
      names.push_back(fmt::format("{}", fmt::join(rival.effects, " + ")));
    }
    reasons.push_back(
        fmt::format("{}: after a refit of the known parameters their outputs differ by less than this "
                    "record's noise can show.",
                    fmt::join(names, " or ")));
  }
  for (const std::string& warning : so_far.warnings) {
    reasons.push_back(warning);
  }
  return reasons;
}

GapSplit split_of(const std::vector<EffectFinding>& effects, const std::vector<Edge>& edges,
                  const std::vector<std::string>& ports) {
  static const std::set<std::string, std::less<>> of_wires{"delay", "clock", "quantization", "glitches"};
  std::set<std::string> wires;
  for (const std::string& port : ports) {
    if (const Edge* const edge = find_edge(edges, port)) {
      wires.insert(edge->name);
    }
  }
  GapSplit split{.open = 1.0};
  for (const EffectFinding& effect : effects) {
    const bool at_port =
        wires.contains(effect.edge) ||
        std::ranges::any_of(effect.same_edges, [&](const std::string& same) { return wires.contains(same); });
    (at_port && of_wires.contains(effect.id) ? split.input_output : split.plant) += effect.share;
    split.open -= effect.share;
  }
  split.open = std::max(0.0, split.open);
  return split;
}

std::vector<Trace> traces_of(const Task& task, const VectorXd& nominal, const VectorXd& calibrated,
                             const VectorXd& improved) {
  std::vector<Trace> traces;
  Index row = 0;
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const double scale = task.scales[output];
    for (const records::Record& record : task.records) {
      const records::Column& column = record.column(task.outputs[output]);
      Trace trace{.record = record.file(), .signal = task.outputs[output], .unit = column.unit};
      trace.time.assign(record.time().begin(), record.time().end());
      trace.measured = column.values;
      for (const double y : column.values) {
        trace.nominal.push_back(y + scale * nominal[row]);
        trace.calibrated.push_back(y + scale * calibrated[row]);
        trace.improved.push_back(y + scale * improved[row]);
        ++row;
      }
      traces.push_back(std::move(trace));
    }
  }
  return traces;
}

std::string improved_text(const Explanation& explanation, const std::string& path) {
  Diagnostics diagnostics;
  return format_text(path, explanation.variant.text, diagnostics);
}

parameters::ParameterFile improved_file(const Task& task, parameters::ParameterFile file,
                                        const Explanation& explanation) {
  const auto set = [&](const std::string& path, parameters::Value value) {
    for (parameters::ParameterValue& one : file.values) {
      if (language::same_name(one.path, path)) {
        one.value = std::move(value);
        return;
      }
    }
    file.values.push_back({.path = path, .value = std::move(value)});
  };
  const auto fitted = [&](const std::string& path) {
    return std::ranges::any_of(file.fits,
                               [&](const parameters::FitSetting& one) { return language::same_name(one.path, path); });
  };
  const VectorXd& x = explanation.fit.x;
  for (std::size_t j = 0; j < task.known.size(); ++j) {
    set(task.known[j].path, x[static_cast<Index>(j)]);
    for (parameters::FitSetting& one : file.fits) {
      if (language::same_name(one.path, task.known[j].path)) {
        one.start.reset();
      }
    }
  }
  for (std::size_t j = 0; j < explanation.variant.further.size(); ++j) {
    const std::string& path = explanation.variant.further[j].path;
    const double value = x[std::ssize(task.known) + static_cast<Index>(j)];
    if (!std::isfinite(value)) {
      continue;  // a bound that is not there: so the block has it by itself
    }
    set(path, value);
    if (!file.fits.empty() && !fitted(path)) {
      file.fits.push_back({.path = path});
    }
  }
  const Index first_state = std::ssize(task.known) + std::ssize(explanation.variant.further);
  for (std::size_t state = 0; state < task.initial_states.size(); ++state) {
    const std::string& path = task.initial_states[state];
    if (task.records.size() == 1) {  // of several records each has its own, which no file says
      file.set_initial(path, x[first_state + static_cast<Index>(state)]);
    }
    if (std::ranges::none_of(file.tune.initial_states, [&](const parameters::PlacedText& named) {
          return language::same_name(named.text, path);
        })) {
      file.tune.initial_states.push_back({.text = path});
    }
  }
  for (const Applied& applied : explanation.variant.effects) {
    for (const auto& [path, value] : applied.settings) {
      const std::int64_t found = find_parameter(explanation.variant.program->graph, path);
      const bool choice =
          found >= 0 &&
          explanation.variant.program->graph.parameters[static_cast<std::size_t>(found)].field.type == Type::Bool;
      set(path, choice ? parameters::Value(value != 0.0) : parameters::Value(value));
    }
  }
  return file;
}

std::string summary_of(const Diagnosis& found) {
  std::string gap = fmt::format("{} {:.3g} → {:.3g} → {:.3g}{}{} RMS, floor {:.3g}", found.gap.signal,
                                found.gap.nominal, found.gap.calibrated, found.gap.improved,
                                found.gap.unit.empty() ? "" : " ", found.gap.unit, found.gap.floor.value);
  std::vector<std::string> effects;
  for (const EffectFinding& effect : found.effects) {
    effects.push_back(fmt::format("{} at {}", effect.id, effect.edge));
  }
  switch (found.verdict) {
    case Verdict::None:
      return fmt::format("No material gap: the model explains the record down to its noise ({}).", gap);
    case Verdict::Calibration:
      return fmt::format("Calibration: refitted parameters close the gap, no effect is missing ({}).", gap);
    case Verdict::Named:
      return fmt::format("{} ({}).", fmt::join(effects, " and "), gap);
    case Verdict::Group:
      return fmt::format("{}, or a rival that the record cannot tell from it ({}).", fmt::join(effects, " and "), gap);
    case Verdict::Partial:
      return fmt::format("{}, and something more that none of the effects explains ({}).", fmt::join(effects, " and "),
                         gap);
    case Verdict::Unknown:
      return fmt::format("The record follows something that none of the effects explains ({}).", gap);
  }
  return gap;
}

}  // namespace hysteron::diagnosis
