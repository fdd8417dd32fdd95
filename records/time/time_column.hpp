// Which column of a table is the time, and what it is in seconds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "records/read_options.hpp"
#include "records/table.hpp"
#include "records/time/time_grid.hpp"

namespace hysteron::records {

struct Times {
  std::vector<double> seconds{};
  TimeGrid grid{};                     ///< in seconds
  std::vector<std::size_t> used{};     ///< the columns that the time is made of, or that repeat it
  std::optional<std::size_t> index{};  ///< the first of them; none where the rate is stated
  std::string column{};                ///< its name
  std::vector<std::string> notes{};
  /// Where each signal has times of its own: those of the column behind each, by column; else empty.
  struct Own {
    std::size_t column = 0;
    std::vector<double> seconds{};
  };
  std::vector<Own> own{};

  [[nodiscard]] bool uses(std::size_t column_index) const {
    return std::ranges::find(used, column_index) != used.end();
  }
};

/// Finds it: the column that is stated; else the one that is called so, or holds dates or times of day, and rises.
/// Throws InputError: HY502 where there is none, HY514 where two could be meant, HY512 where its unit is no unit of
/// time; and the fault of the column where one of its cells is no time.
[[nodiscard]] Times times_of(const Table& table, const ReadOptions& options);

}  // namespace hysteron::records
