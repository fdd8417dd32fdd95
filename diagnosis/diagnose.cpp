#include "diagnosis/diagnose.hpp"

#include <chrono>
#include <filesystem>
#include <utility>

#include "codegen/graph/fmu_block.hpp"
#include "codegen/graph/fmu_files.hpp"
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

/// With the files of FMUs named from the root: the texts of candidates have no folder of their own.
DiagnosisInput with_whole_paths(const DiagnosisInput& input) {
  DiagnosisInput result = input;
  const language::SourceFile& source = *input.program.graph.source;
  result.text = with_fmu_files(
      source, [&](std::string_view file) { return std::filesystem::absolute(fmu_path(source, file)).string(); });
  result.program = compile_text(result.text, {.top = input.program.graph.name, .any_order = true, .path = source.path});
  return result;
}

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
  Diagnosis result = diagnosed(has_fmu(input.program.graph) ? with_whole_paths(input) : input, options, rules);
  if (options.explain) {
    result.decisions = rules.decisions();
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace hysteron::diagnosis
