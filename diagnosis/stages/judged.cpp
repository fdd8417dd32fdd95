#include "diagnosis/stages/judged.hpp"

#include <utility>

#include "diagnosis/findings/findings.hpp"
#include "diagnosis/verdict/harmonics.hpp"
#include "diagnosis/verdict/plausibility.hpp"
#include "diagnosis/verdict/unrepeatable.hpp"

namespace hysteron::diagnosis {

void Judged::choose(const Explanation& one) {
  instead.push_back(std::make_shared<const Explanation>(one));
  choose_instead(record.task, *instead.back(), searched->judgement);
}

namespace {

/// Where the record has next to nothing to do with the diagram, no effect is chosen.
void judge_related(Judged& result) {
  Judgement& judgement = result.searched->judgement;
  const Explanation& calibrated = result.calibrated();
  std::string reason = unrelated(result.record.task, calibrated, *judgement.chosen, judgement.effective_samples);
  if (reason.empty()) {
    return;
  }
  result.warnings.push_back(std::move(reason));
  judgement = {.chosen = &calibrated,
               .effective_samples = judgement.effective_samples,
               .held_out = held_out(result.record.task, calibrated)};
  result.is_related = false;
}

}  // namespace

Judged judged(Hypotheses found, const DiagnosisOptions& options, Budget& budget) {
  Judged result{.record = std::move(found.record),
                .searched = std::move(found.searched),
                .tried = found.tried,
                .warnings = std::move(found.warnings)};
  const Cleaned& record = result.record;
  judge_related(result);
  const SearchOptions asked = search_options(record, options, budget);
  if (const auto lines = with_all_lines(record.task, record.top, asked.candidates, *result.searched)) {
    result.choose(*lines);
  }
  result.unrepeatable = unrepeatable(record.task, record.top, result.searched->search, record.floor_cost, asked,
                                     materiality_of(record, options), budget, result.searched->judgement);
  if (result.unrepeatable) {
    result.warnings.push_back(result.unrepeatable->remark);
  }
  const std::size_t tried = result.searched->search.tried;
  if (budget.has_cut_time()) {
    result.warnings.push_back(warning_of_time_limit(options.time_limit, tried));
  } else if (budget.has_cut_work()) {
    result.warnings.push_back(warning_of_effort(options.effort, tried));
  }
  return result;
}

}  // namespace hysteron::diagnosis
