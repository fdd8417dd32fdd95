// How far a search goes.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/model/budget.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

struct SearchOptions {
  CandidateOptions candidates{};
  unsigned threads = 2;
  int most_effects = 3;
  std::size_t fitted_first = 18;  ///< candidates that are fitted after the first screening
  std::size_t fitted_later = 10;  ///< and after each further one
  std::size_t beam = 3;     ///< sets that a second effect is added to; a further one is added to the best set alone
  int edges_of_front = 8;   ///< further ones that those effects are fitted on,
  int edges_of_others = 4;  ///< and the others, where none of those closes the gap
  std::size_t pairs = 10;   ///< pairs that are fitted because their changes would add up to the residual
  std::function<void(double fraction, std::string_view text)> progress{};
  Budget* budget = nullptr;  ///< after which nothing further is tried; null: none
  [[nodiscard]] bool is_over() const { return budget != nullptr && budget->is_over(); }
  /// Asked with the single effects, best first: whether the record shows something beside one that has to be mended
  /// first. The search then ends there.
  std::function<bool(const std::vector<Explanation>& singles)> ends_with_singles{};
};

}  // namespace hysteron::diagnosis
