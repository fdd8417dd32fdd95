#include "tool/replayed.hpp"

#include <fmt/format.h>

#include "runtime/task/layout_text.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {
namespace {

using runtime::LayoutEngine;

/// By the head of the trace, where nobody says another one: its state lies in the bytes of the engine that recorded it.
Engine engine_for(const std::string& asked, const std::string& trace, const DiagramOptions& diagram,
                  const LayoutEngine& recorded) {
  const auto refuse = [&](std::string_view cause, const char* mend) {
    throw InputError(error::broken_trace, {.file = trace}, fmt::format("This cannot be replayed: {}.", cause), mend);
  };
  if (recorded.is_float32 != diagram.float32) {
    refuse(recorded.is_float32 ? "the trace was recorded with --float32" : "the trace was recorded without --float32",
           recorded.is_float32 ? "give --float32." : "leave --float32 out.");
  }
  const Engine engine = recorded.is_interpreted ? Engine::interpreter : Engine::compiled;
  if (!asked.empty() && engine_of(asked) != engine) {
    refuse(recorded.is_interpreted ? "the trace was recorded by the interpreter"
                                   : "the trace was recorded by the compiled engine",
           "leave --engine out.");
  }
  return engine;
}

}  // namespace

Replayed replay_trace(const DiagramOptions& diagram, const std::string& trace, const std::string& engine,
                      Diagnostics& found,
                      const std::function<void(const runtime::ProgramShape&, const runtime::TraceStep&)>& on_step) {
  const auto bytes = read_text_file(trace);
  const auto head = runtime::trace_head(bytes);
  const Engine by = head ? engine_for(engine, trace, diagram, runtime::engine_in(head->layout)) : engine_of(engine);
  Replayed result{.program = step_program(load_diagram(diagram, found), by, diagram.float32)};
  const auto fault = runtime::replay(bytes, *result.program, result.result, [&](const runtime::TraceStep& step) {
    if (on_step) {
      on_step(result.program->shape(), step);
    }
  });
  if (!fault.empty()) {
    throw InputError(error::broken_trace, {.file = trace}, fmt::format("This cannot be replayed: {}.", fault),
                     "give a trace that `hysteron serve` wrote, and the diagram as it was then.");
  }
  return result;
}

}  // namespace hysteron::tool
