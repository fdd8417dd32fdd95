// Output error: parameters of any diagram fitted so that its simulated outputs meet the measured ones.
//
//   minimise over θ   ½ Σ ρ((y_model(t; θ) − y_measured(t)) / s)      over outputs, records and the times in train
//
// - Rollout. The diagram is simulated from its reset over each whole record, driven by the record's inputs alone: no
//   measured output is fed back. What is fitted is thus what `run` and generated code do.
// - Gradients. The interpreter with dual numbers, in passes of 4 or 8 parameters: exact, and with the values of the
//   plain run to the bit. They go to Ipopt with the Gauss-Newton Hessian: ipopt_problem.hpp.
// - Scales. s is the range of each output in train. With several outputs the fit is repeated with s = the RMSE that
//   the first one left, so that each counts by its own noise (iterated weighting; the likelihood of independent normal
//   noise is then met, and the standard errors hold).
// - An unknown offset of a sensor is a parameter of the diagram like any other (Y0 of a hysteresis, an input marked
//   @param that is added to the output): so what is fitted, run and generated stays one and the same.
// - Values that are not finite during a rollout reject the step.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "records/record.hpp"
#include "tuning/covariance.hpp"
#include "tuning/free_parameters.hpp"
#include "tuning/ipopt_problem.hpp"
#include "tuning/simulation.hpp"

namespace hysteron {

/// A state of type LREAL whose value after the reset is fitted, for each record on its own.
struct FreeState {
  std::string path{};  ///< LAG.XOUT, say
  std::string unit{};  ///< as the wires give it; empty where they do not
  std::string meaning{};
  Place place{};
  double lower = 0.0;
  double upper = 0.0;
};

/// A record as the fit sees it.
struct Experiment {
  std::string name{};  ///< the file
  std::vector<double> time{};
  Drive drive{};
  std::vector<Signal> measured{};  ///< by measured output
  std::vector<double> steps{};     ///< of its values before these were resampled; 0: they are as they were
  /// Multiple shooting (Bock and Plitt, IFAC 1984): before these steps, ascending, the initial states take other values
  /// that are unknowns of their own. All else that the diagram remembers goes on.
  std::vector<std::size_t> restarts{};
  std::vector<records::RowRange> train{};
  std::vector<records::RowRange> test{};
};

struct OutputErrorProblem {
  Program program{};  ///< with the values of the parameters that are not fitted
  std::vector<FreeParameter> parameters{};
  std::vector<FreeState> initial_states{};
  std::vector<std::size_t> outputs{};  ///< those measured, by their place in the graph
  std::vector<Experiment> experiments{};
  Loss loss = Loss::Squares;
};

/// The problem that a parameter file states for a diagram and its records. The values of the file are set in the
/// program; bounds come from [fit], else from the block's description. The diagram's outputs are matched to columns by
/// name without regard to case; its inputs as for a run.
/// @throws InputError with everything found: HY603 for a name in [fit] or [tune] that the diagram does not have, HY604
/// for a parameter that is no real number, HY606 for a start out of bounds, HY502 for a missing column, HY704 for
/// another sample time, HY716 where nothing is to be fitted, HY717 where no output was measured, HY718 for a record
/// without a sample in train.
/// `may_be_fixed`: a problem without anything to fit, to be evaluated only, is no error.
OutputErrorProblem output_error_problem(const Program& program, const parameters::ParameterFile& file,
                                        std::span<const records::Record> records, bool may_be_fixed = false);

struct OutputErrorOptions {
  /// Fits from this many points: the given one, and others spread over the bounds, always the same ones. The best
  /// counts.
  int starts = 1;
  int max_iterations = 300;
  /// Called once an iteration; false ends the fit with the best so far.
  std::function<bool(int start, const FitProgress&)> progress{};
};

/// Root of the mean squared error of one output, in its unit. NaN where there are no samples.
struct OutputScore {
  std::string output{};
  std::string unit{};
  double range = 0.0;       ///< of what was measured in train
  double test_range = 0.0;  ///< in test
  double train = 0.0;
  double test = 0.0;
  double before = 0.0;  ///< in train, at the start of the fit
  std::size_t train_samples = 0;
  std::size_t test_samples = 0;
};

struct OutputErrorFit {
  std::vector<std::string> names{};  ///< parameters, then initial states record by record
  std::vector<std::string> units{};  ///< of the same
  LeastSquaresResult solution{};     ///< residuals output by output, each in the order of records and times
  Covariance covariance{};
  std::vector<OutputScore> scores{};
  std::vector<std::vector<Signal>> model{};  ///< by record and measured output, over the whole record
  std::vector<double> start_costs{};         ///< ½Σρ reached from each start; NaN where it had no value
  int best_start = 0;
  double seconds = 0.0;  ///< wall-clock
};

/// Deterministic but for `seconds`.
/// @throws InputError HY711 where the model has no finite value at the start, HY719 where a parameter has no influence
/// on any sample in train.
OutputErrorFit fit_output_error(const OutputErrorProblem& problem, const OutputErrorOptions& options = {});

/// The parameter file with the fitted values in it; all else is kept, but for the heading of an earlier fit. The
/// initial states of a single record become its table [initial]; those of several records belong to each alone, and no
/// run could take them all. Of a parameter with a value for each record their mean is set, for runs and the next fit.
parameters::ParameterFile tuned_file(parameters::ParameterFile file, const OutputErrorProblem& problem,
                                     const OutputErrorFit& fit);

/// What stands at the top of it: the records, how the fit ended, and where there are several records what each has for
/// itself.
std::string tuned_heading(const OutputErrorProblem& problem, const OutputErrorFit& fit);

/// What is written beside its values: unit, meaning, standard error.
parameters::Remarks tuned_remarks(const OutputErrorProblem& problem, const OutputErrorFit& fit);

}  // namespace hysteron
