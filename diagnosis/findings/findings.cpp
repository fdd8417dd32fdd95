#include "diagnosis/findings/findings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "codegen/graph/units.hpp"
#include "diagnosis/findings/shares.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/remainder.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/remedy/improved.hpp"
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
  bool by_record = false;
  const auto end = [&](double factor) {
    double last = finding.value;
    VectorXd x = fit.x;
    VectorXd residuals;
    for (int step = 0; step < most_steps; ++step) {
      x[at] = std::clamp(last * factor, model.lower()[at], model.upper()[at]);
      if (x[at] == last) {
        break;
      }
      if (!model.residuals(x, residuals) || cost_of(model, x, residuals, nullptr) > most) {
        by_record = true;
        break;
      }
      last = x[at];
    }
    return last;
  };
  finding.low = end(finding.value > 0.0 ? 1.0 / ratio : ratio);
  finding.high = end(finding.value > 0.0 ? ratio : 1.0 / ratio);
  if (!by_record) {  // the ends are those of the trial: the record says nothing
    finding.low = -std::numeric_limits<double>::infinity();
    finding.high = std::numeric_limits<double>::infinity();
  }
}

std::string leaf(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}

/// In a gap of the noise's size one of seven names was another effect's, in the sealed sets of the blind trial.
double seen(const GapFinding& gap) {
  constexpr double wrong_at_noise = 0.15;
  const double noise = std::min(gap.floor.value, gap.improved);
  const double explained = gap.calibrated * gap.calibrated - gap.improved * gap.improved;
  return 1.0 - wrong_at_noise * std::min(1.0, noise * noise / std::max(explained, 1e-300));
}

/// Of names beside which a set without one of them came within twelve nats, one of seven was another effect's, in those
/// sets: no formula is quite the machine's, and how well each fits is in part chance.
double unrivalled(const Judgement& judgement) {
  constexpr double wrong_if_near = 0.15;
  constexpr double near = 12.0;
  const std::vector<std::string> chosen = judgement.chosen->names();
  double nearest = std::numeric_limits<double>::infinity();
  for (const Weighed& one : judgement.fitted) {
    const std::vector<std::string> names = one.explanation->names();
    if (!std::ranges::includes(names, chosen)) {
      nearest = std::min(nearest, -one.support);
    }
  }
  return 1.0 - wrong_if_near * std::min(1.0, near / std::max(nearest, near));
}

/// `id at edge`, the lines of one disturbance together.
std::vector<std::string> named_once(const std::vector<EffectFinding>& effects) {
  std::vector<std::string> names;
  for (const EffectFinding& effect : effects) {
    const auto is_same = [&](const EffectFinding& other) { return other.id == effect.id && other.edge == effect.edge; };
    if (&*std::ranges::find_if(effects, is_same) == &effect) {
      const auto lines = std::ranges::count_if(effects, is_same);
      names.push_back(fmt::format("{} at {}{}", effect.id, effect.edge,
                                  lines > 1 ? fmt::format(" ({} lines)", lines) : std::string()));
    }
  }
  return names;
}

std::string unit_behind(const GapFinding& gap) {
  return gap.unit.empty() ? "" : " " + gap.unit;
}

/// A delay that a model's own steps may be.
bool is_within_a_sample(const EffectFinding& effect, double sample_time) {
  return std::ranges::any_of(effect.parameters, [&](const ParameterFinding& one) {
    return one.role == FieldRole::DeadTime && one.low <= sample_time;
  });
}

}  // namespace

Rival rival_of(const Task& task, std::size_t gap_output, const Weighed& weighed) {
  const Explanation& one = *weighed.explanation;
  Rival rival{.parameters = static_cast<std::size_t>(one.parameters()),
              .improved_rms = rms_of(task, one.fit.residuals, gap_output),
              .support = weighed.support,
              .probability = weighed.weight()};
  std::vector<std::pair<std::string, std::string>> places;
  for (const Applied& applied : one.variant.effects) {
    places.emplace_back(applied.effect, in_the_diagram(applied.edge, one.variant.effects));
  }
  std::ranges::sort(places);  // the same set reads the same, whichever effect was found first
  for (auto& [effect, edge] : places) {
    rival.effects.push_back(std::move(effect));
    rival.edges.push_back(std::move(edge));
  }
  return rival;
}

std::vector<ParameterFinding> nominal_findings(const Task& task) {
  std::vector<ParameterFinding> result;
  for (const Unknown& known : task.known) {
    result.push_back(
        {.name = known.path, .value = known.start, .low = known.start, .high = known.start, .unit = known.unit});
  }
  return result;
}

std::vector<ParameterFinding> calibration_findings(const Findings& findings) {
  const Explanation& kept = findings.kept;
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
  const Program& program = *chosen.variant.program;
  const std::vector<std::string> units = units::Solution(program.graph, program.schedule).parameters();
  // As the wires make it: an unknown that was proposed has the unit of its block, 'x.
  const auto unit_at = [&](const std::string& path) {
    const std::int64_t at = find_parameter(program.graph, path);
    return at < 0 ? std::string() : units[static_cast<std::size_t>(at)];
  };
  std::vector<EffectFinding> result;
  for (std::size_t i = 0; i < chosen.variant.effects.size(); ++i) {
    const Applied& applied = chosen.variant.effects[i];
    EffectFinding finding{
        .id = applied.effect, .edge = in_the_diagram(applied.edge, chosen.variant.effects), .share = shares[i]};
    for (std::size_t j = 0; j < chosen.variant.further.size(); ++j) {
      const Unknown& unknown = chosen.variant.further[j];
      const Index at = model.first_further() + static_cast<Index>(j);
      const bool own = std::ranges::find(applied.paths, unknown.path) != applied.paths.end();
      if (!own || !std::isfinite(chosen.fit.x[at])) {  // another effect's, or a bound that is not there
        continue;
      }
      finding.parameters.push_back(finding_of(leaf(unknown.path), unit_at(unknown.path), chosen.fit.x[at], errors[at],
                                              model.lower()[at], model.upper()[at]));
      finding.parameters.back().role = applied.parameter(unknown.path).field.role;
      if (errors[at] > undetermined * std::abs(chosen.fit.x[at]) || !has_influence(chosen.fit, at, unknown.typical)) {
        widen_by_trial(model, chosen.fit, at, samples, finding.parameters.back());
      }
    }
    for (const auto& [path, value] : applied.settings) {
      const std::int64_t at = find_parameter(program.graph, path);
      if (at >= 0 && program.graph.parameters[static_cast<std::size_t>(at)].field.type != Type::Bool) {
        finding.settings.push_back({.name = leaf(path), .value = value, .unit = unit_at(path)});
      }
    }
    for (const auto& [pin, driver] : applied.wires) {
      finding.drivers.push_back(in_the_diagram(driver, chosen.variant.effects));
    }
    std::set<std::string> same;
    for (const std::string& twin : applied.twins) {
      same.insert(in_the_diagram(twin, chosen.variant.effects));
    }
    for (const Weighed& other : findings.judgement.same) {
      for (const Applied& there : other.explanation->variant.effects) {
        if (there.effect == applied.effect) {
          same.insert(in_the_diagram(there.edge, other.explanation->variant.effects));
        }
      }
    }
    same.erase(finding.edge);
    finding.same_edges.assign(same.begin(), same.end());
    result.push_back(std::move(finding));
  }
  std::ranges::stable_sort(result, [](const EffectFinding& a, const EffectFinding& b) { return a.share > b.share; });
  // Of those with equal shares the simplest has the first name: neither closes anything without the other.
  constexpr double equal_share = 0.02;
  const auto equal = std::ranges::find_if(
      result, [&](const EffectFinding& one) { return one.share < result.front().share - equal_share; });
  std::ranges::stable_sort(result.begin(), equal, {}, [](const EffectFinding& one) { return one.parameters.size(); });
  // One that all rivals have goes before one that some can do without.
  (void)std::stable_partition(result.begin(), result.end(), [&](const EffectFinding& one) {
    return std::ranges::all_of(findings.judgement.rivals, [&](const Weighed& rival) {
      return std::ranges::count(rival.explanation->names(), one.id) > 0;
    });
  });
  return result;
}

std::vector<Rival> rival_findings(const Findings& findings) {
  const std::vector<Weighed>& rivals = findings.judgement.rivals;
  const std::vector<double> probability = probabilities(rivals);
  std::vector<Rival> result;
  for (std::size_t i = 0; i < rivals.size(); ++i) {
    result.push_back(rival_of(findings.task, findings.gap_output, rivals[i]));
    result.back().probability = probability[i];
  }
  return result;
}

std::vector<Rival> fitted_findings(const Findings& findings) {
  constexpr std::size_t most = 40;
  std::vector<Rival> result;
  for (const Weighed& weighed : findings.judgement.fitted) {
    if (result.size() < most) {
      result.push_back(rival_of(findings.task, findings.gap_output, weighed));
    }
  }
  return result;
}

double confidence(const Findings& findings, const Diagnosis& so_far, Rules& rules) {
  // An effect as large as the noise can hide in what depends on the machine's motion and is called noise, a larger one
  // in what is left above it.
  const double no_effect = (0.95 - 0.3 * findings.predictable) * (1.0 - so_far.unknown_score);
  switch (so_far.verdict) {
    case Verdict::Named:
    case Verdict::Group:
    case Verdict::Partial: {
      const double first = so_far.rivals.empty() ? 0.0 : so_far.rivals.front().probability;
      const double strength = 1.0 - std::exp(-0.2 * std::max(0.0, findings.judgement.significance));
      const double closed = std::clamp(so_far.gap.closed, 0.0, 1.0);
      const double whole = so_far.verdict == Verdict::Partial ? 0.6 : 0.7 + 0.29 * closed;
      // What is left beyond any noise was explained by nothing: the name is not the whole.
      const double explained = std::min(1.0, policy::suspicious.value / std::max(findings.unexplained, 1e-9));
      return std::clamp(first * strength * whole * (1.0 - so_far.unknown_score) * explained * seen(so_far.gap) *
                            unrivalled(findings.judgement),
                        0.0, 0.99);
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
    case Verdict::Unknown: {
      // Sure as far as what is left is a cause of its own, and as no effect of the library may yet be it.
      double offered = 0.0;
      for (const FamilyFinding& one : so_far.evidence.families) {
        offered = std::max(offered, one.probability * std::clamp(one.alone, 0.0, 1.0));
      }
      return rules.capped(policy::sure_of_unknown, so_far.unknown_score) * (1.0 - offered);
    }
  }
  return 0.0;
}

std::string warning_of_worse(const GapFinding& gap, bool refit, bool effects) {
  const std::string unit = unit_behind(gap);
  const std::string by_refit = fmt::format("The refit of the known parameters makes {} worse, {:.3g} → {:.3g}{} RMS",
                                           gap.signal, gap.nominal, gap.calibrated, unit);
  if (!refit) {
    return fmt::format("The improved diagram makes {} worse, {:.3g} → {:.3g}{} RMS, for the sake of the other outputs.",
                       gap.signal, gap.nominal, gap.improved, unit);
  }
  return fmt::format("{}, for the sake of the other outputs{}.", by_refit,
                     effects ? fmt::format("; with the effects {:.3g}{} stay", gap.improved, unit) : std::string());
}

std::string warning_of_effort(double effort, std::size_t candidates) {
  return fmt::format(
      "The search ended after {} candidates: every effect alone was tried, not every set of several. --effort {:.4g} "
      "goes on for as long again.",
      candidates, 2.0 * effort);
}

std::string warning_of_time_limit(double seconds, std::size_t candidates) {
  return fmt::format(
      "The time limit of {:.4g} s cut the search after {} candidates: every effect alone was tried, not every set of "
      "several. Another run may give another verdict; without --time-limit it gives the same.",
      seconds, candidates);
}

std::string warning_of_floor(const GapFinding& gap) {
  const std::string unit = unit_behind(gap);
  return fmt::format(
      "The noise floor of {}, {:.3g}{} RMS from {}, holds a part of what the effects explain: they leave {:.3g}{}.",
      gap.signal, gap.floor.value, unit, gap.floor.evidence, gap.improved, unit);
}

std::vector<std::string> structural_reasons(const Diagnosis& so_far, double sample_time, double duration) {
  std::vector<std::string> reasons;
  for (const EffectFinding& effect : so_far.effects) {
    if (!effect.same_edges.empty()) {
      reasons.push_back(fmt::format(
          "{} at {} or at {}: the measured outputs are the same but for the noise. Measure a signal between them.",
          effect.id, effect.edge, fmt::join(effect.same_edges, ", ")));
    }
    if (is_within_a_sample(effect, sample_time)) {
      reasons.push_back(fmt::format(
          "{} at {}: it may be no more than a sample, {:.3g} s, and a model in steps makes such a one by itself. Its "
          "HY_INTEGRAL is half a sample ahead, HY_INTEGRAL_FORWARD half a sample behind.",
          effect.id, effect.edge, sample_time));
    }
  }
  std::vector<std::string> equal;
  for (const Rival& rival : so_far.rivals) {
    const std::string names = fmt::format("{}", fmt::join(rival.effects, " + "));
    if (rival.support > -rival_within) {
      equal.push_back(names);
    } else {
      reasons.push_back(fmt::format(
          "{} alone: what the other effect closes beside it is little, and may be what its formula misses.", names));
    }
  }
  if (equal.size() > 1) {
    reasons.push_back(
        fmt::format("{}: after a refit of the known parameters their outputs differ by less than this "
                    "record's noise can show.",
                    fmt::join(equal, " or ")));
  }
  if (duration > 0.0 && (so_far.verdict == Verdict::Unknown || so_far.verdict == Verdict::Partial)) {
    reasons.push_back(
        fmt::format("A periodic disturbance slower than some {:.3g} s: its period is tried where it fits about twice "
                    "into the record. Record longer.",
                    0.5 * duration));
  }
  for (const std::string& warning : so_far.warnings) {
    reasons.push_back(warning);
  }
  return reasons;
}

std::vector<Trace> traces_of(const Task& task, const std::vector<GapFinding>& gaps, const VectorXd& nominal,
                             const VectorXd& calibrated, const VectorXd& improved) {
  std::vector<Trace> traces;
  Index row = 0;
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const double scale = task.scales[output];
    for (const records::Record& record : task.records) {
      const records::Column& column = record.column(task.outputs[output]);
      Trace trace{.record = record.file(),
                  .signal = task.outputs[output],
                  .unit = gaps[output].unit.empty() ? column.unit : gaps[output].unit};
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

std::string summary_of(const Diagnosis& found, bool below_material) {
  std::string gap = fmt::format("{}: nominal {:.3g}, calibrated {:.3g}, improved {:.3g}{} RMS, floor {:.3g}",
                                found.gap.signal, found.gap.nominal, found.gap.calibrated, found.gap.improved,
                                unit_behind(found.gap), found.gap.floor.value);
  const std::vector<std::string> effects = named_once(found.effects);
  switch (found.verdict) {
    case Verdict::None:
      return fmt::format("No material gap: {} ({}).",
                         below_material ? "what is left lies below the size that matters"
                                        : "the model explains the record down to its noise",
                         gap);
    case Verdict::Calibration:
      if (below_material) {
        return fmt::format("Calibration: what refitted parameters leave lies below the size that matters ({}).", gap);
      }
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
