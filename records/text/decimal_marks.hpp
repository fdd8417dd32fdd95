// Which decimal mark the numbers of a file have, and where a mark could separate thousands instead.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "records/table.hpp"
#include "records/text/cell_value.hpp"
#include "records/text/source_text.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::records {

/// One column has one decimal mark, and so has the file: where both are found, one of them separates thousands.
class DecimalMarks {
 public:
  DecimalMarks() = default;
  /// Both must outlive this.
  DecimalMarks(const SourceText& source, Diagnostics& diagnostics, std::size_t columns)
      : source_(&source), diagnostics_(&diagnostics), columns_(columns) {}

  /// Takes a number. An error HY511 where its mark is another than that of an earlier number.
  void see(const Line& line, const Cell& cell, const CellValue& value, std::size_t column);

  /// `888;2.664`: where a column has whole numbers below a thousand beside some with three digits behind a point, and
  /// the separator is none that goes with a decimal point, the point may separate thousands: a fault HY511 of the
  /// column.
  void doubt_points(Table& table, char separator) const;

 private:
  using Seen = std::optional<std::pair<Line, Cell>>;
  struct Pointed {
    std::size_t count = 0;  ///< numbers with a point
    std::size_t whole = 0;  ///< numbers without a decimal mark
    bool thousands = true;  ///< all points could separate thousands
    Seen first{};
  };
  const SourceText* source_ = nullptr;
  Diagnostics* diagnostics_ = nullptr;
  std::vector<Pointed> columns_;
  Seen comma_seen_;
  Seen point_seen_;
};

}  // namespace hysteron::records
