// The last hours of a point as a picture needs them: a few hundred places in time, with the lowest and the highest
// value of each. The work is bounded however many rows there are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::runtime {

struct TrendPlace {
  std::int64_t utc_ms = 0;
  double low = 0.0;
  double mean = 0.0;
  double high = 0.0;
  bool begins = false;  ///< behind a gap, or as the first
};

struct Trend {
  std::string unit{};
  std::vector<TrendPlace> places{};  ///< times never fall
  std::int64_t looked_at = 0;        ///< rows
  std::int64_t rows = 0;             ///< that there are in this time
  double set_back = 0.0;             ///< seconds by which the wall clock was set back meanwhile, altogether
};

/// Of a point, by its name; of the unit that it had last. Empty where it was not recorded in this time. Throws
/// InputError HY818 and database::DatabaseError.
[[nodiscard]] Trend trend_of(const std::filesystem::path& file, std::string_view point, std::int64_t span_ms);

}  // namespace hysteron::runtime
