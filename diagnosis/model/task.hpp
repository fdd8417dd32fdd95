// From what the user gives to the task of a diagnosis: which parameters count as known, which columns are measured.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/model/input.hpp"
#include "diagnosis/model/model.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::diagnosis {

/// Known parameters are those that the parameter file marks for fitting; where it marks none, every real number that is
/// not 0 and no starting value: gains, time constants, the constants of a hysteresis. Each has a prior of 30 % about
/// its tuned value, wide enough for a poor tuning and narrow enough that no parameter runs away where the record does
/// not see it.
/// @throws InputError as output_error_problem does.
[[nodiscard]] Task task_of(const DiagnosisInput& input);

/// Columns of the records that are neither input nor output of the diagram and could be inputs by their name.
[[nodiscard]] std::vector<std::string> unused_columns(const Task& task, const Program& program);

/// A remark on each known parameter that lies on a bound of its fit: the tuning ran into it, and began the diagnosis
/// where it could not go on.
[[nodiscard]] std::vector<std::string> remarks_on_bounds(const Task& task);

/// HY711: the diagram has no finite value with the parameters as given.
[[nodiscard]] InputError error_of_start(const DiagnosisInput& input);

/// The values of columns, record by record.
[[nodiscard]] std::vector<std::vector<Signal>> columns_by_record(const Task& task,
                                                                 const std::vector<std::string>& names);

/// Of an output by its name; empty where it has none.
[[nodiscard]] std::string unit_of(const Program& program, const std::string& output);

/// Of the longest record, in s.
[[nodiscard]] double longest_duration(const Task& task);

/// The residuals of one output by record, in its unit.
[[nodiscard]] std::vector<Signal> by_record(const Task& task, const VectorXd& residuals, std::size_t output);

/// The RMS of one output's residuals over the samples that count, in its unit.
[[nodiscard]] double rms_of(const Task& task, const VectorXd& residuals, std::size_t output);

}  // namespace hysteron::diagnosis
