// A plant in its loop, taken out of it where its own input was measured.
//
// In a loop the gap shows in the effort, hardly in the position, and all that the controller does hides what the plant
// lacks. Where the effort is a column of the record, the plant is run by it; the controller is no part of the question.
#pragma once

#include <optional>
#include <string>

#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

struct OpenLoop {
  Task task{};  ///< without the output at which the loop was cut; its column is an input
  Variant variant{};
  std::string cut{};  ///< that output
};

/// Nothing where no measured output drives another one that drives it in turn.
[[nodiscard]] std::optional<OpenLoop> opened(const Task& task, const std::string& top, const Variant& variant);

}  // namespace hysteron::diagnosis
