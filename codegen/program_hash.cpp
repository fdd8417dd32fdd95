#include "codegen/program_hash.hpp"

#include <fmt/format.h>

#include <iterator>

#include "codegen/cosimulation/fmu.hpp"
#include "support/numbers.hpp"
#include "support/sha256.hpp"

namespace hysteron {

std::string program_hash(const Program& program) {
  const Graph& graph = program.graph;
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  const auto wire = [&](const Wire& one) {
    fmt::format_to(out, " {}:{}:{}", static_cast<int>(one.from), one.index, one.port);
    if (one.from == Wire::From::Literal) {
      fmt::format_to(out, "={}", number_text(graph.literals[one.index]));
    }
  };
  fmt::format_to(out, "ts {}\n", graph.sample_time_ns);
  for (const Port& input : graph.inputs) {
    fmt::format_to(out, "input {} {}\n", language::upper(input.name), static_cast<int>(input.type));
  }
  for (const Parameter& parameter : graph.parameters) {
    fmt::format_to(out, "parameter {}", parameter.path);
    for (const double value : parameter.value) {
      fmt::format_to(out, " {}", number_text(value));
    }
    fmt::format_to(out, "\n");
  }
  for (const Node& node : graph.nodes) {
    fmt::format_to(out, "node {} {} {}", node.block != nullptr ? node.block->about.name : info(node.op).name,
                   node.rate.every, node.rate.phase);
    if (node.block != nullptr && node.block->fmu != nullptr) {
      fmt::format_to(out, " {}", node.block->fmu->hash());
    }
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      wire(graph.wire(node, pin));
    }
    fmt::format_to(out, "\n");
  }
  for (const InitialState& given : graph.initial_states) {
    fmt::format_to(out, "initial {} {} {}\n", given.node, given.state, number_text(given.value));
  }
  for (const Port& output : graph.outputs) {
    fmt::format_to(out, "output {} {}", language::upper(output.name), static_cast<int>(output.type));
    wire(output.wire);
    fmt::format_to(out, "\n");
  }
  return sha256({text.data(), text.size()}).substr(0, 16);
}

}  // namespace hysteron
