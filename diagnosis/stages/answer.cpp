#include "diagnosis/stages/answer.hpp"

#include "diagnosis/findings/gaps.hpp"
#include "diagnosis/model/model.hpp"
#include "diagnosis/noise/remainder.hpp"

namespace hysteron::diagnosis {
namespace {

/// Whether more is left of the gap than the name of a cause may leave.
bool is_much_left(const Remainder& left, Rules& rules) {
  return (left.is_predictable && rules.is_above(policy::mostly_open, left.open)) ||
         (rules.is_above(policy::notably_open, left.open) && rules.is_above(policy::twice_noise, left.size)) ||
         rules.is_above(policy::far_above, left.size);
}

/// Whether what is left of a gap without a name is a cause; less above the noise is no claim that something is unknown.
bool is_unknown(const Remainder& left, bool has_repeats, Rules& rules) {
  return rules.is_above(has_repeats ? policy::suspicious : policy::hidden_noise, left.size) &&
         (left.is_predictable || rules.is_above(policy::far_above, left.size));
}

}  // namespace

Answer answer_of(const Judged& judged, const DiagnosisOptions& options, Rules& rules) {
  const Cleaned& record = judged.record;
  const Materiality materiality = materiality_of(record, options);
  const Explanation& chosen = judged.chosen();
  const VectorXd& calibrated = judged.calibrated().fit.residuals;
  const bool has_effect = !chosen.variant.effects.empty();
  const bool gap_before = materiality.is_left(record.nominal);
  const bool gap_calibrated = materiality.is_left(calibrated) ||
                              (has_effect && materiality.was_taken_for_noise(calibrated, chosen.fit.residuals));
  const VectorXd& residuals = judged.residuals();
  const bool gap_left = materiality.is_left(residuals);

  Answer answer{.gap_output = largest_gap(record.task, record.floors, record.nominal)};
  const Model model(record.task, *record.given);
  answer.noise = possible_noise(model, record.floors, chosen.fit.residuals);
  const Remainder left = remainder_of(model, calibrated, residuals, answer.noise);
  answer.predictable = gap_left ? left.share : 0.0;
  const NoiseFloor& floor = record.floors[answer.gap_output];
  answer.unexplained =
      rms_of(record.task, residuals, answer.gap_output) / (floor.value * answer.noise[answer.gap_output]);
  if (!judged.is_related) {
    return answer;
  }
  answer.unknown_score = unknown_score(left, probability_of_cause(judged.judgement()));
  if (judged.evidence.is_told) {
    answer.verdict = Verdict::Partial;
  } else if (has_effect && gap_calibrated) {
    answer.verdict = gap_left && is_much_left(left, rules)  ? Verdict::Partial
                     : judged.judgement().rivals.size() > 1 ? Verdict::Group
                                                            : Verdict::Named;
  } else if (gap_calibrated && is_unknown(left, floor.evidence == "repeats", rules)) {
    answer.verdict = Verdict::Unknown;
  } else if (gap_before &&
             calibration_matters(record.task, record.floors, options.material, record.nominal, calibrated)) {
    answer.verdict = Verdict::Calibration;
  } else {
    answer.verdict = Verdict::None;
  }
  return answer;
}

}  // namespace hysteron::diagnosis
