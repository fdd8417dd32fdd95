// What options take that are numbers, in words that a user reads; the library's own print the limits of its types.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace hysteron::tool {

/// A whole number from `least` on, of 64 bits.
[[nodiscard]] CLI::Validator whole_number_from(std::uint64_t least);

/// A finite number from 0 on.
[[nodiscard]] CLI::Validator number_from_zero();

/// A finite number from `least` to `most`. CLI::Range takes nan, which is beyond neither of its ends.
[[nodiscard]] CLI::Validator number_between(double least, double most);

/// A finite number above 0.
[[nodiscard]] CLI::Validator number_above_zero();

}  // namespace hysteron::tool
