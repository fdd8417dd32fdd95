// Linear regression of a residual on responses, scored on blocks that the fit did not see.
//
//   minimise over δ, α   Σ_o Σ_k ((r + J δ + Σ D α)_ok / s_o)²
//
// J are the sensitivities of the known parameters, D the responses of the laws of a set. Where a law is only known to
// lie within S|α| of D α, what lies within that is nothing: (|r + J δ + D α| − S|α|)₊ takes the place of the residual.
// Such rows are no test of the law. Held to its tests, it is charged for them as for the rows that are: with the same
// part of what is missing there.
// For each block the coefficients are found without it, and what they leave there is its held-out energy. The Gram
// matrices of the blocks are formed once for a set, so that all these fits cost little more than one (Allen's PRESS, by
// blocks).
#pragma once

#include <span>
#include <vector>

#include "diagnosis/evidence/blocks.hpp"
#include "diagnosis/evidence/laws.hpp"

namespace hysteron::diagnosis {

struct BlockRegressionOptions {
  VectorXd reach{};               ///< how far each known parameter may move; empty: as far as it will
  bool is_held_to_tests = false;  ///< rows within a slack are charged, and not free
};

class BlockRegression {
 public:
  struct Score {
    bool allowed = false;  ///< no share lies out of its bounds, and no known parameter out of its reach
    MatrixXd held_out{};   ///< Σr² by block and output, in squares of the task's scales
    VectorXd shares{};     ///< of the terms, in the order of the laws
    VectorXd known{};      ///< changes of the known parameters
    VectorXd errors{};     ///< standard errors of the shares, by leaving blocks out (the jackknife)
  };

  /// Both are thinned.
  BlockRegression(const Blocks& blocks, VectorXd residuals, MatrixXd known, BlockRegressionOptions options = {});

  /// Of shares within their bounds, or of any.
  [[nodiscard]] Score with(std::span<const Law* const> laws, bool bounded = true) const;

  /// Of the calibrated diagram: with its known parameters fitted anew to the other blocks, or as they are where that
  /// predicts better. A refit that only bends to what is missing would make every law look good.
  [[nodiscard]] Score bare() const;

  [[nodiscard]] const VectorXd& residuals() const { return residuals_; }
  [[nodiscard]] const MatrixXd& known() const { return known_; }

  /// Divisors of the outputs: what the best set so far leaves of each.
  void weigh(const MatrixXd& held_out);

  /// Σ_o n_o ln(Σ_b w_b E_bo / Σ_b w_b n_b) / Σ n: the log of the mean square over the outputs, each in its own scale.
  [[nodiscard]] double log_square(const MatrixXd& held_out, const VectorXd& weights) const;
  [[nodiscard]] double log_square(const MatrixXd& held_out) const;

 private:
  /// Of a set: its columns with their bounds, and what is free to either side; no slacks where none is.
  struct Terms {
    MatrixXd columns{};
    MatrixXd slacks{};
    VectorXd low{};
    VectorXd high{};
  };
  /// Gram matrices and products of a fit: by run, whole and by block.
  struct Products {
    std::vector<MatrixXd> grams{};
    std::vector<VectorXd> products{};
    MatrixXd whole{};
    VectorXd product{};
    std::vector<MatrixXd> of_block{};
    std::vector<VectorXd> product_of_block{};
  };
  [[nodiscard]] Terms terms_of(std::span<const Law* const> laws, bool bounded) const;
  /// `is_own`: the known columns are those of the task.
  [[nodiscard]] Products products_of(const MatrixXd& known, const MatrixXd& columns, const VectorXd& residuals,
                                     bool is_own) const;
  /// Of the rows that lie out of their slack, from its nearer end: a fit by an active set.
  [[nodiscard]] Products settled(const Terms& terms) const;
  /// What fits without each block leave in it: Σr² by block and output.
  [[nodiscard]] MatrixXd left_with_slack(const Terms& terms, const std::vector<VectorXd>& without) const;
  /// What is left of each row without laws, of the bare fit that does not see its block.
  [[nodiscard]] VectorXd gap_without_laws() const;

  const Blocks& blocks_;
  VectorXd residuals_;
  MatrixXd known_;
  VectorXd reach_;
  bool is_held_to_tests_;
  VectorXd weights_{};             ///< by output
  std::vector<MatrixXd> grams_{};  ///< of `known`, by run, not weighted
  MatrixXd counts_{};              ///< rows by block and output
  VectorXd gap_{};                 ///< without laws
};

}  // namespace hysteron::diagnosis
