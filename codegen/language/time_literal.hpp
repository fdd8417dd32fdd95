// Durations of IEC 61131-3: what stands behind T#.
#pragma once

#include <string_view>

namespace hysteron::language {

/// `1m30s`, `5.5ms`, `-2h` in milliseconds: parts of d, h, m, s, ms, us, ns, the largest first, a fraction in the last
/// alone. False where the text is none. The result is the nearest number to the whole time, rounded once.
bool milliseconds_of_time(std::string_view text, double& milliseconds);

}  // namespace hysteron::language
