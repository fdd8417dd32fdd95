#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <span>

#include "codegen/parameters/apply.hpp"
#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/evidence/evidence.hpp"
#include "diagnosis/evidence/explained.hpp"
#include "diagnosis/faults/fast_clock.hpp"
#include "diagnosis/faults/lagged_glitches.hpp"
#include "diagnosis/faults/left_out.hpp"
#include "diagnosis/faults/record_check.hpp"
#include "diagnosis/findings/evidence_findings.hpp"
#include "diagnosis/findings/findings.hpp"
#include "diagnosis/findings/gaps.hpp"
#include "diagnosis/findings/inner_signals.hpp"
#include "diagnosis/findings/left_out_findings.hpp"
#include "diagnosis/findings/maps.hpp"
#include "diagnosis/findings/shares.hpp"
#include "diagnosis/findings/where.hpp"
#include "diagnosis/model/budget.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/materiality.hpp"
#include "diagnosis/noise/noise_floors.hpp"
#include "diagnosis/noise/remainder.hpp"
#include "diagnosis/outlook.hpp"
#include "diagnosis/remedy/improved.hpp"
#include "diagnosis/search/loop_noise.hpp"
#include "diagnosis/search/search.hpp"
#include "diagnosis/verdict/harmonics.hpp"
#include "diagnosis/verdict/held_out.hpp"
#include "diagnosis/verdict/plausibility.hpp"
#include "diagnosis/verdict/start_state.hpp"
#include "diagnosis/verdict/unrepeatable.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {
namespace {

/// A residual of this many times what may be noise is none, whether or not anything predicts it.
constexpr double far_above = 3.0;
/// The confidence of a verdict on a record that holds one motion only is no higher.
constexpr double sure_of_one_motion = 0.8;
/// Nor where the begin of the record is not explained: what is named may stand for another state at the start.
constexpr double sure_of_missed_start = 0.5;
/// Known parameters that a refit drives far off bend to what the named effect is not.
constexpr double sure_of_another_machine = 0.6;

using Clock = std::chrono::steady_clock;

class Run {
 public:
  Run(const DiagnosisInput& input, const DiagnosisOptions& options)
      : unmatched_(unmatched_columns(input)), input_(with_inner_signals(input, inner_)), options_(options) {}

  Diagnosis run() {
    const auto begun = Clock::now();
    prepare();
    if (result_.refusals.empty()) {
      investigate();
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
    given_ = std::move(program);
    base_ = {.text = input_.text, .program = given_};
    result_.refusals = absurd_samples(task_, given_->graph);
    if (!result_.refusals.empty()) {
      return;
    }
    unused_ = unused_columns(task_, *given_);
    find_floors();
    left_out_ = leave_out(task_, *given_);
    Model scaled(task_, *given_);
    if (!scaled.residuals(scaled.start(), nominal_)) {
      throw InputError(error_of_start(input_));
    }
    RecordCheck checked = check_records(task_, scaled, nominal_);
    result_.refusals = std::move(checked.refusals);
    result_.warnings = std::move(checked.warnings);
    std::ranges::move(unmatched_, std::back_inserter(result_.warnings));
    one_motion_ = checked.one_motion;
    if (!checked.left_out.empty()) {
      task_.left_out.insert(task_.left_out.end(), checked.left_out.begin(), checked.left_out.end());
    }
    if (LoopNoise noise = with_loop_noise(task_, base_, result_.top); !noise.remark.empty()) {
      base_ = std::move(noise.base);
      result_.warnings.push_back(std::move(noise.remark));
    }
    if (std::optional<FastClock> clock =
            is_tried(options_.effects, "clock") ? fast_clock(task_, *base_.program) : std::nullopt) {
      task_ = std::move(clock->task);
      left_out_.push_back(std::move(clock->finding));
    }
    simulate_nominal();
    std::ranges::move(remarks_on_floors(task_, floors_), std::back_inserter(result_.warnings));
  }

  void find_floors() {
    floors_ = noise_floors(task_, *given_, columns_by_record(task_, unused_));
    task_.scales.clear();
    std::ranges::transform(floors_, std::back_inserter(task_.scales), &NoiseFloor::value);
  }

  /// The diagram as given, with the noise of its loops and without what is left out, against the outputs as they were
  /// measured: a record may have been mended since.
  void simulate_nominal() {
    Task measured = task_;
    for (std::size_t i = 0; i < measured.records.size(); ++i) {
      for (const std::string& output : measured.outputs) {
        measured.records[i].replace(output, input_.records[i].column(output).values);
      }
    }
    Model model(measured, *base_.program);
    (void)model.residuals(model.start(), nominal_);  // finite before
    for (const Index row : task_.left_out) {
      nominal_[row] = 0.0;
    }
    floor_cost_ = 0.5 * static_cast<double>(nominal_.size() - std::ssize(task_.left_out));
  }

  void investigate() {
    const std::unique_ptr<Searched> searched = searched_record();
    const Search& found = searched->search;
    judge_related(*searched);
    harmonics_ = with_all_lines(task_, result_.top, search_options().candidates, *searched);
    if (harmonics_) {
      choose_instead(task_, *harmonics_, searched->judgement);
    }
    unrepeatable_ = unrepeatable(task_, result_.top, found, floor_cost_, search_options(), materiality_, budget_,
                                 searched->judgement);
    if (unrepeatable_) {
      result_.warnings.push_back(unrepeatable_->remark);
    }
    weigh_evidence(*searched);
    forget_explained(left_out_, task_, *searched->judgement.chosen);
    const Judgement& judgement = searched->judgement;
    gap_output_ = largest_gap(task_, floors_, nominal_);
    decide(found, judgement);
    // What the user gets as improved.st: effects that the verdict does not name are not in it.
    const Explanation& kept = named() ? *judgement.chosen : found.calibrated;
    describe_gap(found.calibrated, kept, judgement);
    result_.cuts = cuts_at(inner_, task_, *base_.program, materiality_);
    describe(found, judgement, kept);
    result_.edges = where(task_, found, result_.top, unused_, result_.effects, options_.threads);
    result_.maps =
        maps_of(task_, without_noise(found.calibrated, result_.top), without_noise(kept, result_.top), gap_output_);
  }

  /// Where no set is true, which effects are there is asked of stretches that no fit has seen.
  void weigh_evidence(Searched& searched) {
    Judgement& judgement = searched.judgement;
    const Explanation& calibrated = searched.search.calibrated;
    if (!related_ || !leaves_a_cause(*judgement.chosen, calibrated, floor_cost_) ||
        !materiality_.is_left(unrepeatable_ ? unrepeatable_->residuals : judgement.chosen->fit.residuals)) {
      return;
    }
    result_.evidence = evidence_of(
        task_, result_.top, calibrated,
        {.effects = options_.effects, .columns = unused_, .threads = options_.threads, .seed = options_.seed});
    result_.tried += result_.evidence.tried;
    if (!is_told(result_.evidence)) {
      return;
    }
    Explained tried = explained(task_, result_.top, result_.evidence.sets.front(), calibrated, unused_);
    if (tried.refuted && !result_.evidence.is_open_loop) {
      result_.evidence = {};
      return;
    }
    explained_ = std::move(tried.explanation);
    choose_instead(task_, explained_ ? *explained_ : calibrated, judgement);
    unrepeatable_.reset();
    harmonics_.reset();
  }

  [[nodiscard]] SearchOptions search_options() {
    return {.candidates = {.effects = options_.effects, .columns = unused_},
            .threads = options_.threads,
            .most_effects = options_.most_effects,
            .progress = options_.progress,
            .out_of_time = [this] { return budget_.is_over(); }};
  }

  Search search_with(const SearchOptions& options) {
    Search found = search(task_, base_, result_.top, floor_cost_, options);
    result_.tried += found.tried;
    return found;
  }

  std::unique_ptr<Searched> searched_record() {
    auto searched = std::make_unique<Searched>(task_, search_without_glitches(), floor_cost_);
    const auto again = [&] {
      budget_.at_least(0.25);  // the search has its best sets to find again
      return std::make_unique<Searched>(task_, search_with(search_options()), floor_cost_);
    };
    search_from_another_start(searched, again);
    const Explanation& chosen = *searched->judgement.chosen;
    if (take_off_record(glitches_behind_lag({&chosen, 1})) || leave_out_beside(left_out_, task_, chosen, floors_)) {
      simulate_nominal();
      searched = again();
    }
    if (budget_.has_cut()) {
      result_.warnings.push_back(warning_of_cut(budget_.seconds(), searched->search.tried));
    }
    return searched;
  }

  /// Glitches that show beside one effect already are left out before a search for more, which would be done twice.
  Search search_without_glitches() {
    SearchOptions options = search_options();
    std::optional<Task> cleaned;
    std::optional<LaggedGlitches> lagged;
    options.ends_with_singles = [&](const std::vector<Explanation>& singles) {
      if (lagged = glitches_behind_lag(singles); lagged) {
        return true;
      }
      Task without = task_;
      const bool renewed = renew_loop_noise(without, singles.front());
      if (leave_out_beside(left_out_, without, singles.front(), floors_) || renewed) {
        cleaned = std::move(without);
      }
      return cleaned.has_value();
    };
    Search found = search_with(options);
    if (cleaned) {
      task_ = std::move(*cleaned);
    }
    if (take_off_record(lagged) || cleaned) {
      simulate_nominal();
      found = search_with(search_options());
    }
    return found;
  }

  /// Once: what a second look would find was left by an explanation that does not hold.
  [[nodiscard]] std::optional<LaggedGlitches> glitches_behind_lag(std::span<const Explanation> beside) const {
    return is_tried(options_.effects, "glitches") && !took_off_ ? lagged_glitches(task_, beside, options_.threads)
                                                                : std::nullopt;
  }

  /// And finds the noise floors anew: where an input rests they had counted as noise. Whether there were any.
  bool take_off_record(const std::optional<LaggedGlitches>& glitches) {
    if (!glitches) {
      return false;
    }
    took_off_ = true;
    take_off(task_, left_out_, *glitches);
    find_floors();
    return true;
  }

  /// Where the record has next to nothing to do with the diagram, no effect is chosen.
  void judge_related(Searched& searched) {
    Judgement& judgement = searched.judgement;
    const Explanation& calibrated = searched.search.calibrated;
    std::string reason = unrelated(task_, calibrated, *judgement.chosen, judgement.effective_samples);
    if (!reason.empty()) {
      result_.warnings.push_back(std::move(reason));
      judgement = {.chosen = &calibrated,
                   .effective_samples = judgement.effective_samples,
                   .held_out = held_out(task_, calibrated)};
      related_ = false;
    }
  }

  [[nodiscard]] bool named() const {
    return result_.verdict == Verdict::Named || result_.verdict == Verdict::Group ||
           result_.verdict == Verdict::Partial;
  }

  /// Where another state at the start explains the record better, with fewer effects or closer, the search is done
  /// again with it, and stands if it is the better one in the end.
  template <class Again>
  void search_from_another_start(std::unique_ptr<Searched>& searched, const Again& again) {
    const Judgement& first = searched->judgement;
    std::optional<Task> free = materiality_.is_left(nominal_)
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
    std::unique_ptr<Searched> second = again();
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

  void describe_gap(const Explanation& calibrated, const Explanation& kept, const Judgement& judgement) {
    const VectorXd unseen = &kept == judgement.chosen ? judgement.held_out : held_out(task_, kept);
    result_.gaps = gaps_of(
        task_, input_.program.graph,
        {.nominal = nominal_, .calibrated = calibrated.fit.residuals, .kept = kept.fit.residuals, .held_out = unseen},
        floors_, options_.seed);
    for (std::size_t output = 0; output < result_.gaps.size(); ++output) {
      const GapFinding& gap = result_.gaps[output];
      const bool refit_is_worse = materiality_.matters(gap.calibrated, gap.nominal, output);
      const bool effects_are_worse = named() && materiality_.matters(gap.improved, gap.nominal, output);
      if (refit_is_worse || effects_are_worse) {
        result_.warnings.push_back(warning_of_worse(gap, refit_is_worse, effects_are_worse));
      }
    }
    result_.gap = result_.gaps[gap_output_];
    if (named() && materiality_.was_taken_for_noise(calibrated.fit.residuals, kept.fit.residuals)) {
      result_.warnings.push_back(warning_of_floor(result_.gap));
    }
  }

  void decide(const Search& found, const Judgement& judgement) {
    const Explanation& chosen = *judgement.chosen;
    const bool has_effect = !chosen.variant.effects.empty();
    const bool gap_before = materiality_.is_left(nominal_);
    const bool gap_calibrated =
        materiality_.is_left(found.calibrated.fit.residuals) ||
        (has_effect && materiality_.was_taken_for_noise(found.calibrated.fit.residuals, chosen.fit.residuals));
    const VectorXd& residuals = unrepeatable_ ? unrepeatable_->residuals : chosen.fit.residuals;
    const bool gap_left = materiality_.is_left(residuals);

    const Model model(task_, *given_);
    noise_ = possible_noise(model, floors_, chosen.fit.residuals);
    const Remainder left = remainder_of(model, found.calibrated.fit.residuals, residuals, noise_);
    predictable_ = gap_left ? left.share : 0.0;
    unexplained_ = rms(residuals, gap_output_) / (floors_[gap_output_].value * noise_[gap_output_]);
    result_.unknown_score = unknown_score(left, probability_of_cause(judgement));

    if (is_told(result_.evidence)) {
      result_.verdict = Verdict::Partial;
    } else if (!related_) {
      result_.verdict = Verdict::Unknown;
      result_.unknown_score = 1.0;
    } else if (has_effect && gap_calibrated) {
      const bool much_left =
          (left.open > 0.5 && left.is_predictable) || (left.open > 0.1 && left.size > 2.0) || left.size > far_above;
      if (gap_left && much_left) {
        result_.verdict = Verdict::Partial;
      } else {
        result_.verdict = judgement.rivals.size() > 1 ? Verdict::Group : Verdict::Named;
      }
    } else if (gap_calibrated && left.size > least_above() && (left.is_predictable || left.size > far_above)) {
      result_.verdict = Verdict::Unknown;
    } else if (gap_before &&
               calibration_matters(task_, floors_, options_.material, nominal_, found.calibrated.fit.residuals)) {
      result_.verdict = Verdict::Calibration;
    } else {
      result_.verdict = Verdict::None;
    }
  }

  /// Less above the noise is no claim that something is unknown.
  [[nodiscard]] double least_above() const {
    return floors_[gap_output_].evidence == "repeats" ? suspicious_from : hidden_noise;
  }

  void describe(const Search& found, const Judgement& judgement, const Explanation& kept) {
    const Findings findings{
        .task = task_,
        .search = found,
        .judgement = judgement,
        .kept = kept,
        .floor_cost = floor_cost_,
        .chosen_cost = unrepeatable_ ? 0.5 * unrepeatable_->residuals.squaredNorm() : judgement.chosen->fit.cost,
        .gap_output = gap_output_,
        .predictable = predictable_,
        .unexplained = unexplained_};
    result_.calibration = calibration_findings(findings);
    result_.nominal = nominal_findings(task_);
    if (named()) {
      result_.effects = effect_findings(findings);
      result_.rivals = rival_findings(findings);
    }
    result_.fitted = fitted_findings(findings);
    result_.confidence = confidence(findings, result_);
    if (is_told(result_.evidence)) {
      tell(result_.evidence, result_);
    }
    double most_confidence = 1.0;  // what speaks against a verdict holds whatever else is said of it
    if (result_.verdict != Verdict::Partial && result_.verdict != Verdict::Unknown) {  // they say it already
      for (std::string& far : far_parameters(task_, kept)) {
        result_.warnings.push_back(std::move(far));
        most_confidence = std::min(most_confidence, sure_of_another_machine);
      }
    }
    const std::vector<Edge> edges = edges_of_text(input_.text, result_.top);
    add_left_out(findings, {.left_out = left_out_, .floors = floors_, .noise = noise_, .tried = options_.effects},
                 edges, result_);
    result_.split = split_of(result_.effects, edges, ports());
    if (one_motion_) {
      most_confidence = std::min(most_confidence, sure_of_one_motion);
    }
    if (std::string reason = unexplained_start(task_, *judgement.chosen); !reason.empty() && related_) {
      result_.warnings.push_back(std::move(reason));
      most_confidence = std::min(most_confidence, sure_of_missed_start);
    }
    result_.confidence = std::min(result_.confidence, most_confidence);
    for (std::string& reason :
         structural_reasons(result_, given_->graph.sample_time(),
                            is_tried(options_.effects, "periodic_disturbance") ? longest_duration(task_) : 0.0)) {
      result_.cannot_tell.push_back(std::move(reason));
    }
    result_.traces = traces_of(task_, result_.gaps, nominal_, found.calibrated.fit.residuals, kept.fit.residuals);
    result_.improved_text = improved_text(kept.variant, input_.program.graph.source->path);
    if (hidden_delays(result_.improved_text) > hidden_delays(input_.text)) {
      result_.warnings.emplace_back(
          "The effect closes a loop, and its block cannot be called before what it reads: improved.st is taken with "
          "--any-order only.");
    }
    result_.improved_file = improved_file(task_, input_.file, kept);
    add_outlook({.task = task_,
                 .nominal = *given_,
                 .top = result_.top,
                 .search = found,
                 .judgement = judgement,
                 .kept = kept,
                 .options = options_,
                 .floor = floors_[gap_output_].value},
                result_);
    result_.summary = is_told(result_.evidence) ? sentence_of(result_)
                                                : summary_of(result_, materiality_.is_too_small(kept.fit.residuals));
  }

  [[nodiscard]] std::vector<std::string> ports() const {
    std::vector<std::string> names = task_.outputs;
    for (const Port& input : input_.program.graph.inputs) {
      names.push_back(input.name);
    }
    return names;
  }

  std::vector<std::string> unmatched_{};  ///< remarks on columns that look like inner signals
  std::vector<std::string> inner_{};      ///< outputs that are inner signals of the user's diagram
  DiagnosisInput input_;
  const DiagnosisOptions& options_;
  Budget budget_{options_.budget};
  Task task_{};
  std::shared_ptr<const Program> given_{};  ///< with the values of the parameter file
  Variant base_{};                          ///< the same with the noise of its sensors in its loops
  std::vector<std::string> unused_{};       ///< columns that the diagram does not name
  std::vector<NoiseFloor> floors_{};
  std::vector<double> noise_{};  ///< of each output what may be noise, in floors
  Materiality materiality_{task_, floors_, options_.material};
  std::vector<LeftOut> left_out_{};
  VectorXd nominal_{};
  bool took_off_ = false;  ///< glitches behind a lag
  double floor_cost_ = 0.0;
  std::size_t gap_output_ = 0;              ///< see Findings
  std::optional<Explanation> harmonics_{};  ///< the chosen set, where its line has some
  std::optional<Explanation> explained_{};  ///< the set of the evidence, where the diagram has a place for it
  std::optional<Unrepeatable> unrepeatable_{};
  double predictable_ = 0.0;  ///< see Findings
  double unexplained_ = 0.0;  ///< likewise
  bool one_motion_ = false;   ///< see RecordCheck
  bool related_ = true;       ///< the calibrated diagram follows the record at least a little
  Diagnosis result_{};
};

}  // namespace

Diagnosis diagnose(const DiagnosisInput& input, const DiagnosisOptions& options) {
  return Run(input, options).run();
}

}  // namespace hysteron::diagnosis
