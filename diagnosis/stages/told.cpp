#include "diagnosis/stages/told.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "codegen/parameters/elements.hpp"
#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/effects/known_effects.hpp"
#include "diagnosis/findings/control_loop.hpp"
#include "diagnosis/findings/doubts.hpp"
#include "diagnosis/findings/evidence_findings.hpp"
#include "diagnosis/findings/findings.hpp"
#include "diagnosis/findings/gaps.hpp"
#include "diagnosis/findings/inner_signals.hpp"
#include "diagnosis/findings/left_out_findings.hpp"
#include "diagnosis/findings/loops.hpp"
#include "diagnosis/findings/maps.hpp"
#include "diagnosis/findings/shares.hpp"
#include "diagnosis/findings/where.hpp"
#include "diagnosis/outlook.hpp"
#include "diagnosis/remedy/improved.hpp"
#include "diagnosis/remedy/next_experiment.hpp"
#include "diagnosis/search/loop_noise.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::diagnosis {
namespace {

std::vector<std::string> ports_of(const Cleaned& record) {
  std::vector<std::string> names = record.task.outputs;
  for (const Port& input : record.input.program.graph.inputs) {
    names.push_back(input.name);
  }
  return names;
}

std::vector<InputRange> ranges_of_inputs(const Cleaned& record) {
  std::vector<InputRange> result;
  for (const Port& input : record.input.program.graph.inputs) {
    std::vector<double> ends;
    for (const records::Record& one : record.input.records) {
      if (const records::Column* const column = one.find(input.name); column != nullptr && !column->values.empty()) {
        const auto [low, high] = std::ranges::minmax(column->values);
        ends.insert(ends.end(), {low, high});
      }
    }
    if (!ends.empty() && input.type == Type::Real) {
      const auto [low, high] = std::ranges::minmax(ends);
      result.push_back({.signal = input.name, .unit = input.unit, .low = low, .high = high});
    }
  }
  return result;
}

/// The gap of each output, and where a refit or the effects make one worse.
void add_gaps(const Judged& judged, const Answer& answer, const Explanation& kept, const DiagnosisOptions& options,
              Diagnosis& result) {
  const Cleaned& record = judged.record;
  const Materiality materiality = materiality_of(record, options);
  const VectorXd& calibrated = judged.calibrated().fit.residuals;
  const VectorXd unseen = &kept == &judged.chosen() ? judged.judgement().held_out : held_out(record.task, kept);
  result.gaps =
      gaps_of(record.task, record.input.program.graph,
              {.nominal = record.nominal, .calibrated = calibrated, .kept = kept.fit.residuals, .held_out = unseen},
              record.floors, options.seed);
  for (std::size_t output = 0; output < result.gaps.size(); ++output) {
    const GapFinding& gap = result.gaps[output];
    const bool refit_is_worse = materiality.matters(gap.calibrated, gap.nominal, output);
    const bool effects_are_worse = answer.is_named() && materiality.matters(gap.improved, gap.nominal, output);
    if (refit_is_worse || effects_are_worse) {
      result.warnings.push_back(warning_of_worse(gap, refit_is_worse, effects_are_worse));
    }
  }
  result.gap = result.gaps[answer.gap_output];
  if (answer.is_named() && materiality.was_taken_for_noise(calibrated, kept.fit.residuals)) {
    result.warnings.push_back(warning_of_floor(result.gap));
  }
}

/// The verdict with its numbers, and how sure it is.
void add_verdict(const Judged& judged, const Answer& answer, const Explanation& kept, const DiagnosisOptions& options,
                 Rules& rules, Diagnosis& result) {
  const Cleaned& record = judged.record;
  const Findings findings{.task = record.task,
                          .search = judged.searched->search,
                          .judgement = judged.judgement(),
                          .kept = kept,
                          .floor_cost = record.floor_cost,
                          .chosen_cost = judged.unrepeatable ? 0.5 * judged.unrepeatable->residuals.squaredNorm()
                                                             : judged.chosen().fit.cost,
                          .gap_output = answer.gap_output,
                          .predictable = answer.predictable,
                          .unexplained = answer.unexplained};
  result.calibration = calibration_findings(findings);
  result.nominal = nominal_findings(record.task);
  if (answer.is_named()) {
    result.effects = effect_findings(findings);
    result.rivals = rival_findings(findings);
  }
  result.fitted = fitted_findings(findings);
  result.confidence = confidence(findings, result, rules);
  if (judged.evidence.is_told) {
    tell(judged.evidence, rules, result);
  } else if (answer.is_named() && !judged.evidence.families.empty()) {
    result.confidence = confidence_of(judged.evidence, judged.evidence.sets.front());
  }
  const std::map<std::string, std::string> families = families_by_effect(record.input.program);
  const auto family_of = [&](const EffectFinding& effect) {
    const auto known = families.find(effect.id);
    return known == families.end() ? effect.id : known->second;
  };
  if (judged.loop && judged.evidence.families.empty()) {  // their probabilities have it already
    const bool sticks = std::ranges::any_of(result.effects, is_sticking, family_of);
    result.confidence = with_loop(*judged.loop, result.confidence, sticks);
  }
  const std::vector<Edge> edges = edges_of_text(record.input.text, record.top);
  std::vector<LeftOut> left_out = record.left_out;
  forget_explained(left_out, record.task, judged.chosen());
  add_left_out(findings,
               {.left_out = left_out, .floors = record.floors, .noise = answer.noise, .tried = options.effects}, edges,
               result);
  for (EffectFinding& effect : result.effects) {
    effect.family = family_of(effect);
  }
  result.split = split_of(result.effects, edges, ports_of(record));
  doubt({.task = record.task,
         .chosen = judged.chosen(),
         .kept = kept,
         .verdict = answer.verdict,
         .one_motion = record.one_motion,
         .is_related = judged.is_related},
        rules, result);
  const bool may_be_periodic = is_tried(options.effects, "periodic_disturbance");
  std::ranges::move(structural_reasons(result, record.given->graph.sample_time(),
                                       may_be_periodic ? longest_duration(record.task) : 0.0),
                    std::back_inserter(result.cannot_tell));
}

void add_improved(const Judged& judged, const Explanation& kept, Diagnosis& result) {
  const Cleaned& record = judged.record;
  result.improved_text = improved_text(kept.variant, record.input.program.graph.source->path);
  if (hidden_delays(result.improved_text) > hidden_delays(record.input.text)) {
    result.warnings.emplace_back(
        "The effect closes a loop, and its block cannot be called before what it reads: improved.st is taken with "
        "--any-order only.");
  }
  result.improved_file =
      improved_file(record.task, parameters::by_element(record.input.file, record.input.program.graph), kept);
}

std::vector<FrictionCurve> frictions_of(const Cleaned& record, const Explanation& quiet) {
  const Program program = fitted_program(record.task, quiet);
  Diagnostics unused;
  return friction_curves(program, drive_from(record.task.records.front(), program, {}, unused));
}

}  // namespace

Diagnosis told(const Judged& judged, const Answer& answer, const DiagnosisOptions& options, Rules& rules) {
  const Cleaned& record = judged.record;
  const Explanation& calibrated = judged.calibrated();
  // What the user gets as improved.st: effects that the verdict does not name are not in it.
  const Explanation& kept = answer.is_named() ? judged.chosen() : calibrated;
  Diagnosis result{.verdict = answer.verdict,
                   .warnings = record.warnings,
                   .siblings = options.prior.siblings(),
                   .evidence = judged.evidence,
                   .budget = judged.budget,
                   .loop = judged.loop,
                   .unknown_score = answer.unknown_score,
                   .top = record.top,
                   .tried = judged.tried};
  std::ranges::copy(judged.warnings, std::back_inserter(result.warnings));
  add_gaps(judged, answer, kept, options, result);
  result.inputs = ranges_of_inputs(record);
  result.cuts = cuts_at(record.inner, record.task, *record.base.program, materiality_of(record, options));
  add_verdict(judged, answer, kept, options, rules, result);
  result.traces = traces_of(record.task, result.gaps, record.nominal, calibrated.fit.residuals, kept.fit.residuals);
  draw_over_inputs(record.task, kept.variant.program->graph, judged.evidence, result.traces);
  const Explanation quiet = without_noise(kept, record.top);
  result.frictions = frictions_of(record, quiet);
  add_improved(judged, kept, result);
  add_outlook({.task = record.task,
               .nominal = *record.given,
               .top = record.top,
               .search = judged.searched->search,
               .judgement = judged.judgement(),
               .kept = kept,
               .options = options,
               .floor = record.floors[answer.gap_output].value},
              result);
  result.summary = judged.evidence.is_told
                       ? sentence_of(result, rules)
                       : summary_of(result, materiality_of(record, options).is_too_small(kept.fit.residuals));
  result.edges =
      where(record.task, judged.searched->search, record.top, record.unused, result.effects, options.threads);
  result.maps = maps_of(record.task, without_noise(calibrated, record.top), quiet, answer.gap_output);
  return result;
}

Diagnosis refused(const Cleaned& record) {
  return {.verdict = Verdict::Unknown,
          .summary = "No diagnosis: " + record.refusals.front(),
          .refusals = record.refusals,
          .warnings = record.warnings,
          .unknown_score = 1.0,
          .cannot_tell = record.refusals,
          .top = record.top};
}

}  // namespace hysteron::diagnosis
