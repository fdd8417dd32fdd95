// The draws by which sets of effects are held against each other, of laws and of runs alike: weights of the blocks
// (Rubin's Bayesian bootstrap, Ann. Statist. 9 (1981) 130), and an error of each formula that all blocks have in
// common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "diagnosis/model/model.hpp"
#include "diagnosis/rules.hpp"

namespace hysteron::diagnosis {

/// Σ_o ln(Σ_b w_b E_bo / Σ_b w_b n_b) / outputs: the log of the mean square, each output in its own scale.
[[nodiscard]] double log_square(const MatrixXd& squares, const MatrixXd& counts, const VectorXd& weights);

class Draws {
 public:
  Draws(std::uint64_t seed, std::size_t blocks, const Rules& rules);

  /// The next one: other weights, and other errors.
  void draw();
  [[nodiscard]] const VectorXd& weights() const { return weights_; }
  /// What a set costs beside what it leaves: its formulas' error, the same for all sets of the same families in a draw,
  /// and the price of its effects. In ln.
  [[nodiscard]] double cost(const std::vector<std::string>& families, std::size_t effects);

 private:
  std::mt19937_64 random_;
  std::exponential_distribution<double> weight_{1.0};
  std::normal_distribution<double> error_{0.0, 1.0};
  double model_error_;
  double price_;
  VectorXd weights_;
  std::map<std::vector<std::string>, double> errors_{};
};

}  // namespace hysteron::diagnosis
