#include "diagnosis/stages/cleaned.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "codegen/parameters/apply.hpp"
#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/faults/fast_clock.hpp"
#include "diagnosis/faults/record_check.hpp"
#include "diagnosis/findings/gaps.hpp"
#include "diagnosis/findings/inner_signals.hpp"
#include "diagnosis/noise/noise_floors.hpp"
#include "diagnosis/search/loop_noise.hpp"

namespace hysteron::diagnosis {

Cleaned cleaned(const DiagnosisInput& input, const DiagnosisOptions& options) {
  Cleaned record;
  std::vector<std::string> unmatched;
  const DiagnosisInput named = with_named_drivers(input, unmatched);
  std::ranges::move(unmatched_columns(named), std::back_inserter(unmatched));
  record.input = with_inner_signals(named, record.inner);
  record.task = task_of(record.input);
  record.top = record.input.program.graph.name;
  // With the file's values: an effect that it switches on is there already.
  auto program = std::make_shared<Program>(record.input.program);
  parameters::apply(record.task.file, program->graph);
  record.given = std::move(program);
  record.base = {.text = record.input.text, .program = record.given};
  record.refusals = absurd_samples(record.task, record.given->graph);
  if (!record.refusals.empty()) {
    return record;
  }
  record.unused = unused_columns(record.task, *record.given);
  find_floors(record);
  record.left_out = leave_out(record.task, *record.given);
  Model scaled(record.task, *record.given);
  if (!scaled.residuals(scaled.start(), record.nominal)) {
    throw InputError(error_of_start(record.input));
  }
  RecordCheck checked = check_records(record.task, scaled, record.nominal);
  record.refusals = std::move(checked.refusals);
  record.warnings = std::move(checked.warnings);
  std::ranges::move(unmatched, std::back_inserter(record.warnings));
  record.one_motion = checked.one_motion;
  std::ranges::copy(checked.left_out, std::back_inserter(record.task.left_out));
  if (LoopNoise noise = with_loop_noise(record.task, record.base, record.top); !noise.remark.empty()) {
    record.base = std::move(noise.base);
    record.warnings.push_back(std::move(noise.remark));
  }
  if (std::optional<FastClock> clock =
          is_tried(options.effects, "clock") ? fast_clock(record.task, *record.base.program) : std::nullopt) {
    record.task = std::move(clock->task);
    record.left_out.push_back(std::move(clock->finding));
  }
  simulate_nominal(record);
  std::ranges::move(remarks_on_floors(record.task, record.floors), std::back_inserter(record.warnings));
  return record;
}

void find_floors(Cleaned& record) {
  record.floors = noise_floors(record.task, *record.given, columns_by_record(record.task, record.unused));
  record.task.scales.clear();
  std::ranges::transform(record.floors, std::back_inserter(record.task.scales), &NoiseFloor::value);
}

void simulate_nominal(Cleaned& record) {
  Task measured = record.task;  // as it was given: its records may have been mended since
  for (std::size_t i = 0; i < measured.records.size(); ++i) {
    for (const std::string& output : measured.outputs) {
      measured.records[i].replace(output, record.input.records[i].column(output).values);
    }
  }
  Model model(measured, *record.base.program);
  (void)model.residuals(model.start(), record.nominal);  // finite before
  for (const Index row : record.task.left_out) {
    record.nominal[row] = 0.0;
  }
  record.floor_cost = 0.5 * static_cast<double>(record.nominal.size() - std::ssize(record.task.left_out));
}

}  // namespace hysteron::diagnosis
