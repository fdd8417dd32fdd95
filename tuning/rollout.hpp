// Rollouts of an output-error problem: outputs over all records, residuals, and their Jacobian by dual numbers.
// Internal to output_error.cpp.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tuning/machine_dual.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::detail {

/// The unknowns are the parameters, then the initial states of the first record, of the second, …
class Rollout {
 public:
  explicit Rollout(const OutputErrorProblem& problem);

  [[nodiscard]] Eigen::Index residual_count() const { return rows_; }
  [[nodiscard]] Eigen::Index unknowns() const;

  /// Divisors of the residuals, by measured output.
  void set_scales(std::vector<double> scales) { scales_ = std::move(scales); }
  [[nodiscard]] const std::vector<double>& scales() const { return scales_; }

  /// (model − measured)/scale in train, output by output; false where one is not finite.
  bool residuals(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian);

  /// The measured outputs of one record over all its steps.
  [[nodiscard]] std::vector<Signal> outputs(const Eigen::VectorXd& x, std::size_t experiment);

  /// The values that the states have after a reset with these parameters.
  [[nodiscard]] std::vector<double> states_after_reset(const Eigen::VectorXd& x);

 private:
  /// One pass over one record: S carries the derivatives by the unknowns in `columns`.
  template <class S>
  bool pass(Machine<S>& machine, const Eigen::VectorXd& x, std::size_t experiment,
            std::span<const Eigen::Index> columns, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian);
  template <class S>
  void prepare(Machine<S>& machine, const Eigen::VectorXd& x, std::size_t experiment,
               std::span<const Eigen::Index> columns);
  template <class S>
  static void drive(Machine<S>& machine, const Drive& drive, std::size_t step);
  [[nodiscard]] Eigen::Index state_column(std::size_t experiment, std::size_t state) const;

  const OutputErrorProblem& problem_;
  std::vector<double> scales_{};
  Eigen::Index rows_ = 0;
  std::vector<std::vector<Eigen::Index>> first_row_{};  ///< of the residuals, by record and output
  Machine<double> plain_;
  std::optional<Machine<Dual<4>>> four_{};
  std::optional<Machine<Dual<8>>> eight_{};
};

}  // namespace hysteron::detail
