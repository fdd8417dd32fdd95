// A record whose times are not even: to be shown, drawn, or compared row by row.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "records/read_options.hpp"
#include "records/record.hpp"

namespace hysteron::records {

/// As parse_record, but uneven times are no error: they are as in the file, and the sample time is their median step,
/// which may be 0. For showing alone: what runs over a record steps evenly.
[[nodiscard]] Record parse_uneven_record(const std::string& file, std::string bytes, const ReadOptions& options);

/// As parse_record, but times that rise unevenly are kept, and a note says so. For what takes a record row by row.
[[nodiscard]] Record parse_as_recorded(const std::string& file, const std::string& bytes, const ReadOptions& options);

/// What is uneven in times.
struct TimeSurvey {
  double usual = 0.0;              ///< s: the median step
  double jitter = 0.0;             ///< s: of the other steps from it, RMS
  std::size_t gaps = 0;            ///< steps in which rows are missing
  std::size_t missing = 0;         ///< rows that would fill them
  std::size_t first_gap = 0;       ///< the row before it, from 1 on; 0 without gaps
  double longest_gap = 0.0;        ///< s
  std::size_t close = 0;           ///< steps of less than half of it
  std::size_t backward = 0;        ///< steps that are zero or negative
  std::size_t first_backward = 0;  ///< the row behind it, from 1 on; 0 where there is none

  [[nodiscard]] bool is_even() const { return gaps == 0 && close == 0 && backward == 0 && jitter <= 0.02 * usual; }
};

/// How many rows are missing between a row, not the first, and the one before it: a step of more than one and a half of
/// the usual one, and the rows about it are fewer than fill their time. A stamp that came late or early is no gap.
[[nodiscard]] std::size_t rows_missing_before(std::span<const double> time, std::size_t row, double usual);

/// Of two times or more.
[[nodiscard]] TimeSurvey survey_of(std::span<const double> time);

}  // namespace hysteron::records
