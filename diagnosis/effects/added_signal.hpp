// A diagram with a signal added on one of its edges, from a column of its own: what its outputs make of it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/effects/candidates.hpp"
#include "diagnosis/effects/signals.hpp"

namespace hysteron::diagnosis {

struct AddedSignal {
  std::shared_ptr<const Program> program{};
  std::string input{};  ///< of the diagram: the column that is added, 0 where a record has none
  Wire before{};        ///< the signal that it is added to
};

/// Nothing where the diagram refuses it. `source` is the text of the variant, and `edge` lies in the block `top`
/// itself.
[[nodiscard]] std::optional<AddedSignal> with_added_signal(const language::SourceFile& source, const Edge& edge,
                                                           const std::string& top, Variant variant);

/// The residuals at x with this signal added; empty where they have no value.
[[nodiscard]] VectorXd residuals_with(const Task& task, const AddedSignal& added, const RecordSignals& signal,
                                      std::span<const Unknown> further, const VectorXd& x);

}  // namespace hysteron::diagnosis
