// A record: named columns of numbers over an even time, as measured on a machine or computed by a diagram.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/diagnostic.hpp"
#include "support/time_heading.hpp"

namespace hysteron::records {

struct SourceText;

struct Column {
  std::string name{};
  std::string unit{};  ///< as written in the header, `u [V]`; empty where none is given
  std::vector<double> values{};
  std::string in_file{};  ///< what the file calls it, where that is another name
  double step = 0.0;  ///< the smallest one between two values as they were before resampling; 0: they are as they were
  [[nodiscard]] const std::string& name_in_file() const { return in_file.empty() ? name : in_file; }
};

/// Rows first, first + 1, … last − 1.
struct RowRange {
  std::size_t first = 0;
  std::size_t last = 0;
  [[nodiscard]] std::size_t size() const { return last - first; }
};

/// Column names are compared without regard to case, as the language does. The time is none of the columns; one that is
/// called t is a signal, and its name is T.
class Record {
 public:
  /// A record without columns, at times start, start + sample_time, … The sample time is in seconds, above 0.
  static Record even(double start, double sample_time, std::size_t rows);

  /// A record read from a file. `header` is the place of its header row, for errors about missing columns; `source`
  /// is the text, for errors about its numbers.
  Record(std::vector<double> time, double sample_time, std::vector<Column> columns, Place header,
         std::shared_ptr<const SourceText> source = nullptr);

  [[nodiscard]] std::size_t size() const { return time_.size(); }
  /// In seconds. Estimated from the whole record; the times themselves may be rounded.
  [[nodiscard]] double sample_time() const { return sample_time_; }
  /// In seconds, as recorded.
  [[nodiscard]] std::span<const double> time() const { return time_; }
  /// The file it came from; empty where it came from none.
  [[nodiscard]] const std::string& file() const { return header_.file; }

  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] std::vector<std::string> names() const;
  /// Those of the unreadable columns, too.
  [[nodiscard]] std::vector<std::string> all_names() const;
  /// Null where there is no such column. Throws InputError where there is one whose cells are no numbers.
  [[nodiscard]] const Column* find(std::string_view name) const;
  /// Throws InputError HY502, which names the columns there are, where there is no such column.
  [[nodiscard]] const Column& column(std::string_view name) const;

  /// Where the number of a column and row stands in the file; the file as a whole where that is not known.
  [[nodiscard]] Place place(std::string_view column, std::size_t row) const;
  [[nodiscard]] Place place_of_time(std::size_t row) const;

  /// Appends a column of as many values as there are rows. Throws std::invalid_argument on another number of values
  /// and on a name that is empty or taken.
  void add(Column column);

  /// Replaces the values of a column. Throws InputError HY502 where there is none, std::invalid_argument on another
  /// number of values.
  void replace(std::string_view name, std::vector<double> values);
  /// Brings a column to another unit: its numbers times `factor`. Throws InputError HY502 where there is none.
  void convert(std::string_view name, double factor, std::string unit);

  /// Takes a column away, where there is one.
  void remove(std::string_view name);

  /// Columns of the file that hold no numbers, each with what is wrong. Nobody is troubled by them who does not ask.
  struct Unreadable {
    std::string name{};
    Diagnostic fault{};
  };
  [[nodiscard]] const std::vector<Unreadable>& unreadable() const { return unreadable_; }
  void add_unreadable(std::string name, Diagnostic fault) {
    unreadable_.push_back({.name = std::move(name), .fault = std::move(fault)});
  }

  /// What was understood of a file that it does not say outright, a sentence each without capital and point.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  void note(std::string text) { notes_.push_back(std::move(text)); }

  /// What the file calls the column of the time; empty where it has none.
  [[nodiscard]] const std::string& time_name() const { return time_name_; }
  void set_time_name(std::string name) { time_name_ = std::move(name); }

  /// What the time is called where the record is written: `time` where a column is called T, or another record of the
  /// same signals may have one; else `t`.
  [[nodiscard]] std::string_view time_heading() const { return hysteron::time_heading(is_beside_t_); }
  void set_beside_t(bool is_beside_t) { is_beside_t_ = is_beside_t || find("T") != nullptr; }

  /// The rows of a range, with their times as they are.
  [[nodiscard]] Record slice(RowRange rows) const;

  /// The rows with begin ≤ t < end, in seconds. A hundredth of a sample counts as equal, so that rounded times fall
  /// on the side they are meant to, and adjoining intervals share no row.
  [[nodiscard]] RowRange rows_between(double begin, double end) const;

 private:
  std::vector<double> time_;
  double sample_time_;
  std::vector<Column> columns_;
  Place header_;
  std::shared_ptr<const SourceText> source_;
  std::size_t first_row_ = 0;  ///< in the source
  std::vector<Unreadable> unreadable_{};
  std::vector<std::string> notes_{};
  std::string time_name_ = "t";
  bool is_beside_t_ = false;
};

}  // namespace hysteron::records
