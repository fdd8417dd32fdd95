// What the user reads, from the sets of effects that were fitted: parameters with intervals, shares, rivals, reasons.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/rules.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

struct Findings {
  const Task& task;
  const Search& search;
  const Judgement& judgement;
  const Explanation& kept;  ///< what improved.st holds: the chosen set where the verdict names it, else calibration
  double floor_cost = 0.0;
  double chosen_cost = 0.0;    ///< ½Σr² that the chosen set leaves, without what no diagram repeats
  std::size_t gap_output = 0;  ///< the output whose gap counts, by its place among the measured ones
  double predictable = 0.0;    ///< share of what is left that depends on what the machine did; 0 where nothing is left
  double unexplained = 0.0;  ///< what is left of that output over what may be noise, but for what uneven steps explain
};

[[nodiscard]] std::vector<ParameterFinding> nominal_findings(const Task& task);
[[nodiscard]] std::vector<ParameterFinding> calibration_findings(const Findings& findings);
[[nodiscard]] std::vector<EffectFinding> effect_findings(const Findings& findings);
/// A set of effects, each beside its edge, with what it leaves of the output whose gap counts.
[[nodiscard]] Rival rival_of(const Task& task, std::size_t gap_output, const Weighed& weighed);
[[nodiscard]] std::vector<Rival> rival_findings(const Findings& findings);
/// The best of all that was fitted.
[[nodiscard]] std::vector<Rival> fitted_findings(const Findings& findings);

/// The probability of the verdict: of the named set among the rivals, lowered by what is left unexplained.
[[nodiscard]] double confidence(const Findings& findings, const Diagnosis& so_far, Rules& rules);

/// That the refit of the known parameters gives up an output for the others, or the effects do, with both numbers.
[[nodiscard]] std::string warning_of_worse(const GapFinding& gap, bool refit, bool effects);

/// That the search ended before its time, with what it had tried.
[[nodiscard]] std::string warning_of_effort(double effort, std::size_t candidates);
[[nodiscard]] std::string warning_of_time_limit(double seconds, std::size_t candidates);

/// What is said where effects leave less than a floor that took a part of them for noise.
[[nodiscard]] std::string warning_of_floor(const GapFinding& gap);

/// Why some things cannot be told apart from inputs and outputs, as far as it concerns this verdict. `duration`: of the
/// longest record, where a periodic disturbance was tried; else 0.
[[nodiscard]] std::vector<std::string> structural_reasons(const Diagnosis& so_far, double sample_time, double duration);

/// `gaps` are those of the outputs, and name their units: a column of a record may have none.
[[nodiscard]] std::vector<Trace> traces_of(const Task& task, const std::vector<GapFinding>& gaps,
                                           const VectorXd& nominal, const VectorXd& calibrated,
                                           const VectorXd& improved);

/// The verdict in one or two sentences. `below_material`: what is left is no noise, but too small to matter to the
/// user.
[[nodiscard]] std::string summary_of(const Diagnosis& found, bool below_material);

}  // namespace hysteron::diagnosis
