// A set of laws as the diagram with its effects, fitted over whole records: what the user gets as improved.st.
//
// The laws enter one by one, what closes most first, and each fit begins where the one before has ended. A run is far
// from linear in its parameters: a small law with a number that is only known to first order makes a mess of a run in
// which the large one alone would have found its place.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/evidence.hpp"

namespace hysteron::diagnosis {

/// The first laws of a set in the diagram.
struct FittedSet {
  SetFinding set{};  ///< with these laws alone; of fewer than all, what they close is their part of what the set closes
  Explanation fitted{};
};

struct Explained {
  /// With the first law, with two, up to the whole set, each with less left than the one before. None where the text
  /// has no place for the laws, or where the last closes less than half of what the evidence promises.
  std::vector<FittedSet> runs{};
  /// The diagram with the set was run and does not do what the set promises, where a run is a fair judge: the promise
  /// was for the outputs, to first order, or the diagram forgets what was before, so that nothing adds up.
  bool refuted = false;
};

struct ExplainOptions {
  std::vector<std::string> effects{};  ///< that may be added; empty: all
  std::vector<std::string> columns{};  ///< of the records that the diagram does not use
  unsigned threads = 2;
  bool is_open_loop = false;  ///< the set is of the plant alone, and the diagram has its loop around it
  double floor_cost = 0.0;    ///< ½Σr² of noise alone
};

/// The laws of the set that the text of the diagram has a place for, each begun from where the evidence found it. Of a
/// plant in its loop the whole set, with one effect more around it where that one closes a notable part.
[[nodiscard]] Explained explained(const Task& task, const std::string& top, const SetFinding& set,
                                  const Explanation& calibrated, const ExplainOptions& options, Rules& rules);

}  // namespace hysteron::diagnosis
