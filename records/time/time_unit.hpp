// Units of time, and which names of columns say that a column is the time.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hysteron::records {

/// A unit as a fraction of seconds: 1/1000 for ms, 60/1 for min. A division rounds once, so that 3 ms is the number
/// 0.003.
struct TimeUnit {
  std::string_view name{};
  std::int64_t over = 1;
  std::int64_t under = 1;

  [[nodiscard]] double seconds(double value) const {
    return value * static_cast<double>(over) / static_cast<double>(under);
  }
};

/// s, sec, seconds, ms, us, µs, ns, min, h, d and their words; nothing where it is none.
[[nodiscard]] std::optional<TimeUnit> time_unit(std::string_view text);

/// UTC, local, CEST, UTC+2: in brackets behind the time they are no unit.
[[nodiscard]] bool is_zone_of_time(std::string_view text);

/// The unit in which numbers since 1970 (or 1601, of FILETIME) of this size are; nothing where they are no such
/// numbers. One unit alone makes each of them a year from 2001 to 2286: the sizes lie apart by a factor of 1000.
[[nodiscard]] std::optional<TimeUnit> epoch_unit(std::int64_t number);

/// A unit that was most likely taken for seconds.
struct MistakenUnit {
  std::string_view words{};  ///< milliseconds
  std::string_view unit{};   ///< ms
};

/// Of a record whose step is `ratio` times the one expected, within a twentieth; nothing where it is no ratio of units.
[[nodiscard]] std::optional<MistakenUnit> mistaken_unit(double ratio);

struct TimeName {
  std::optional<TimeUnit> unit{};  ///< where the name has one: t_ms, Time (s), Zeit/ms
};

/// Whether a column of this name is the time, by what tools of the field call it.
[[nodiscard]] std::optional<TimeName> time_name(std::string_view name);

/// The unit behind a name that does not say time: ms of tick_ms and of ms; seconds and parts of them alone.
[[nodiscard]] std::optional<TimeUnit> unit_in_name(std::string_view name);

/// `nsec` of header.stamp.nsec.
[[nodiscard]] std::string_view last_word(std::string_view name);

/// `t` of t1 and t_1; the name itself where no number ends it.
[[nodiscard]] std::string_view without_number(std::string_view name);

/// Whether a column is called the time of another: t_u or u_time beside u.
[[nodiscard]] bool is_time_of(std::string_view name, std::string_view signal);

}  // namespace hysteron::records
