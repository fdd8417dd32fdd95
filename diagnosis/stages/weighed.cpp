#include "diagnosis/stages/weighed.hpp"

#include <algorithm>
#include <utility>

#include "diagnosis/evidence/evidence.hpp"
#include "diagnosis/evidence/explained.hpp"
#include "diagnosis/evidence/gap_budget.hpp"
#include "diagnosis/evidence/output_space.hpp"

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

}  // namespace

Judged weighed(Judged judged, const Answer& answer, const DiagnosisOptions& options, Rules& rules) {
  const Cleaned& record = judged.record;
  const Explanation& calibrated = judged.calibrated();
  const std::string& output = record.task.outputs[answer.gap_output];
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
  judged.budget = weighing.budget(output);
  for (int run = 0; run < static_cast<int>(policy::runs.value); ++run) {
    Evidence evidence = weighing.told(rules);
    if (run == 0) {
      judged.tried += evidence.tried;
    }
    evidence.is_told = is_worth_telling(evidence, rules);
    if (!evidence.is_told) {
      judged.evidence = std::move(evidence);
      break;
    }
    const Explained fitted = explained(record.task, record.top, evidence.sets.front(), calibrated,
                                       {.effects = options.effects,
                                        .columns = record.unused,
                                        .threads = options.threads,
                                        .is_open_loop = evidence.is_open_loop,
                                        .floor_cost = record.floor_cost},
                                       rules);
    if (!fitted.refuted || evidence.is_open_loop) {
      judged.choose(fitted.explanation ? *fitted.explanation : calibrated);
      judged.unrepeatable.reset();
      judged.evidence = std::move(evidence);
      break;
    }
    weighing.strike_out_first();
  }
  return judged;
}

}  // namespace hysteron::diagnosis
