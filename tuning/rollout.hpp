// Rollouts of an output-error problem: outputs over all records, residuals, and their Jacobian by dual numbers.
// Internal to output_error.cpp.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tuning/machine_dual.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::detail {

/// The unknowns are the parameters, those of a single record among them, then the initial states of the first record,
/// at its start and at each of its restarts, of the second, …
class Rollout {
 public:
  explicit Rollout(const OutputErrorProblem& problem);

  [[nodiscard]] Eigen::Index residual_count() const { return rows_; }
  [[nodiscard]] Eigen::Index unknowns() const;

  /// Whose value an unknown behind the parameters is: of a state, at a start of a record: 0, then its restarts.
  struct StateColumn {
    std::size_t experiment = 0;
    std::size_t start = 0;
    std::size_t state = 0;
  };
  [[nodiscard]] std::vector<StateColumn> state_columns() const;

  /// Divisors of the residuals, by measured output.
  void set_scales(std::vector<double> scales) { scales_ = std::move(scales); }
  [[nodiscard]] const std::vector<double>& scales() const { return scales_; }

  /// (model − measured)/scale in train, output by output; false where one is not finite. What other blocks still
  /// remember of the states before a restart counts, in the Jacobian, for those after it.
  bool residuals(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian);

  /// The measured outputs of one record over all its steps.
  [[nodiscard]] std::vector<Signal> outputs(const Eigen::VectorXd& x, std::size_t experiment);

  /// The values that the states have by themselves with these parameters, in the order of the unknowns: after the reset
  /// of each record, and when it comes to its restarts.
  [[nodiscard]] std::vector<double> own_states(const Eigen::VectorXd& parameters);

 private:
  bool all_residuals(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian);
  /// One pass over one record: S carries the derivatives by the unknowns in `columns`.
  template <class S>
  bool pass(Machine<S>& machine, const Eigen::VectorXd& x, std::size_t experiment,
            std::span<const Eigen::Index> columns, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian);
  template <class S>
  void prepare(Machine<S>& machine, const Eigen::VectorXd& x, std::size_t experiment,
               std::span<const Eigen::Index> columns);
  template <class S>
  static void drive(Machine<S>& machine, const Drive& drive, std::size_t step);
  /// The states at a start of a record: 0, then its restarts. `columns` are those of start 0.
  template <class S>
  void load_states(Machine<S>& machine, const Eigen::VectorXd& x, std::size_t experiment, std::size_t start,
                   std::span<const Eigen::Index> columns);
  /// Whether a record restarts at this step; then `start` is counted on and its states are loaded.
  template <class S>
  bool restarts(Machine<S>& machine, const Eigen::VectorXd& x, std::size_t experiment, std::size_t step,
                std::size_t& start, std::span<const Eigen::Index> columns);
  /// The parameters that act in a record; each as S gives its value and its derivatives.
  template <class S>
  void set_parameters(Machine<S>& machine, const Eigen::VectorXd& parameters, std::size_t experiment,
                      std::span<const Eigen::Index> columns);
  [[nodiscard]] Eigen::Index state_column(std::size_t experiment, std::size_t start, std::size_t state) const;
  /// Of what is in this column at start 0.
  [[nodiscard]] Eigen::Index column_at(Eigen::Index column, std::size_t start) const;

  const OutputErrorProblem& problem_;
  std::vector<double> scales_{};
  Eigen::Index rows_ = 0;
  std::vector<std::vector<Eigen::Index>> first_row_{};  ///< of the residuals, by record and output
  std::vector<Eigen::Index> first_state_{};             ///< column of the first state, by record; at the end their sum
  Machine<double> plain_;
  std::optional<Machine<Dual<4>>> four_{};
  std::optional<Machine<Dual<8>>> eight_{};
};

}  // namespace hysteron::detail
