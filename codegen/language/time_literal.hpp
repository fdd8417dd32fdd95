// Durations of IEC 61131-3: what stands behind T#.
#pragma once

#include <optional>
#include <string_view>

namespace hysteron::language {

/// `1m30s`, `5.5ms`, `-2h` in nanoseconds: parts of d, h, m, s, ms, us, ns, the largest first, a fraction in the last
/// alone. Nothing where the text is none.
std::optional<double> nanoseconds_of_time(std::string_view written);

/// The same in milliseconds: the nearest number to the whole time, rounded once. False where the text is none.
bool milliseconds_of_time(std::string_view text, double& milliseconds);

}  // namespace hysteron::language
