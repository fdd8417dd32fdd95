// The sets of laws in one space that may explain what is missing there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/evidence/block_regression.hpp"

namespace hysteron::diagnosis {

/// A set of laws and what it leaves.
struct LawSet {
  std::size_t space = 0;
  std::vector<std::size_t> laws{};  ///< by their place in the list of that space
  BlockRegression::Score score{};
  double log_square = 0.0;  ///< less that of the calibrated diagram
  double probability = 0.0;
};

class SetSearch {
 public:
  SetSearch(const std::vector<Law>& laws, const BlockRegression& regression, unsigned threads);

  /// Sets of none, one, two and three, of each kind (effects with their edges and drivers) the best; the empty one
  /// first.
  [[nodiscard]] std::vector<LawSet> run() const;

  [[nodiscard]] LawSet fitted(std::vector<std::size_t> list, bool bounded = true) const;
  /// No law: the calibrated diagram.
  [[nodiscard]] LawSet bare() const;
  [[nodiscard]] std::vector<std::string> families_of(const LawSet& one) const;

 private:
  [[nodiscard]] std::vector<LawSet> extended(const LawSet& from) const;
  /// Each member in turn at all of its other settings, until none is better.
  void polish(LawSet& one) const;
  [[nodiscard]] std::vector<std::string> kind_of(const LawSet& one) const;

  const std::vector<Law>& laws_;
  const BlockRegression& regression_;
  unsigned threads_;
};

}  // namespace hysteron::diagnosis
