#include "codegen/graph/body/whole_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "codegen/graph/body/body.hpp"
#include "codegen/graph/lowering.hpp"
#include "support/names.hpp"

namespace hysteron::bodies {
namespace {

std::optional<WholeInput> whole_of(Plain type) {
  if (!is_integer(type) || type == Plain::Dint) {
    return std::nullopt;
  }
  return WholeInput{.low = lowest(type), .high = highest(type), .unsigned_32 = is_unsigned_32(type)};
}

}  // namespace

std::vector<std::optional<WholeInput>> whole_inputs(const Graph& graph) {
  std::vector<std::optional<WholeInput>> result(graph.inputs.size());
  if (!graph.source || !graph.source->bodies) {
    return result;
  }
  const auto block = std::ranges::find_if(
      graph.source->blocks, [&](const auto& one) { return language::same_name(one.name.text, graph.name); });
  if (block == graph.source->blocks.end() || !block->sequential) {
    return result;
  }
  Graph scratch;
  GraphBuilder builder(scratch);
  Body body(*graph.source->bodies, graph.source->bodies->units[block->body],
            {.builder = builder,
             .report = [](int, language::Span, const std::string&, const std::string&) {},
             .add_parameter = [](const auto&) { return Wire{}; }});
  for (const BorderPort& port : body.ports(false)) {
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (equal_ignoring_case(graph.inputs[i].name, port.name)) {
        result[i] = whole_of(port.type);
      }
    }
  }
  return result;
}

std::string whole_fault(const WholeInput& input, double value) {
  const double low = input.unsigned_32 ? std::numeric_limits<std::int32_t>::min() : static_cast<double>(input.low);
  return value == std::floor(value) && value >= low && value <= static_cast<double>(input.high)
             ? std::string()
             : fmt::format("takes whole numbers from {} to {}", input.low, input.high);
}

double carried(const WholeInput& input, double value) {
  constexpr double half = 2147483648.0;
  return input.unsigned_32 && value >= half ? value - 2.0 * half : value;
}

void carry(const std::optional<WholeInput>& input, std::span<double> values) {
  if (!input) {
    return;
  }
  for (double& value : values) {
    value = carried(*input, value);
  }
}

}  // namespace hysteron::bodies
