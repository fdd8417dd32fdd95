// What speaks against a verdict whatever else is said of it: how sure it can be at most, and why.
//
// A doubt is a line in `doubts` and a function that says whether it is there. The least of all that are holds, in
// whatever order they are asked.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/rules.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// What doubts look at.
struct Doubted {
  const Task& task;
  const Explanation& chosen;
  const Explanation& kept;  ///< what improved.st holds
  Verdict verdict;          ///< before what was left out of the fits is added
  bool one_motion;          ///< see RecordCheck, which warns of it
  bool is_related;          ///< see Judged
};

struct Doubt {
  const Threshold& most;
  /// Nothing where there is no such doubt; else what to warn of, beside the warnings that stand already.
  std::optional<std::vector<std::string>> (*reasons)(const Doubted&);
};

/// Lowers the confidence of a diagnosis to what its doubts allow, and adds their warnings.
void doubt(const Doubted& doubted, Rules& rules, Diagnosis& result);

}  // namespace hysteron::diagnosis
