// When a record was made: a date, a date with a time of day, or seconds since 1970.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hysteron::fleet {

/// Seconds since 1970-01-01T00:00:00Z of an ISO 8601 date (2026-05-02), date-time (2026-05-02T06:30,
/// 2026-05-02 06:30:00.5, with Z or +02:00; without a zone it is UTC) or a number of seconds since 1970. A number must
/// lie within the years 1973 to 2286, so that 2026, 20260502 and milliseconds are none. Nothing where it is neither.
[[nodiscard]] std::optional<double> seconds_of(std::string_view text);

/// The same as text: 2026-05-02 where it is midnight, else 2026-05-02 06:30; UTC. Empty for not-a-number.
[[nodiscard]] std::string date_text(double seconds);

}  // namespace hysteron::fleet
