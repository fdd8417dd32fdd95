#include "runtime/history/history_trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "runtime/history/history_reader.hpp"
#include "runtime/history/tables.hpp"

namespace hysteron::runtime {
namespace {

using database::Statement;

constexpr std::int64_t places = 600;
constexpr std::int64_t rows_of_a_place = 200;  ///< that are looked at, at the most

/// What lies at one place.
class Gathered {
 public:
  void add(double value) {
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    sum_ += value;
    ++count_;
  }
  [[nodiscard]] bool is_empty() const { return count_ == 0; }
  [[nodiscard]] TrendPlace at(std::int64_t utc_ms, bool begins) const {
    return {.utc_ms = utc_ms, .low = low_, .mean = sum_ / static_cast<double>(count_), .high = high_, .begins = begins};
  }

 private:
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0.0;
  std::int64_t count_ = 0;
};

/// The first row that is young enough, and the newest. By halving the numbers of rows, which are in their order:
/// looking through all of them would take as long as there are many. A clock that was set back leaves several such
/// rows; one of them is found.
std::pair<std::int64_t, std::int64_t> rows_from(database::Database& database, std::int64_t from_ms) {
  Statement ends = database.prepared("SELECT (SELECT min(row) FROM rows), (SELECT max(row) FROM rows)");
  (void)ends.step();
  std::int64_t low = ends.integer(0);
  const std::int64_t newest = ends.integer(1);
  Statement look = database.prepared("SELECT utc_ms FROM rows WHERE row >= ? ORDER BY row LIMIT 1");
  for (std::int64_t high = newest; low < high;) {
    const std::int64_t middle = low + (high - low) / 2;
    look.reset();
    if (look.bind(1, middle).step() && look.integer(0) < from_ms) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return {low, newest};
}

}  // namespace

Trend trend_of(const std::filesystem::path& file, std::string_view point, std::int64_t span_ms) {
  HistoryReader reader(file);
  reader.hold_still();
  database::Database& database = reader.database();
  Trend trend;
  Statement named = database.prepared(
      "SELECT points.\"column\", unit FROM points JOIN recorded USING (\"column\") WHERE name = ? COLLATE NOCASE ORDER "
      "BY run DESC LIMIT 1");
  const auto newest = reader.newest_ms();
  if (!newest || !named.bind(1, point).step()) {
    return trend;
  }
  trend.unit = named.text(1);
  const std::string column = sql_name(named.text(0));

  const auto rows = rows_from(database, *newest - span_ms);
  const std::int64_t first = rows.first;
  const std::int64_t last = rows.second;
  trend.rows = last - first + 1;
  const std::int64_t width = (trend.rows + places - 1) / places;
  const std::int64_t stride = (width + rows_of_a_place - 1) / rows_of_a_place;

  std::map<std::int64_t, double> sample_times;  // by run, in ms
  for (const RecordedRun& run : reader.runs()) {
    sample_times[run.run] = run.sample_time() * 1e3;
  }
  Statement look = database.prepared(fmt::format("SELECT utc_ms, {}, run FROM rows WHERE row = ?", column));
  std::int64_t shift = 0;  // by which later times are moved on
  std::int64_t before = std::numeric_limits<std::int64_t>::min();
  bool is_after_gap = true;
  for (std::int64_t at = first; at <= last; at += width) {
    Gathered gathered;
    std::int64_t time = before;
    for (std::int64_t row = at; row < std::min(at + width, last + 1); row += stride) {
      look.reset();
      if (!look.bind(1, row).step()) {
        continue;
      }
      ++trend.looked_at;
      const std::int64_t shown = look.integer(0) + shift;
      const bool has_before = before != std::numeric_limits<std::int64_t>::min();
      if (has_before && shown < before) {
        trend.set_back += static_cast<double>(before - shown) * 1e-3;
        shift += before - shown;
      }
      const double usual = sample_times[look.integer(2)] * static_cast<double>(stride);
      is_after_gap = is_after_gap || (has_before && static_cast<double>(shown - before) > 2.5 * usual + 1.0);
      before = look.integer(0) + shift;
      if (!look.is_null(1)) {
        time = gathered.is_empty() ? before : time;
        gathered.add(look.number(1));
      }
    }
    if (!gathered.is_empty()) {
      trend.places.push_back(gathered.at(time, is_after_gap));
    }
    is_after_gap = gathered.is_empty();
  }
  return trend;
}

}  // namespace hysteron::runtime
