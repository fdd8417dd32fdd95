#include "tool/replayed.hpp"

#include <fmt/format.h>

#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {

Replayed replay_trace(const DiagramOptions& diagram, const std::string& trace, const std::string& engine,
                      Diagnostics& found,
                      const std::function<void(const runtime::ProgramShape&, const runtime::TraceStep&)>& on_step) {
  Replayed result{.program = step_program(load_diagram(diagram, found), engine_of(engine), diagram.float32)};
  const auto bytes = read_text_file(trace);
  const auto fault = runtime::replay(bytes, *result.program, result.result, [&](const runtime::TraceStep& step) {
    if (on_step) {
      on_step(result.program->shape(), step);
    }
  });
  if (!fault.empty()) {
    throw InputError(error::broken_trace, {.file = trace}, fmt::format("This cannot be replayed: {}.", fault),
                     "give the trace that `hysteron serve` wrote of this diagram, and the same --engine.");
  }
  return result;
}

}  // namespace hysteron::tool
