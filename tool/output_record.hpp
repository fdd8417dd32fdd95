// Computed signals: as CSV, and checked for values that are no numbers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "support/diagnostic.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {

/// Columns over a time. Numbers are written as the shortest text that reads back to the same bits; of 32-bit floats,
/// to the same bits of a float.
[[nodiscard]] std::string output_csv(std::span<const double> time, const std::vector<std::string>& names,
                                     const std::vector<Signal>& columns, bool float32);

/// Reports HY706 for each column that holds an infinity or not-a-number: the first step where it does, and how many.
/// \p places are those of the columns in the diagram; none where it is known from elsewhere.
void check_finite(const std::vector<Place>& places, std::span<const double> time, const std::vector<std::string>& names,
                  const std::vector<Signal>& columns, Diagnostics& diagnostics);

}  // namespace hysteron::tool
