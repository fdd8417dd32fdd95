#include "diagnosis/verdict/simpler.hpp"

#include <utility>

#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

std::optional<Explanation> with_simpler_formulas(const Sets& sets, const Variant& bare, const Explanation& one,
                                                 double samples) {
  const auto support = [&](const Explanation& set) {
    return support_of(set.fit.cost, set.parameters(), set.variant.effects.size(), samples, 1);
  };
  std::optional<Explanation> best;
  for (std::size_t i = 0; i < one.variant.effects.size(); ++i) {
    const Explanation so_far = best ? *best : one;
    for (Explanation& simpler : sets.in_simpler_formulas(so_far, i, bare)) {
      if (support(simpler) > support(best ? *best : one)) {
        best = std::move(simpler);
      }
    }
  }
  return best;
}

}  // namespace hysteron::diagnosis
