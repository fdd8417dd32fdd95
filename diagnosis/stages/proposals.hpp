// What was proposed as the cause, each in its own way, and what the runs of the whole diagram say of it.
//
// The evidence tells a set in each of its views; the search has fitted sets of its own; and it may be that no effect is
// there. The votes of the runs (run_votes.hpp) say how probable each proposal is. A family is as probable as what tells
// it, times how probable it is there.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/evidence/evidence.hpp"
#include "diagnosis/evidence/explained.hpp"
#include "diagnosis/stages/judged.hpp"
#include "diagnosis/verdict/run_votes.hpp"

namespace hysteron::diagnosis {

/// What one view tells, and the diagram with its sets and with parts of them. None where the text has no place for
/// them.
struct Told {
  std::size_t view = 0;
  Evidence evidence{};
  std::vector<FittedSet> runs{};
};

/// All that was proposed, how probable each set is, and what it closes of the gap.
struct Runs {
  std::vector<RunSet> sets{};  ///< of what is told, then of the search, and last the calibrated diagram as it is
  std::vector<double> votes{};
  std::vector<double> closed{};
  std::vector<std::size_t> begins{};  ///< by view that tells something, where its sets begin; then those of the search
  std::vector<const Explanation*> searched{};
  std::map<std::string, std::string> family_of{};  ///< by effect

  /// How many sets are of what is told.
  [[nodiscard]] std::size_t told() const { return begins.back(); }
  /// The votes of all sets of what one view tells.
  [[nodiscard]] double votes_of(std::size_t view) const;
  /// The most probable of what is told, as a whole; its most probable set; and that of the search: asked only where
  /// there is one.
  [[nodiscard]] std::size_t best_told() const;
  [[nodiscard]] std::size_t best_set_of(std::size_t view) const;
  [[nodiscard]] std::size_t best_searched() const;
  /// Where the calibrated diagram stands.
  [[nodiscard]] std::size_t nothing() const { return sets.size() - 1; }
  /// Whether what is told is more probable than all that the search has, and than no effect at all.
  [[nodiscard]] bool are_for_told() const;
  /// What a family closes by itself, in the best run that has no other.
  [[nodiscard]] double alone(const std::string& family) const;
};

[[nodiscard]] Runs runs_of(const std::vector<Told>& told, const Judged& judged, const DiagnosisOptions& options,
                           const Rules& rules);

/// The votes with the odds that the swing of a loop gives to what sticks.
void weigh_by_loop(const LoopFinding& loop, Runs& runs);

/// What the search tells, as evidence: its sets by the votes, their families each with its part of what a set closes,
/// by what each closes alone.
[[nodiscard]] Evidence evidence_of_search(const Runs& runs, const Task& task);

/// Each family as probable as what tells it, in front what closes most with what is most probable.
void weigh_families(const Runs& runs, const std::vector<Told>& told, Evidence& evidence);

/// In front of the sets the one that is in the diagram: as the evidence has it or, where it has only a larger one, the
/// part of that.
void put_first(const SetFinding& set, std::vector<SetFinding>& sets);

}  // namespace hysteron::diagnosis
