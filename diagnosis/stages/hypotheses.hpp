// The sets of effects that explain what the diagram leaves of a record, fitted and weighed.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/model/budget.hpp"
#include "diagnosis/stages/cleaned.hpp"
#include "diagnosis/verdict/verdict.hpp"

namespace hysteron::diagnosis {

struct Hypotheses {
  Cleaned record{};                      ///< mended further, where an effect had hidden a fault
  std::unique_ptr<Searched> searched{};  ///< never empty
  std::size_t tried = 0;                 ///< candidates of all searches
  std::vector<std::string> warnings{};
};

/// What a search of this record is asked with. It keeps a reference to the budget.
[[nodiscard]] SearchOptions search_options(const Cleaned& record, const DiagnosisOptions& options, Budget& budget);

/// The search, done again where its first answer shows what had spoilt it: glitches beside an effect, or another state
/// at the start than the model's.
[[nodiscard]] Hypotheses hypotheses(Cleaned record, const DiagnosisOptions& options, Budget& budget);

}  // namespace hysteron::diagnosis
