// A text with places of arrays, `a[4] * x[0]`, that is found again in other rows and columns with other places. Texts
// that fit are one line in a loop: the loop is right by what its lines look like, in each language alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron {

/// How a target writes a place that a loop counts.
struct PlaceWords {
  std::string_view row{};         ///< counts rows; empty: there is one row
  std::string_view column{};      ///< counts columns; empty: there is one column
  std::string_view number_end{};  ///< behind each number
  bool brackets = false;          ///< round a product in a sum
};

class PlacePattern {
 public:
  /// The text in row 0 and column 0.
  explicit PlacePattern(std::string_view text);

  /// Whether the text in a row and column is the same but for its places, and these grow evenly. The first text in row
  /// 1, and the first in column 1, say by how much; they come before those behind them.
  bool takes(std::string_view text, std::size_t row, std::size_t column);

  /// One text for all: a[4 * row + column]. `of_sum` stands where the name `sum` was in the text.
  [[nodiscard]] std::string text(const PlaceWords& words, std::string_view of_sum = {}) const;
  static constexpr std::string_view sum = "\1";

  /// The pattern whose row 0 is a later row of this one.
  [[nodiscard]] PlacePattern after_rows(std::size_t rows) const;

 private:
  struct PlaceNumber {
    std::int64_t first = 0;
    std::optional<std::int64_t> by_row{};
    std::optional<std::int64_t> by_column{};
  };
  static std::string place_text(const PlaceNumber& place, const PlaceWords& words);

  std::vector<std::string> between_;  ///< one more than there are places
  std::vector<PlaceNumber> places_;
};

}  // namespace hysteron
