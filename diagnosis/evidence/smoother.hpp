// The smoothest signal that explains an output: a fixed-interval smoother on a linear, time-varying system.
//
//   x(k+1) = A x + B w + d,   y = C x + D w + e + v,   v ~ N(0, σ²R),   w(k+1) = w(k) + N(0, σ²q)
//
// w is what is missing. Forward a Kalman filter, backward Bierman's recursion (G. J. Bierman, Automatica 9 (1973) 503),
// which inverts no covariance of states: a diagram has states that follow from others. All of it is linear in y, d
// and e, so that the same filter says what a known signal elsewhere takes off w.
#pragma once

#include <vector>

#include "diagnosis/evidence/tangent_run.hpp"

namespace hysteron::diagnosis {

/// One record, linearised along a course.
struct LinearSystem {
  Index states = 0;
  Index outputs = 0;
  MatrixXd a{};          ///< ∂(x', y)/∂(x, w): (states + outputs) × (states + 1), step by step side by side
  MatrixXd constants{};  ///< d, e: what is left of (x', y) at x = 0, w = 0
  MatrixXd measured{};   ///< outputs × steps
  VectorXd first{};      ///< x before the first step
  VectorXd spread{};     ///< standard deviations of x and w there
  VectorXd noise{};      ///< R, by output
  [[nodiscard]] Index steps() const { return measured.cols(); }
};

class Smoother {
 public:
  /// `step` is the square root of q.
  Smoother(const LinearSystem& system, double step);

  /// ln p(y), with σ at its best; with the number of samples and the sum of squares it rests on.
  [[nodiscard]] double log_likelihood() const { return log_likelihood_; }

  /// States and w over the steps.
  [[nodiscard]] MatrixXd smoothed() const;

  /// Their standard deviations, with σ at its best.
  [[nodiscard]] MatrixXd deviations() const;

  /// What w becomes where known signals enter (d, e) by `ways`, (states + outputs) × steps, and nothing is measured:
  /// steps × signals.
  [[nodiscard]] MatrixXd missing_for(const MatrixXd& ways, const MatrixXd& signals) const;

 private:
  /// Backward, on innovations outputs × steps; of each step all of z or w alone.
  const LinearSystem& system_;
  MatrixXd gains_{};        ///< z × outputs, side by side
  MatrixXd inverses_{};     ///< outputs × outputs
  MatrixXd covariances_{};  ///< of the prediction: z × z
  MatrixXd predicted_{};    ///< z × steps
  MatrixXd innovations_{};
  double log_likelihood_ = 0.0;
  double variance_ = 0.0;  ///< σ²
};

}  // namespace hysteron::diagnosis
