// A diagram with free parameters against its records, as the diagnosis fits it.
//
// Rows are the samples of the measured outputs, output by output, record by record; each residual is divided by the
// scale of its output, so that 1 is one standard deviation of what counts as noise. The unknowns are the known
// parameters of the diagram, each with a prior about its tuned value, then the parameters of effects, then the initial
// states that the parameter file asks for.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "diagnosis/model/effort.hpp"
#include "diagnosis/model/whitening.hpp"
#include "records/record.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::detail {
class Rollout;
}

namespace hysteron::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A parameter of the diagram that the diagnosis may change.
struct Unknown {
  std::string path{};  ///< HYST.C1, as in a parameter file
  std::string unit{};
  double start = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  double typical = 1.0;                 ///< size of a notable change
  double deviation = 0.0;               ///< of the prior about `start`; ∞: none
  bool rounds = false;                  ///< a quantum, 0 where it is off
  bool at_bound = false;                ///< the tuned value lies on a bound of its fit
  std::optional<std::size_t> record{};  ///< the only record that it acts in; none: all
};

/// Shooting of the records, each with its own initial states.
struct Shooting {
  std::vector<std::vector<std::size_t>> restarts{};  ///< by record: the steps at which a stretch begins, but the first
  std::vector<double> states{};  ///< where a fit begins: by record, stretch and state; empty: where the model is then
};

/// What stays the same while candidates come and go.
struct Task {
  parameters::ParameterFile file{};  ///< values and initial states only
  std::vector<records::Record> records{};
  std::vector<std::string> outputs{};  ///< the measured ones, by name
  std::vector<Unknown> known{};        ///< calibration parameters
  std::vector<std::string> initial_states{};
  std::shared_ptr<const Shooting> shooting{};    ///< null: each record from its start to its end
  std::vector<double> scales{};                  ///< of the residuals, by output
  std::vector<Index> left_out{};                 ///< rows that do not count: glitches
  std::vector<double> cells{};                   ///< by output: half the step on which a sensor gives it; empty: none
  std::shared_ptr<const Whitening> whitening{};  ///< of the residuals; null: their rows are independent
  std::shared_ptr<Effort> effort = std::make_shared<Effort>();  ///< of all that is done with it, in copies too
};

class Model {
 public:
  /// The program with the task's known parameters and further unknowns. Throws InputError where the diagram and the
  /// records do not fit together.
  Model(const Task& task, const Program& program, std::span<const Unknown> further = {});
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  ~Model();

  [[nodiscard]] Index rows() const;
  [[nodiscard]] Index unknowns() const { return start_.size(); }
  /// The first of the unknowns that were given as `further`.
  [[nodiscard]] Index first_further() const { return first_further_; }

  [[nodiscard]] const VectorXd& start() const { return start_; }
  [[nodiscard]] const VectorXd& lower() const { return lower_; }
  [[nodiscard]] const VectorXd& upper() const { return upper_; }
  [[nodiscard]] const VectorXd& typical() const { return typical_; }
  /// 1/deviation of the prior, 0 where there is none.
  [[nodiscard]] const VectorXd& prior() const { return prior_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] const OutputErrorProblem& problem() const { return *problem_; }
  /// x with its quanta off: nothing rounds.
  [[nodiscard]] VectorXd smooth(VectorXd x) const;
  /// How many samples each record has.
  [[nodiscard]] std::vector<std::size_t> samples() const;
  /// An output as it was measured, of all records one after the other.
  [[nodiscard]] std::vector<double> measured(std::size_t output) const;

  /// (model − measured)/scale, whitened where the task asks for it, and its derivatives; false where one is not finite.
  /// Of an output with a cell only what lies farther than that from the measured value.
  /// Rounding hides from derivatives what lies before it; on average the rounded signal follows the signal. Derivatives
  /// are those of the diagram with its quanta off, and 0 for a quantum itself: what its error gains by shrinking says
  /// nothing of where it lies.
  bool residuals(const VectorXd& x, VectorXd& residuals, MatrixXd* jacobian = nullptr);

  /// Points of which the residuals are likely to be asked for next: where the processor can, they are then simulated
  /// eight at a time. No answer differs by a bit, nor the work that is counted: a point that is not asked for costs
  /// nothing but time.
  void foresee(std::vector<VectorXd> points);
  /// As well as those that were foreseen before, and before them.
  void foresee_first(std::vector<VectorXd> points);

 private:
  bool smooth_jacobian(const VectorXd& x, MatrixXd& jacobian);
  void forgive_within_cells(VectorXd& residuals, MatrixXd* jacobian) const;
  void count_work(bool derivatives) const;

  std::unique_ptr<OutputErrorProblem> problem_;  ///< the rollout keeps a reference to it
  std::unique_ptr<hysteron::detail::Rollout> rollout_;
  VectorXd start_{};
  VectorXd lower_{};
  VectorXd upper_{};
  VectorXd typical_{};
  VectorXd prior_{};
  std::vector<std::string> names_{};
  std::vector<Index> left_out_{};
  std::vector<double> cells_{};  ///< in scales
  std::shared_ptr<const Whitening> whitening_{};
  std::shared_ptr<Effort> effort_;
  std::vector<Index> quanta_{};  ///< the unknowns that round
  Index first_further_ = 0;
};

}  // namespace hysteron::diagnosis
