// What several changes of the residual would explain together, from what each of them does by itself: a few products
// of columns in the place of a rollout for each combination. Exact where the outputs are linear in the changes.
#pragma once

#include <vector>

#include "diagnosis/model/background.hpp"

namespace hysteron::diagnosis {

class Superposition {
 public:
  /// `changes` as columns, each of the size of the residual.
  Superposition(const MatrixXd& changes, const Background& background);

  struct Interval {
    Index begin = 0;    ///< column of the step with which it begins
    Index end = 0;      ///< and of the one that takes it back; the number of columns: none does
    double size = 0.0;  ///< in units of the step
    double gain = 0.0;
  };
  /// Of steps at so many instants, one after the other, the intervals between two of them that explain most, best
  /// first, none of them next to another. A closed loop forgets a step within a few samples, and on a grid of
  /// beginnings and ends that is coarse enough to be run whole none is near the true ones.
  [[nodiscard]] std::vector<Interval> intervals(std::size_t count) const;

  struct Pair {
    Index first = 0;
    Index second = 0;
    double gain = 0.0;
  };
  /// All pairs, those first that explain most, each change in the size that suits the pair best, within a factor of
  /// `range` of what it is.
  [[nodiscard]] std::vector<Pair> pairs(double range) const;

 private:
  /// Without the column for what does nothing, the last one.
  [[nodiscard]] Index count() const { return matrix_.cols() - 1; }

  MatrixXd matrix_{};  ///< Dᵀ P D
  VectorXd slope_{};   ///< Dᵀ P r
};

}  // namespace hysteron::diagnosis
