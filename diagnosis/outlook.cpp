#include "diagnosis/outlook.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnosis/remedy/feedforward.hpp"
#include "diagnosis/remedy/inverse.hpp"
#include "diagnosis/remedy/next_experiment.hpp"
#include "diagnosis/search/loop_noise.hpp"

namespace hysteron::diagnosis {
namespace {

void plan(const Outlook& outlook, Diagnosis& found) {
  std::vector<Explanation> rivals;
  for (const Weighed& weighed : outlook.judgement.rivals) {
    rivals.push_back(without_noise(*weighed.explanation, outlook.top));
  }
  const bool unknown = found.verdict == Verdict::Unknown;
  if (unknown && rivals.empty() && !outlook.search.explanations.empty()) {
    rivals.push_back(without_noise(outlook.search.explanations.front(), outlook.top));
  }
  if (found.verdict != Verdict::None && found.verdict != Verdict::Calibration && !rivals.empty()) {
    found.next = next_experiment(outlook.task, rivals, outlook.options.limits, outlook.floor);
  }
  if (unknown && !found.next.reason.empty()) {
    found.next.reason = fmt::format("of what was tried, {} comes nearest, and does not explain the record; {}",
                                    fmt::join(rivals.front().names(), " + "), found.next.reason);
  }
}

void invert(const Outlook& outlook, Diagnosis& found) {
  const records::Record& record = outlook.task.records.front();
  std::vector<std::string> moving;
  for (const Port& input : outlook.nominal.graph.inputs) {
    const records::Column* const column = record.find(input.name);
    if (input.type == Type::Real && column != nullptr &&
        std::ranges::max(column->values) > std::ranges::min(column->values)) {
      moving.push_back(input.name);
    }
  }
  if (moving.empty()) {
    return;
  }
  if (found.verdict == Verdict::Unknown) {
    found.feedforward_notes.emplace_back(
        "The cause is not known: a feedforward of this diagram would take back what the machine does not do.");
    return;
  }
  const Program improved = fitted_program(outlook.task, without_noise(outlook.kept, outlook.top));
  const Feedforward feedforward = feedforward_of(improved, moving.front(), found.gap.signal, record.sample_time());
  found.feedforward_text = feedforward.text;
  found.feedforward_notes = feedforward.notes;
  if (feedforward.text.empty()) {
    found.feedforward_notes.push_back(feedforward.reason);
    return;
  }
  if (const auto tracking = predicted_tracking(outlook.nominal, improved, moving.front(), found.gap.signal, record)) {
    found.tracking_nominal = tracking->nominal;
    found.tracking_improved = tracking->improved;
  }
}

}  // namespace

void add_outlook(const Outlook& outlook, Diagnosis& found) {
  for (EffectFinding& effect : found.effects) {
    effect.inverse = inverse_of(effect.id).inverse;
  }
  plan(outlook, found);
  invert(outlook, found);
}

}  // namespace hysteron::diagnosis
