// Times of `hysteron history`: a moment in UTC, or a length of time back from the newest row.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hysteron::tool {

/// In milliseconds UTC; nothing for an empty text. 2026-11-28, 2026-11-28T07:05, 2026-11-28 07:05:30.5Z; 90s, 30min,
/// 2h, 3d before `newest_ms`. Throws InputError HY730 where it is none of these.
[[nodiscard]] std::optional<std::int64_t> history_time(const std::string& text, const std::string& option,
                                                       std::int64_t newest_ms);

}  // namespace hysteron::tool
