// Which whole numbers the inputs of a sequential block take, by the types that its text declares: the graph carries an
// INT, a BYTE and a UDINT alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron::bodies {

struct WholeInput {
  std::int64_t low = 0;
  std::int64_t high = 0;
  bool unsigned_32 = false;  ///< UDINT, DWORD: carried by the DINT of the same bits, which a record may hold as well
};

/// By input of the graph; nothing where the carrier itself says it all: a BOOL, an LREAL, a DINT, a block that is no
/// sequential body.
[[nodiscard]] std::vector<std::optional<WholeInput>> whole_inputs(const Graph& graph);

/// Why an input cannot take a value, as `takes whole numbers from 0 to 255`; empty where it can.
[[nodiscard]] std::string whole_fault(const WholeInput& input, double value);

/// What carries a number of a record: of a UDINT above 2^31 - 1 the DINT of the same bits.
[[nodiscard]] double carried(const WholeInput& input, double value);

/// The same of all values of an input.
void carry(const std::optional<WholeInput>& input, std::span<double> values);

}  // namespace hysteron::bodies
