// What the user reads, from the sets of effects that were fitted: parameters with intervals, shares, rivals, reasons.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/verdict.hpp"

namespace hysteron::diagnosis {

struct Findings {
  const Task& task;
  const Search& search;
  const Judgement& judgement;
  double floor_cost = 0.0;
  double predictable = 0.0;  ///< share of what is left that depends on what the machine did; 0 where nothing is left
};

[[nodiscard]] std::vector<ParameterFinding> nominal_findings(const Task& task);
[[nodiscard]] std::vector<ParameterFinding> calibration_findings(const Findings& findings);
[[nodiscard]] std::vector<EffectFinding> effect_findings(const Findings& findings);
[[nodiscard]] std::vector<Rival> rival_findings(const Findings& findings);
/// The best of all that was fitted.
[[nodiscard]] std::vector<Rival> fitted_findings(const Findings& findings);

/// The probability of the verdict: of the named set among the rivals, lowered by what is left unexplained.
[[nodiscard]] double confidence(const Findings& findings, const Diagnosis& so_far);

/// Why some things cannot be told apart from inputs and outputs, as far as it concerns this verdict.
[[nodiscard]] std::vector<std::string> structural_reasons(const Diagnosis& so_far);

/// `edges` are those of the diagram as given, `ports` its inputs and outputs.
[[nodiscard]] GapSplit split_of(const std::vector<EffectFinding>& effects, const std::vector<Edge>& edges,
                                const std::vector<std::string>& ports);

[[nodiscard]] std::vector<Trace> traces_of(const Task& task, const VectorXd& nominal, const VectorXd& calibrated,
                                           const VectorXd& improved);

/// The verdict in one or two sentences.
[[nodiscard]] std::string summary_of(const Diagnosis& found);

}  // namespace hysteron::diagnosis
