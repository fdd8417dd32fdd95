// The text that a record was read from, and where its lines and cells stand in it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "records/text/csv_line.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::records {

/// A line without its end, and the offset of the next.
struct Line {
  std::string_view text{};
  std::size_t offset = 0;
  std::size_t next = 0;
};

/// The text is kept with the record, because places are asked for rarely, and to store one for each cell would take
/// more memory than the text does.
struct SourceText {
  std::string file{};
  std::string text{};
  char separator = ',';
  std::vector<std::string> names{};  ///< of the columns, as the record has them; empty of its time
  std::vector<std::size_t> rows{};   ///< the offsets of the rows of numbers

  [[nodiscard]] Line line_at(std::size_t offset) const;
  [[nodiscard]] Place place_of(const Line& line) const;
  [[nodiscard]] Place place_of(const Line& line, const Cell& cell) const;

  /// The place of a column's number in a row; the row as a whole where no column has the name.
  [[nodiscard]] Place place(std::string_view column, std::size_t row) const;
};

}  // namespace hysteron::records
