#include "diagnosis/stages/hypotheses.hpp"

#include <optional>
#include <span>
#include <utility>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/faults/lagged_glitches.hpp"
#include "diagnosis/findings/findings.hpp"
#include "diagnosis/search/loop_noise.hpp"
#include "diagnosis/verdict/start_state.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of the budget, at least for a search that has its best sets to find again.
constexpr double share_of_another_search = 0.25;

/// Works on a record that it owns, and gives it away with what it has found.
class RecordSearch {
 public:
  RecordSearch(Cleaned record, const DiagnosisOptions& options, Budget& budget)
      : options_(options), budget_(budget), found_{.record = std::move(record)} {}

  Hypotheses run() {
    found_.searched = weighed(search_without_glitches());
    search_from_another_start();
    const Explanation& chosen = *found_.searched->judgement.chosen;
    if (take_off_record(glitches_behind_lag({&chosen, 1})) ||
        leave_out_beside(found_.record.left_out, found_.record.task, chosen, found_.record.floors)) {
      simulate_nominal(found_.record);
      found_.searched = searched_again();
    }
    return std::move(found_);
  }

 private:
  [[nodiscard]] SearchOptions asked() const { return search_options(found_.record, options_, budget_); }

  Search search_with(const SearchOptions& options) {
    const Cleaned& record = found_.record;
    Search found = search(record.task, record.base, record.top, record.floor_cost, options);
    found_.tried += found.tried;
    return found;
  }

  [[nodiscard]] std::unique_ptr<Searched> weighed(Search found) const {
    return std::make_unique<Searched>(found_.record.task, std::move(found), found_.record.floor_cost);
  }

  std::unique_ptr<Searched> searched_again() {
    budget_.at_least(share_of_another_search);
    return weighed(search_with(asked()));
  }

  /// Glitches that show beside one effect already are left out before a search for more, which would be done twice.
  Search search_without_glitches() {
    SearchOptions options = asked();
    std::optional<Task> cleaned;
    std::optional<LaggedGlitches> lagged;
    options.ends_with_singles = [&](const std::vector<Explanation>& singles) {
      if (lagged = glitches_behind_lag(singles); lagged) {
        return true;
      }
      Task without = found_.record.task;
      const bool renewed = renew_loop_noise(without, singles.front());
      if (leave_out_beside(found_.record.left_out, without, singles.front(), found_.record.floors) || renewed) {
        cleaned = std::move(without);
      }
      return cleaned.has_value();
    };
    Search found = search_with(options);
    if (cleaned) {
      found_.record.task = std::move(*cleaned);
    }
    if (take_off_record(lagged) || cleaned) {
      simulate_nominal(found_.record);
      found = search_with(asked());
    }
    return found;
  }

  /// Once: what a second look would find was left by an explanation that does not hold.
  [[nodiscard]] std::optional<LaggedGlitches> glitches_behind_lag(std::span<const Explanation> beside) const {
    return is_tried(options_.effects, "glitches") && !took_off_
               ? lagged_glitches(found_.record.task, beside, options_.threads)
               : std::nullopt;
  }

  /// And finds the noise floors anew. Whether there were any.
  bool take_off_record(const std::optional<LaggedGlitches>& glitches) {
    if (!glitches) {
      return false;
    }
    took_off_ = true;
    take_off(found_.record.task, found_.record.left_out, *glitches);
    find_floors(found_.record);
    return true;
  }

  /// Where another state at the start explains the record better, with fewer effects or closer, the search is done
  /// again with it, and stands if it is the better one in the end.
  void search_from_another_start() {
    Cleaned& record = found_.record;
    const Judgement& first = found_.searched->judgement;
    std::optional<Task> free =
        materiality_of(record, options_).is_left(record.nominal)
            ? with_free_start(record.task, found_.searched->search, first, record.floor_cost, options_.threads)
            : std::nullopt;
    if (!free) {
      return;
    }
    const auto more = std::ssize(free->initial_states) - std::ssize(record.task.initial_states);
    const auto support = [&](const Explanation& one, Index states) {
      return support_of(one.fit.cost, one.parameters() + states * std::ssize(record.task.records),
                        one.variant.effects.size(), first.weighing_samples, found_.searched->search.tried);
    };
    std::swap(record.task, *free);
    std::unique_ptr<Searched> second = searched_again();
    if (support(*second->judgement.chosen, more) > support(*first.chosen, 0)) {
      found_.warnings.push_back(words_of_start(record.task, *second->judgement.chosen));
      found_.searched = std::move(second);
    } else {
      std::swap(record.task, *free);
    }
  }

  const DiagnosisOptions& options_;
  Budget& budget_;
  bool took_off_ = false;  ///< glitches behind a lag
  Hypotheses found_;
};

}  // namespace

SearchOptions search_options(const Cleaned& record, const DiagnosisOptions& options, Budget& budget) {
  return {.candidates = {.effects = options.effects, .columns = record.unused},
          .threads = options.threads,
          .most_effects = options.most_effects,
          .progress = options.progress,
          .budget = &budget};
}

Hypotheses hypotheses(Cleaned record, const DiagnosisOptions& options, Budget& budget) {
  return RecordSearch(std::move(record), options, budget).run();
}

}  // namespace hysteron::diagnosis
