// The functions on vectors that a batch brings along, as text.
#pragma once

#include <string_view>

namespace hysteron {

/// It is compiled once for each width of registers: behind `Real` and `Int`, with HYSTERON_LANES stated.
extern const std::string_view lanes_text;

}  // namespace hysteron
