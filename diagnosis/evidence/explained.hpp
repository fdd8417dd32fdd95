// A set of laws as the diagram with its effects, fitted over whole records: what the user gets as improved.st.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/evidence/evidence.hpp"

namespace hysteron::diagnosis {

/// The laws of the set that the text of the diagram has a place for, each begun from where the evidence found it.
/// Nothing where it has none, or where the fit closes less than half of what the evidence promises.
[[nodiscard]] std::optional<Explanation> explained(const Task& task, const std::string& top, const SetFinding& set,
                                                   const Explanation& calibrated,
                                                   const std::vector<std::string>& columns);

}  // namespace hysteron::diagnosis
