#include "codegen/graph/sample_time.hpp"

#include <fmt/format.h>

#include <utility>

#include "support/errors.hpp"

namespace hysteron {

Diagnostic missing_sample_time(const Graph& graph) {
  return {.number = error::missing_sample_time,
          .place = graph.place(graph.sample_time_span),
          .cause = fmt::format("{} states no sample time.", graph.name),
          .mend = fmt::format("write it behind the name: FUNCTION_BLOCK {} (* @ts 1ms *).", graph.name)};
}

void require_sample_time(const Graph& graph) {
  if (graph.sample_time_ns <= 0) {
    Diagnostics diagnostics;
    diagnostics.add(missing_sample_time(graph));
    throw InputError(std::move(diagnostics));
  }
}

}  // namespace hysteron
