#include "diagnosis/stages/weighed.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "diagnosis/evidence/evidence.hpp"
#include "diagnosis/evidence/explained.hpp"
#include "diagnosis/evidence/gap_budget.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/findings/control_loop.hpp"
#include "diagnosis/stages/proposals.hpp"

namespace hysteron::diagnosis {
namespace {

/// Whether what is left is more than the little by which a formula errs.
bool leaves_a_cause(const Judged& judged, const Answer& answer, Rules& rules) {
  const double floor = judged.record.floor_cost;
  const double left = judged.chosen().fit.cost - floor;
  const double gap = std::max(judged.calibrated().fit.cost - floor, left);
  return judged.is_related && (answer.verdict == Verdict::Partial || answer.verdict == Verdict::Unknown) &&
         rules.is_above(policy::unexplained, left / gap);
}

std::string leading_effect(const SetFinding& set) {
  return set.laws.empty() ? std::string() : std::ranges::max(set.laws, {}, &LawFinding::closed).effect;
}

/// The most probable set that a run of the whole diagram does not refute and, of the further ones, the most probable
/// for each effect that closes the largest part of one: of two frictions that leave the same of what is missing, a run
/// may know one from the other.
Told told_in(Weighing& weighing, std::size_t view, const Judged& judged, const DiagnosisOptions& options,
             Rules& rules) {
  const Cleaned& record = judged.record;
  Told result{.view = view};
  const auto run = [&](const SetFinding& set) {
    return explained(record.task, record.top, set, judged.calibrated(),
                     {.effects = options.effects,
                      .columns = record.unused,
                      .threads = options.threads,
                      .is_open_loop = result.evidence.is_open_loop,
                      .floor_cost = record.floor_cost},
                     rules);
  };
  auto left = static_cast<int>(policy::runs.value);
  while (left > 0 && !result.evidence.is_told) {
    result.evidence = weighing.told(rules, view);
    if (!is_worth_telling(result.evidence, rules)) {
      return result;
    }
    const SetFinding& first = result.evidence.sets.front();
    if (!first.laws.empty()) {  // no effect is a proposal of its own: proposals.hpp
      --left;
      Explained found = run(first);
      result.evidence.is_told = !found.refuted || result.evidence.is_open_loop;
      result.runs = std::move(found.runs);
    }
    if (!result.evidence.is_told) {
      weighing.strike_out_first(view);
    }
  }
  if (result.evidence.is_open_loop || !result.evidence.is_told) {
    return result;
  }
  std::set<std::string> leading{std::string(), leading_effect(result.evidence.sets.front())};
  for (const SetFinding& set : result.evidence.sets) {
    if (left > 0 && leading.insert(leading_effect(set)).second) {
      --left;
      std::ranges::move(run(set).runs, std::back_inserter(result.runs));
    }
  }
  return result;
}

}  // namespace

Judged weighed(Judged judged, const Answer& answer, const DiagnosisOptions& options, Rules& rules) {
  const Cleaned& record = judged.record;
  const Explanation& calibrated = judged.calibrated();
  const std::string& output = record.task.outputs[answer.gap_output];
  judged.loop = control_loop(record.task, *record.given, rules);
  if (!leaves_a_cause(judged, answer, rules)) {
    if (answer.verdict != Verdict::None && answer.verdict != Verdict::Calibration) {
      const OutputSpace outputs(record.task, record.top, calibrated, record.unused, options.threads);
      judged.budget = gap_budget(record.task, outputs, output, options.threads);
    }
    return judged;
  }
  Weighing weighing(record.task, record.top, calibrated,
                    {.effects = options.effects,
                     .columns = record.unused,
                     .threads = options.threads,
                     .seed = options.seed,
                     .prior = options.prior});
  std::vector<Told> told;
  std::size_t shown = 0;  // the view whose gap is shown by kinds
  Evidence untold;
  for (std::size_t view = 0; view < weighing.views(); ++view) {
    Told one = told_in(weighing, view, judged, options, rules);
    if (view == 0) {
      judged.tried += one.evidence.tried;
      untold = one.evidence;
    }
    const bool is_open_loop = one.evidence.is_open_loop;
    if (one.evidence.is_told) {
      told.push_back(std::move(one));
    }
    if (is_open_loop) {
      break;
    }
  }
  // A run of the loop is no judge of a plant that was taken out of it: the loop hides the plant.
  const bool is_open_loop = !told.empty() && told.front().evidence.is_open_loop;
  Runs runs = runs_of(told, judged, options, rules);
  if (judged.loop) {
    weigh_by_loop(*judged.loop, runs);
  }
  if (is_open_loop || runs.are_for_told()) {
    const std::size_t at = is_open_loop ? 0 : runs.best_told();
    const Told& best = told[at];
    shown = best.view;
    judged.evidence = best.evidence;
    if (best.runs.empty()) {
      judged.choose(calibrated);
    } else {
      const FittedSet& run = is_open_loop ? best.runs.back() : best.runs[runs.best_set_of(at) - runs.begins[at]];
      put_first(run.set, judged.evidence.sets);
      judged.choose(run.fitted);
    }
    judged.unrepeatable.reset();
  } else if (!runs.searched.empty()) {
    shown = weighing.views() - 1;
    judged.evidence = evidence_of_search(runs, record.task);
    if (const std::size_t best = runs.best_searched(); best != runs.told()) {  // the first one is chosen already
      judged.choose(*runs.searched[best - runs.told()]);
      judged.unrepeatable.reset();
    }
  } else {
    judged.evidence = std::move(untold);
    judged.evidence.is_told = false;
  }
  if (!is_open_loop && runs.nothing() > 0) {
    weigh_families(runs, told, judged.evidence);
  }
  judged.budget = weighing.budget(shown, output);
  return judged;
}

}  // namespace hysteron::diagnosis
