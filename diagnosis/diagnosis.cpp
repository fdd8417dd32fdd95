#include "diagnosis/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>

#include "codegen/parameters/apply.hpp"
#include "diagnosis/discrepancy.hpp"
#include "diagnosis/feedforward.hpp"
#include "diagnosis/findings.hpp"
#include "diagnosis/glitches.hpp"
#include "diagnosis/held_out.hpp"
#include "diagnosis/inner_signals.hpp"
#include "diagnosis/inverse.hpp"
#include "diagnosis/maps.hpp"
#include "diagnosis/next_experiment.hpp"
#include "diagnosis/plausibility.hpp"
#include "diagnosis/record_check.hpp"
#include "diagnosis/search.hpp"
#include "diagnosis/start_state.hpp"
#include "diagnosis/task.hpp"
#include "diagnosis/verdict.hpp"
#include "diagnosis/where.hpp"

namespace hysteron::diagnosis {
namespace {

/// A floor is an estimate: that of slow noise is off by a tenth, even from repeats. Less above it is no claim that
/// something is unknown.
constexpr double above_floor = 1.2;
/// The same of a floor from differences, which see fast noise only: in one trial of twenty it is below 0.61 of the
/// noise.
constexpr double above_fast_floor = 2.0;
/// A residual of this many floors is no noise, whether or not anything predicts it; of more where the floor
/// is that of the fast part alone.
constexpr double far_above_floor = 3.0;
constexpr double far_above_fast_floor = 4.0;
/// The confidence of a verdict on a record that holds one motion only is no higher.
constexpr double sure_of_one_motion = 0.8;
/// Nor where the begin of the record is not explained: what is named may stand for another state at the start.
constexpr double sure_of_missed_start = 0.5;

using Clock = std::chrono::steady_clock;

class Run {
 public:
  Run(const DiagnosisInput& input, const DiagnosisOptions& options)
      : input_(with_inner_signals(input, inner_)), options_(options) {}

  Diagnosis run() {
    const auto begun = Clock::now();
    prepare();
    if (result_.refusals.empty()) {
      investigate(begun);
    } else {
      result_.verdict = Verdict::Unknown;
      result_.unknown_score = 1.0;
      result_.cannot_tell = result_.refusals;
      result_.summary = "No diagnosis: " + result_.refusals.front();
    }
    result_.seconds = std::chrono::duration<double>(Clock::now() - begun).count();
    return std::move(result_);
  }

 private:
  void prepare() {
    task_ = task_of(input_);
    result_.top = input_.program.graph.name;
    // With the file's values: an effect that it switches on is there already.
    auto program = std::make_shared<Program>(input_.program);
    parameters::apply(task_.file, program->graph);
    base_ = {.text = input_.text, .program = std::move(program)};
    Model model(task_, *base_.program);
    floors_.clear();
    unused_ = unused_columns(task_, *base_.program);
    std::vector<std::vector<Signal>> others;
    for (const records::Record& record : task_.records) {
      others.emplace_back();
      for (const std::string& name : unused_) {
        others.back().push_back(record.column(name).values);
      }
    }
    for (std::size_t output = 0; output < model.problem().outputs.size(); ++output) {
      floors_.push_back(noise_floor(model.problem().experiments, output, others));
      task_.scales.push_back(floors_.back().value);
      glitches_.push_back(find_glitches(model.problem().experiments, output));
      const Index rows = model.rows() / std::ssize(model.problem().outputs);
      for (const std::size_t row : glitches_.back().rows) {
        task_.left_out.push_back(static_cast<Index>(output) * rows + static_cast<Index>(row));
      }
    }
    Model scaled(task_, *base_.program);
    if (!scaled.residuals(scaled.start(), nominal_)) {
      throw InputError(error_of_start(input_));
    }
    RecordCheck checked = check_records(task_, scaled, nominal_);
    result_.refusals = std::move(checked.refusals);
    result_.warnings = std::move(checked.warnings);
    one_motion_ = checked.one_motion;
    if (!checked.left_out.empty()) {
      task_.left_out.insert(task_.left_out.end(), checked.left_out.begin(), checked.left_out.end());
      Model spared(task_, *base_.program);
      (void)spared.residuals(spared.start(), nominal_);
    }
    for (std::size_t output = 0; output < floors_.size(); ++output) {
      if (floors_[output].evidence == "differences") {
        result_.warnings.push_back(fmt::format(
            "The noise floor of {} rests on its fast part alone: no input repeats or dwells. Slow noise would "
            "count as a gap.",
            task_.outputs[output]));
      }
    }
    floor_cost_ = 0.5 * static_cast<double>(nominal_.size() - std::ssize(task_.left_out));
  }

  void investigate(Clock::time_point begun) {
    SearchOptions searching{.threads = options_.threads, .most_effects = options_.most_effects};
    searching.candidates.effects = options_.effects;
    searching.candidates.columns = unused_;
    searching.progress = options_.progress;
    searching.out_of_time = [&] {
      return std::chrono::duration<double>(Clock::now() - begun).count() > options_.budget;
    };
    const std::string top = base_.program->graph.name;
    auto searched = std::make_unique<Searched>(task_, search(task_, base_, top, floor_cost_, searching), floor_cost_);
    result_.tried = searched->search.tried;
    search_from_another_start(searched, [&] {
      // Half of the time once more: the search has its best sets to find again.
      begun = std::max(begun, Clock::now() - std::chrono::duration_cast<Clock::duration>(
                                                 std::chrono::duration<double>(0.5 * options_.budget)));
      return search(task_, base_, top, floor_cost_, searching);
    });
    const Search& found = searched->search;
    if (std::string reason = unrelated(task_, found.calibrated, *searched->judgement.chosen); !reason.empty()) {
      result_.warnings.push_back(std::move(reason));
      searched->judgement = {.chosen = &found.calibrated,
                             .effective_samples = searched->judgement.effective_samples,
                             .held_out = held_out(task_, found.calibrated)};
      related_ = false;
    }
    const Judgement& judgement = searched->judgement;
    const Explanation& chosen = *judgement.chosen;
    describe_gap(found.calibrated, judgement);
    describe_cuts();
    decide(found, judgement);
    result_.edges = where(task_, found.calibrated, top, options_.threads);
    result_.maps = maps_of(task_, found.calibrated, chosen);
    describe(found, judgement);
  }

  /// Where another state at the start explains the record better, with fewer effects or closer, the search is done
  /// again with it, and stands if it is the better one in the end.
  template <class Again>
  void search_from_another_start(std::unique_ptr<Searched>& searched, const Again& again) {
    const Judgement& first = searched->judgement;
    std::optional<Task> free = material(nominal_)
                                   ? with_free_start(task_, searched->search, first, floor_cost_, options_.threads)
                                   : std::nullopt;
    if (!free) {
      return;
    }
    const auto more = std::ssize(free->initial_states) - std::ssize(task_.initial_states);
    const auto support = [&](const Explanation& one, Index states) {
      return support_of(one.fit.cost, one.parameters() + states * std::ssize(task_.records), one.variant.effects.size(),
                        first.weighing_samples, searched->search.tried);
    };
    std::swap(task_, *free);
    auto second = std::make_unique<Searched>(task_, again(), floor_cost_);
    result_.tried += second->search.tried;
    if (support(*second->judgement.chosen, more) > support(*first.chosen, 0)) {
      result_.warnings.push_back(words_of_start(task_, *second->judgement.chosen));
      searched = std::move(second);
    } else {
      std::swap(task_, *free);
    }
  }

  [[nodiscard]] double rms(const VectorXd& residuals, std::size_t output) const {
    return rms_of(task_, residuals, output);
  }

  void describe_gap(const Explanation& calibrated, const Judgement& judgement) {
    const auto before = by_blocks(task_, nominal_);
    const auto after = by_blocks(task_, judgement.held_out);
    double largest = -1.0;
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      const Port& port = *std::ranges::find_if(input_.program.graph.outputs, [&](const Port& one) {
        return language::same_name(one.name, task_.outputs[output]);
      });
      GapFinding gap{.signal = port.name,
                     .unit = port.unit,
                     .nominal = rms(nominal_, output),
                     .calibrated = rms(calibrated.fit.residuals, output),
                     .improved = rms(judgement.chosen->fit.residuals, output),
                     .floor = floors_[output]};
      const double left = gap.improved / task_.scales[output];
      const Closure share = closure(before[output], after[output], left * left, noise_range(left), options_.seed);
      gap.closed = share.closed;
      gap.closed_low = share.low;
      gap.closed_high = share.high;
      if (const double size = gap.nominal / gap.floor.value; size > largest) {
        largest = size;
        result_.gap = gap;
      }
      result_.gaps.push_back(gap);
    }
  }

  /// Whether something remains of an output's residuals, beyond the floor, that matters to the user.
  [[nodiscard]] bool material(const VectorXd& residuals, std::size_t output) const {
    const double floor = floors_[output].value;
    const double here = rms(residuals, output);
    const double excess = std::sqrt(std::max(0.0, here * here - floor * floor));
    return excess > std::max(0.35 * floor, options_.material);
  }
  [[nodiscard]] bool material(const VectorXd& residuals) const {
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      if (material(residuals, output)) {
        return true;
      }
    }
    return false;
  }

  /// A cut agrees where the diagram before it, with its parameters refitted to this signal alone, explains it.
  void describe_cuts() {
    Model model(task_, *base_.program);
    const Index rows = model.rows() / std::ssize(task_.outputs);
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      if (std::ranges::find(inner_, task_.outputs[output]) == inner_.end()) {
        continue;
      }
      VectorXd weights = VectorXd::Zero(model.rows());
      weights.segment(static_cast<Index>(output) * rows, rows).setOnes();
      const Fit alone = fit(model, model.start(), {.iterations = 20, .weights = &weights});
      result_.cuts.push_back(
          {.signal = task_.outputs[output], .agrees = std::isfinite(alone.cost) && !material(alone.residuals, output)});
    }
  }

  void decide(const Search& found, const Judgement& judgement) {
    const Explanation& chosen = *judgement.chosen;
    const bool has_effect = !chosen.variant.effects.empty();
    const bool gap_before = material(nominal_);
    const bool gap_calibrated = material(found.calibrated.fit.residuals);
    const bool gap_left = material(chosen.fit.residuals);

    const Model model(task_, *base_.program);
    const Discrepancy left = discrepancy_of(model, chosen.fit.residuals);
    const double size = chosen.fit.residuals.norm() / std::sqrt(static_cast<double>(chosen.fit.residuals.size()));
    const bool predictable = left.share_low > 0.02 && left.rms > 0.25 * std::min(size, 4.0);
    predictable_ = gap_left ? std::max(left.share, 0.0) : 0.0;
    const double open = open_share(found, chosen);
    result_.unknown_score = std::pow(open, 0.25) * excess_of(size);

    if (!related_) {
      result_.verdict = Verdict::Unknown;
      result_.unknown_score = 1.0;
    } else if (has_effect && gap_calibrated) {
      const bool much_left = (open > 0.5 && predictable) || (open > 0.1 && size > 2.0) || size > far_above();
      if (gap_left && much_left) {
        result_.verdict = Verdict::Partial;
      } else {
        result_.verdict = judgement.rivals.size() > 1 ? Verdict::Group : Verdict::Named;
      }
    } else if (gap_calibrated && size > least_above() && (predictable || size > far_above())) {
      result_.verdict = Verdict::Unknown;
    } else if (gap_before && calibration_matters(found.calibrated)) {
      result_.verdict = Verdict::Calibration;
    } else {
      result_.verdict = Verdict::None;
    }
  }

  /// Of what is left, as a multiple of the floor, the share of its energy that no noise explains which the floor
  /// misses.
  [[nodiscard]] double excess_of(double size) const {
    const double hidden = std::max(hidden_noise, least_above());
    return 1.0 - std::pow(hidden / std::max(size, hidden), 2);
  }
  [[nodiscard]] double least_above() const {
    const std::string& evidence = result_.gap.floor.evidence;
    return evidence == "repeats" ? above_floor : evidence == "differences" ? above_fast_floor : hidden_noise;
  }
  [[nodiscard]] double far_above() const {
    return result_.gap.floor.evidence == "differences" ? far_above_fast_floor : far_above_floor;
  }

  /// Of the gap that calibration leaves, what the verdict leaves open.
  [[nodiscard]] double open_share(const Search& found, const Explanation& chosen) const {
    const double gap = found.calibrated.fit.cost - floor_cost_;
    return gap > 0.0 ? std::clamp((chosen.fit.cost - floor_cost_) / gap, 0.0, 1.0) : 0.0;
  }

  [[nodiscard]] Discrepancy discrepancy_of(const Model& model, const VectorXd& residuals) const {
    const Index rows = residuals.size() / std::ssize(task_.outputs);
    Discrepancy largest;
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      const Discrepancy here =
          discrepancy(model.problem().experiments, residuals.segment(static_cast<Index>(output) * rows, rows));
      if (here.rms > largest.rms) {
        largest = here;
      }
    }
    return largest;
  }

  /// Whether the refit closed something material.
  [[nodiscard]] bool calibration_matters(const Explanation& calibrated) const {
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      const double before = rms(nominal_, output);
      const double after = rms(calibrated.fit.residuals, output);
      const double closed = std::sqrt(std::max(0.0, before * before - after * after));
      if (closed > std::max(0.25 * floors_[output].value, options_.material)) {
        return true;
      }
    }
    return false;
  }

  void describe(const Search& found, const Judgement& judgement) {
    const Findings findings{
        .task = task_, .search = found, .judgement = judgement, .floor_cost = floor_cost_, .predictable = predictable_};
    result_.calibration = calibration_findings(findings);
    result_.nominal = nominal_findings(task_);
    const bool named =
        result_.verdict == Verdict::Named || result_.verdict == Verdict::Group || result_.verdict == Verdict::Partial;
    if (named) {
      result_.effects = effect_findings(findings);
      result_.rivals = rival_findings(findings);
    }
    const Explanation& kept = named ? *judgement.chosen : found.calibrated;
    if (result_.verdict != Verdict::Partial && result_.verdict != Verdict::Unknown) {  // they say it already
      std::ranges::move(far_parameters(task_, kept), std::back_inserter(result_.warnings));
    }
    result_.fitted = fitted_findings(findings);
    result_.confidence = confidence(findings, result_);
    const std::vector<Edge> edges = chosen_edges();
    add_glitches(edges);
    result_.split = split_of(result_.effects, edges, ports());
    if (one_motion_) {
      result_.confidence = std::min(result_.confidence, sure_of_one_motion);
    }
    if (std::string reason = unexplained_start(task_, *judgement.chosen); !reason.empty() && related_) {
      result_.warnings.push_back(std::move(reason));
      result_.confidence = std::min(result_.confidence, sure_of_missed_start);
    }
    for (std::string& reason : structural_reasons(result_)) {
      result_.cannot_tell.push_back(std::move(reason));
    }
    result_.traces = traces_of(task_, nominal_, found.calibrated.fit.residuals, judgement.chosen->fit.residuals);
    result_.improved_text = improved_text(kept, input_.program.graph.source->path);
    result_.improved_file = improved_file(task_, input_.file, kept);
    plan(found, judgement, kept);
    result_.summary = summary_of(result_);
  }

  /// Edges of the diagram as given, to name the one that a measured output hangs on.
  [[nodiscard]] std::vector<Edge> chosen_edges() const {
    Diagnostics diagnostics;
    const auto source = std::make_shared<const language::SourceFile>(language::parse("text", input_.text, diagnostics));
    const Definitions definitions = define(source, diagnostics);
    return edges_of(definitions, top_definition(definitions, base_.program->graph.name));
  }

  [[nodiscard]] std::vector<std::string> ports() const {
    std::vector<std::string> names = task_.outputs;
    for (const Port& input : input_.program.graph.inputs) {
      names.push_back(input.name);
    }
    return names;
  }

  /// Glitches are counted, not fitted: an effect of their own where they outweigh the noise, else a remark.
  void add_glitches(const std::vector<Edge>& edges) {
    for (std::size_t output = 0; output < glitches_.size(); ++output) {
      const Glitches& found = glitches_[output];
      if (found.rows.empty()) {
        continue;
      }
      const double ratio = found.rms / floors_[output].value;
      result_.warnings.push_back(
          fmt::format("{} single samples of {} lie far off their neighbours, by up to {:.3g}; they "
                      "are left out of the fits.",
                      found.rows.size(), task_.outputs[output], found.largest));
      if (ratio < 1.0 ||
          (!options_.effects.empty() && std::ranges::find(options_.effects, "glitches") == options_.effects.end())) {
        continue;
      }
      const Edge* const edge = find_edge(edges, task_.outputs[output]);
      EffectFinding finding{.id = "glitches", .edge = edge == nullptr ? task_.outputs[output] : edge->name};
      const auto count = static_cast<double>(found.rows.size());
      finding.parameters.push_back({.name = "COUNT", .value = count, .low = count, .high = count, .unit = "1"});
      finding.parameters.push_back({.name = "LARGEST",
                                    .value = found.largest,
                                    .low = found.largest,
                                    .high = found.largest,
                                    .unit = result_.gaps[output].unit});
      finding.share = result_.effects.empty() ? 1.0 : 0.5;
      const bool alone = result_.effects.empty();
      result_.effects.push_back(std::move(finding));
      for (Rival& rival : result_.rivals) {
        rival.effects.emplace_back("glitches");
        rival.edges.push_back(result_.effects.back().edge);
      }
      if (alone) {
        result_.verdict = Verdict::Named;
        result_.rivals = {{.effects = {"glitches"}, .edges = {result_.effects.back().edge}, .probability = 1.0}};
        const GapFinding& gap = result_.gaps[output];
        const double beside = std::sqrt(std::max(0.0, gap.improved * gap.improved - found.rms * found.rms));
        result_.unknown_score = excess_of(beside / floors_[output].value);
        result_.confidence = 0.9 * (1.0 - result_.unknown_score);
      }
    }
  }

  /// What comes next: the experiment that would tell the rivals apart, and the feedforward with the effect in it.
  void plan(const Search& found, const Judgement& judgement, const Explanation& kept) {
    for (EffectFinding& effect : result_.effects) {
      effect.inverse = inverse_of(effect.id).inverse;
    }
    std::vector<Explanation> rivals;
    for (const Weighed& weighed : judgement.rivals) {
      rivals.push_back(*weighed.explanation);
    }
    for (const Weighed& weighed : judgement.fitted) {
      if (rivals.size() < 2 && !rivals.empty() && weighed.explanation->names() != rivals.front().names()) {
        rivals.push_back(*weighed.explanation);
      }
    }
    if (rivals.empty() && !found.explanations.empty()) {
      rivals.push_back(found.explanations.front());
    }
    if (result_.verdict != Verdict::None && result_.verdict != Verdict::Calibration && !rivals.empty()) {
      result_.next = next_experiment(task_, rivals, options_.limits, floors_.front().value);
    }
    invert(kept);
  }

  void invert(const Explanation& kept) {
    std::vector<std::string> moving;
    for (const Port& input : input_.program.graph.inputs) {
      const records::Column* const column = task_.records.front().find(input.name);
      if (input.type == Type::Real && column != nullptr &&
          std::ranges::max(column->values) > std::ranges::min(column->values)) {
        moving.push_back(input.name);
      }
    }
    if (moving.empty()) {
      return;
    }
    const double sample_time = task_.records.front().sample_time();
    const Program improved = fitted_program(task_, kept);
    const Feedforward feedforward = feedforward_of(improved, moving.front(), result_.gap.signal, sample_time);
    result_.feedforward_text = feedforward.text;
    result_.feedforward_notes = feedforward.notes;
    if (feedforward.text.empty()) {
      result_.feedforward_notes.push_back(feedforward.reason);
      return;
    }
    if (const auto tracking =
            predicted_tracking(*base_.program, improved, moving.front(), result_.gap.signal, task_.records.front())) {
      result_.tracking_nominal = tracking->nominal;
      result_.tracking_improved = tracking->improved;
    }
  }

  std::vector<std::string> inner_{};  ///< outputs that are inner signals of the user's diagram
  DiagnosisInput input_;
  const DiagnosisOptions& options_;
  Task task_{};
  Variant base_{};
  std::vector<std::string> unused_{};  ///< columns that the diagram does not name
  std::vector<NoiseFloor> floors_{};
  std::vector<Glitches> glitches_{};
  VectorXd nominal_{};
  double floor_cost_ = 0.0;
  double predictable_ = 0.0;  ///< see Findings
  bool one_motion_ = false;   ///< see RecordCheck
  bool related_ = true;       ///< the calibrated diagram follows the record at least a little
  Diagnosis result_{};
};

}  // namespace

Diagnosis diagnose(const DiagnosisInput& input, const DiagnosisOptions& options) {
  return Run(input, options).run();
}

}  // namespace hysteron::diagnosis
