// A set of laws as the diagram with its effects, fitted over whole records: what the user gets as improved.st.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/evidence/evidence.hpp"

namespace hysteron::diagnosis {

struct Explained {
  /// Nothing where the text has no place for the laws, or where the fit closes less than half of what the evidence
  /// promises.
  std::optional<Explanation> explanation{};
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
/// plant in its loop, with one effect more around it where that one closes a notable part.
[[nodiscard]] Explained explained(const Task& task, const std::string& top, const SetFinding& set,
                                  const Explanation& calibrated, const ExplainOptions& options, Rules& rules);

}  // namespace hysteron::diagnosis
