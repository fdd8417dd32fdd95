#include "tool/diagnose_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <system_error>

#include "diagnosis/effects/set_words.hpp"
#include "diagnosis/evidence/gap_kinds.hpp"
#include "diagnosis/findings/control_loop.hpp"
#include "diagnosis/report/diagnosis_files.hpp"
#include "diagnosis/report/html.hpp"
#include "support/errors.hpp"

namespace hysteron::tool {
namespace {

using diagnosis::Diagnosis;
using diagnosis::ParameterFinding;

std::string with_unit(double value, const std::string& unit, int digits = 4) {
  return unit.empty() || unit == "1" ? fmt::format("{:.{}g}", value, digits)
                                     : fmt::format("{:.{}g} {}", value, digits, unit);
}

/// A share of the gap; the interval of one may end above 1, where it reads as a slip.
std::string closed_percent(double share) {
  return diagnosis::report::percent(std::min(share, 1.0));
}

std::string line_of(const ParameterFinding& one) {
  if (!std::isfinite(one.low) && !std::isfinite(one.high)) {
    return fmt::format("    {:<24} not determined: without influence in these records\n", one.name);
  }
  const auto [low, high] = diagnosis::report::interval_ends(one.low, one.high);
  return fmt::format("    {:<24} {}   ({} to {})\n", one.name, with_unit(one.value, one.unit), low, high);
}

std::string controller_text(const diagnosis::ControllerFinding& controller) {
  if (controller.different == 0) {
    std::string text = fmt::format("  controller: {} steps replayed, the same bits: no part of the gap is its own\n",
                                   controller.steps);
    for (const auto& output : controller.outputs) {
      if (output.limited_rms > 0.0) {
        text += fmt::format("    {}: limits and safe values change it by {} RMS\n", output.name,
                            with_unit(output.limited_rms, output.unit));
      }
    }
    return text;
  }
  std::string text =
      fmt::format("  controller: {} of {} steps give other bits than its diagram, the first is step {}\n",
                  controller.different, controller.steps, controller.first_different);
  for (const auto& output : controller.outputs) {
    text += fmt::format("    {}: recorded and replayed differ by {} RMS\n", output.name,
                        with_unit(output.difference_rms, output.unit));
  }
  return text;
}

/// The gap by kinds, the larger parts of it by name.
std::string budget_text(const diagnosis::GapBudget& budget) {
  constexpr double least_told = 0.05;
  std::vector<std::string_view> names;
  std::vector<double> shares;
  double others = 0.0;
  for (const diagnosis::KindFinding& one : budget.kinds) {
    if (one.share >= least_told) {
      names.push_back(std::ranges::find(diagnosis::gap_kinds, one.kind, &diagnosis::GapKindText::name)->words);
      shares.push_back(one.share);
    } else {
      others += one.share;
    }
  }
  if (others > 0.0) {
    names.emplace_back("other kinds");
    shares.push_back(others);
  }
  names.emplace_back("no kind");
  shares.push_back(1.0 - budget.closed);
  const std::vector<std::string> percents = diagnosis::report::percents_of_whole(shares);
  std::string parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", names[i], percents[i]);
  }
  return fmt::format("  gap by kind, at {}: {}\n", budget.at, parts);
}

/// What the feedforward does to the improved diagram, or why there is none; what it leaves as it is.
std::string feedforward_text(const Diagnosis& found) {
  std::string text;
  if (found.tracking_improved > 0.0) {
    const auto rms = [&](double value) { return with_unit(value, found.gap.unit, 3); };
    text += fmt::format(
        "  feedforward, run through the improved diagram: tracking error {} RMS with the model as it was, {} improved; "
        "the machine adds what this diagram leaves, {} RMS{}\n",
        rms(found.tracking_nominal), rms(found.tracking_improved), rms(found.gap.improved),
        found.tracking_improved > found.tracking_nominal ? ". The improved one is worse: keep the other" : "");
  }
  for (const std::string& note : found.feedforward_notes) {
    text += fmt::format("  {}: {}\n", found.feedforward_text.empty() ? "no feedforward.st" : "feedforward", note);
  }
  return text;
}

}  // namespace

std::string diagnosis_text(const Diagnosis& found) {
  std::string text = found.summary + "\n";
  if (!found.refusals.empty()) {
    // The summary says the first.
    for (const std::string& refusal : std::span(found.refusals).subspan(1)) {
      text += "  - " + refusal + "\n";
    }
    return text;
  }
  text += fmt::format("Verdict: {}, confidence {:.2f}, unknown {:.2f}\n", name_of(found.verdict), found.confidence,
                      found.unknown_score);
  for (const diagnosis::GapFinding& gap : found.gaps) {
    text += fmt::format("  {:<10} nominal {}  calibrated {}  improved {}  floor {} ({})\n", gap.signal,
                        with_unit(gap.nominal, gap.unit), with_unit(gap.calibrated, gap.unit),
                        with_unit(gap.improved, gap.unit), with_unit(gap.floor.value, gap.unit), gap.floor.evidence);
    text += fmt::format("  {:<10} closed {} ({} to {}) on blocks held out\n", "", closed_percent(gap.closed),
                        closed_percent(gap.closed_low), closed_percent(gap.closed_high));
  }
  if (found.loop) {
    text += fmt::format("  control loop: {}\n", sentence_of(*found.loop));
  }
  if (found.budget) {
    text += budget_text(*found.budget);
  }
  for (const diagnosis::EffectFinding& effect : found.effects) {
    text += fmt::format("  {} at {}{}{}: {:.0f} % of the gap{}\n", effect.id, effect.edge,
                        effect.same_edges.empty() ? "" : fmt::format(" (or {})", fmt::join(effect.same_edges, ", ")),
                        effect.drivers.empty() ? "" : fmt::format(", driven by {}", fmt::join(effect.drivers, ", ")),
                        100.0 * effect.share,
                        effect.around_plant ? " at the outputs, around the plant, beside the 100 % of the others" : "");
    for (const ParameterFinding& one : effect.parameters) {
      text += line_of(one);
    }
    for (const diagnosis::SettingFinding& one : effect.settings) {
      text += fmt::format("    {:<24} {}   (chosen, not fitted)\n", one.name, with_unit(one.value, one.unit));
    }
  }
  if (!found.effects.empty()) {
    const auto percents =
        diagnosis::report::percents_of_whole({found.split.input_output, found.split.plant, found.split.open});
    text +=
        fmt::format("  of the gap: inputs and outputs {}, plant {}, open {}\n", percents[0], percents[1], percents[2]);
  }
  if (found.controller) {
    text += controller_text(*found.controller);
  }
  if (found.rivals.size() > 1) {
    text += "  not ruled out:\n";
    for (const diagnosis::Rival& rival : found.rivals) {
      const std::string set = diagnosis::words_of_set(rival.effects) +
                              (rival.effects.empty() ? "" : fmt::format(" at {}", fmt::join(rival.edges, ", ")));
      text += fmt::format("    {:<44} probability {:.2f}\n", set, rival.probability);
    }
  }
  for (std::size_t i = 0; i < found.edges.size() && i < 5; ++i) {
    text += fmt::format(
        "  edge {:<20} {} of the gap{}\n", found.edges[i].edge, closed_percent(found.edges[i].share),
        found.edges[i].group.empty() ? "" : fmt::format(", as at {}", fmt::join(found.edges[i].group, ", ")));
  }
  for (const diagnosis::CutFinding& cut : found.cuts) {
    text += fmt::format("  {} {}\n", cut.signal,
                        cut.agrees ? "agrees with its column: the gap lies behind it"
                                   : "does not agree with its column: a gap lies before it");
  }
  text += feedforward_text(found);
  if (!found.next.reason.empty()) {
    text += fmt::format("  next experiment: {} ({})\n", found.next.title.empty() ? "none" : found.next.title,
                        found.next.reason);
  }
  for (std::size_t i = 0; found.traces.size() > 1 && i < found.traces.size(); ++i) {
    text += fmt::format("  {}: {} of {}\n", diagnosis::traces_file(i + 1, found.traces.size()), found.traces[i].signal,
                        found.traces[i].record);
  }
  for (const std::string& warning : found.warnings) {
    text += "  note: " + warning + "\n";
  }
  for (const diagnosis::Decision& one : found.decisions) {
    text += fmt::format("  rule: {}{}: measured {:.3g}, threshold {:.3g}{}: {}\n", one.rule,
                        one.about.empty() ? "" : fmt::format(" ({})", one.about), one.measured, one.threshold,
                        one.unit == "1" ? "" : " " + one.unit, one.outcome);
  }
  return text + fmt::format("{} candidates, {:.1f} s\n", found.tried, found.seconds);
}

void write_diagnosis(const std::filesystem::path& folder, const Diagnosis& found) {
  const std::vector<OutputFile> files = diagnosis::diagnosis_files(folder, found);
  write_files_atomically(files);
  std::vector<std::filesystem::path> stale;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const bool written = std::ranges::any_of(
        files, [&](const OutputFile& file) { return file.path.filename() == entry.path().filename(); });
    if (!written && diagnosis::is_diagnosis_file(entry.path().filename().string()) &&
        (entry.is_regular_file() || entry.is_symlink())) {
      stale.push_back(entry.path());
    }
  }
  for (const std::filesystem::path& file : stale) {
    std::error_code failure;
    if (!std::filesystem::remove(file, failure) && failure) {
      throw InputError(error::unwritable_file, {.file = file.string()},
                       fmt::format("{} is left of an earlier diagnosis and cannot be removed: {}.", file.string(),
                                   failure.message()),
                       "remove it: it does not belong to this verdict.");
    }
  }
}

}  // namespace hysteron::tool
