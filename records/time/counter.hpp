// Counters that begin anew at their largest number.
#pragma once

#include <optional>
#include <vector>

namespace hysteron::records {

/// Counters of 16 and 32 bits begin anew: micros() after 71 minutes. What was counted since the first value; nothing
/// where the values rise anyway, or do not go on evenly so.
[[nodiscard]] std::optional<std::vector<double>> unwrapped(const std::vector<double>& values);

}  // namespace hysteron::records
