#include "diagnosis/diagnose.hpp"

#include <chrono>
#include <utility>

#include "diagnosis/model/budget.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/rules.hpp"
#include "diagnosis/stages/answer.hpp"
#include "diagnosis/stages/cleaned.hpp"
#include "diagnosis/stages/hypotheses.hpp"
#include "diagnosis/stages/judged.hpp"
#include "diagnosis/stages/told.hpp"
#include "diagnosis/stages/weighed.hpp"

namespace hysteron::diagnosis {
namespace {

/// Each stage is one function from a value that no later one changes to the next.
Diagnosis diagnosed(const DiagnosisInput& input, const DiagnosisOptions& options, Rules& rules) {
  Cleaned record = cleaned(input, options);
  if (!record.refusals.empty()) {
    return refused(record);
  }
  Budget budget(record.task.effort, options.effort * policy::work.value, options.time_limit);
  Hypotheses found = hypotheses(std::move(record), options, budget);
  Judged choice = judged(std::move(found), options, budget);
  const Answer first = answer_of(choice, options, rules);
  choice = weighed(std::move(choice), first, options, rules);
  const Answer answer = !choice.evidence.families.empty() ? answer_of(choice, options, rules) : first;
  Diagnosis result = told(choice, answer, options, rules);
  result.work = choice.record.task.effort->spent();
  return result;
}

}  // namespace

Diagnosis diagnose(const DiagnosisInput& input, const DiagnosisOptions& options) {
  const auto begun = std::chrono::steady_clock::now();
  Rules rules(options.without);
  Diagnosis result = diagnosed(input, options, rules);
  if (options.explain) {
    result.decisions = rules.decisions();
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace hysteron::diagnosis
