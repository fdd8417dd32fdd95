// Which points are kept or published, and how often: the keys `points` and `every` of [history] and [mqtt].
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/config/toml_reader.hpp"
#include "runtime/task/step_program.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime {

/// Periods from row to row: `every` as a whole number of them, about a second without the key.
[[nodiscard]] std::uint64_t read_step(TomlReader& table, const ProgramShape& shape, Diagnostics& found);

/// The points that are named, in the words of the door, whatever case they are written in: inputs, outputs,
/// parameters, and what the task says of itself and of its devices. Inputs and outputs where none are named.
[[nodiscard]] std::vector<std::string> read_points(TomlReader& table, const ProgramShape& shape,
                                                   std::span<const Point> field_points, Diagnostics& found);

}  // namespace hysteron::runtime
