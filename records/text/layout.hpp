// Where in a text the record stands: its separator, its rows of numbers, and the names and units above them.
//
// No tool of the field writes the table alone. What stands round it is found by one principle instead of by the tools'
// names: the rows are the longest run of lines of the same cells with numbers in the same places; the names are the
// nearest line of as many cells above it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "records/text/counted_time.hpp"
#include "records/text/source_text.hpp"
#include "records/text/stated_rate.hpp"

namespace hysteron::records {

struct TextLayout {
  char separator = ',';
  std::size_t first_row = 0;           ///< its offset in the text
  std::size_t cells = 0;               ///< of a row
  std::optional<std::size_t> names{};  ///< the offset of the row of names
  struct Name {
    std::string name{};  ///< empty where the file has none
    std::string unit{};
    std::size_t cell = 0;  ///< in the row of names
    bool is_time = false;  ///< by the form of the head; no signal, whatever it is called
  };
  std::vector<Name> columns{};           ///< as many as cells; none where there are no names
  std::optional<CountedTime> counted{};  ///< what the first column counts
  std::optional<StatedRate> stated{};    ///< what the head says of the rate
  bool may_end_with_remark = false;      ///< a row may have one cell more than the columns
  std::vector<std::string> notes{};      ///< what was understood and left out
};

/// Whether a line is a remark: it begins with #, %, // or, where the semicolon does not separate, with a semicolon.
[[nodiscard]] bool is_comment(std::string_view line, char separator);

/// Finds it. `skip` lines at the top are no part of the record. Throws InputError HY501 where no line holds a number.
[[nodiscard]] TextLayout layout_of(const SourceText& source, std::size_t skip);

}  // namespace hysteron::records
