// Laws of the evidence in the text of a diagram: as effects, with the numbers from which a fit may begin.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/evidence/law_findings.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// Effects in the diagram, and where their numbers begin.
struct Beginning {
  Variant variant{};
  VectorXd x{};                  ///< of the known parameters and of the effects
  std::vector<Index> travels{};  ///< in x, of frictions: how far they give
};

/// With the law on its edge, where the text has a place for it. Says whether it has, with the law's own drivers.
[[nodiscard]] bool add_law(const Task& task, const std::string& top, const LawFinding& law,
                           const Explanation& calibrated, const std::vector<std::string>& columns,
                           Beginning& beginning);

}  // namespace hysteron::diagnosis
