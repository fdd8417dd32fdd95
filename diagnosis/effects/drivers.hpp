// The signals that drive the candidates: run once for each edge, not for each candidate.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/effects/signals.hpp"

namespace hysteron::diagnosis {

/// What drives a candidate: its input, and the first of its further inputs.
struct Driven {
  RecordSignals input_values{};
  Extent input{};
  std::optional<RecordSignals> auxiliary_values{};
  std::optional<Extent> auxiliary{};
};

/// The signals of candidates on one diagram with its known parameters at `known`; those of one family once.
class Drivers {
 public:
  Drivers(const Task& task, const std::vector<Candidate>& candidates, const VectorXd& known, unsigned threads);

  /// Null where nothing drives the candidate.
  [[nodiscard]] const Driven* find(const Candidate& candidate) const;

 private:
  std::map<std::string, Driven> signals_{};
};

}  // namespace hysteron::diagnosis
