// A trace of the runtime, run again on the diagram that it was recorded from.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "runtime/task/trace_file.hpp"
#include "support/diagnostic.hpp"
#include "tool/diagram.hpp"

namespace hysteron::tool {

struct Replayed {
  std::shared_ptr<runtime::StepProgram> program{};
  runtime::ReplayResult result{};
};

/// Every recorded step is handed on. `engine` as in serve; empty for the default.
/// Throws InputError with what is wrong with the trace.
[[nodiscard]] Replayed replay_trace(
    const DiagramOptions& diagram, const std::string& trace, const std::string& engine, Diagnostics& found,
    const std::function<void(const runtime::ProgramShape&, const runtime::TraceStep&)>& on_step = {});

}  // namespace hysteron::tool
