// What follows from a verdict: the experiment that would tell the rivals apart, and the feedforward with the effect in
// it.
#pragma once

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/model/input.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/search/search.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

struct Outlook {
  const Task& task;
  const Program& nominal;  ///< the diagram as given, with the values of the parameter file
  const std::string& top;  ///< its name
  const Search& search;
  const Judgement& judgement;
  const Explanation& kept;  ///< what the user gets as improved.st
  const DiagnosisOptions& options;
  double floor;  ///< of the output with the gap
};

/// Fills `next`, the inverses of the effects, the feedforward and its tracking errors.
void add_outlook(const Outlook& outlook, Diagnosis& found);

}  // namespace hysteron::diagnosis
