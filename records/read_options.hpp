// What a user states about a record, where the file does not say it or could be read in two ways.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace hysteron::records {

/// How rows at uneven times, or at another rate, become rows at an even sample time.
enum class Resampling : std::uint8_t {
  None,    ///< uneven times are refused
  Linear,  ///< on the straight line between the samples before and behind; for slow analog signals
  Hold,    ///< the last sample; for commands, encoders and switches, which step
  Average  ///< the mean of the samples within half a sample time on both sides; for noisy signals at a higher rate
};

/// A column by its name in the diagram, and by what the file calls it: a name, or its number from 1 on; with the unit
/// of its numbers, where the file states another or none.
struct ColumnName {
  std::string name{};
  std::string in_file{};
  std::string unit{};
  /// Said for many records, in a parameter file: a record without the column is read all the same, and may have one of
  /// the diagram's own name.
  bool is_general = false;
};

/// How one column becomes even: by its name in the diagram or in the file; of a vector, all its elements.
struct ColumnWay {
  std::string name{};
  Resampling way = Resampling::None;
  bool is_general = false;  ///< said for many records, in a parameter file: a record without the column is read
};

/// A port of the diagram that is called T, as the time is: what tells the two apart in a record.
struct SignalT {
  std::string unit{};        ///< empty where the diagram states none
  double sample_time = 0.0;  ///< s, of the diagram; 0 where it states none
};

struct ReadOptions {
  std::string time{};            ///< the column of the time; found where it is empty
  std::string time_unit{};       ///< its unit; what the file says where it is empty
  std::optional<double> rate{};  ///< rows per second, of a file without times
  std::vector<ColumnName> columns{};
  std::size_t skip = 0;           ///< lines above the record that are no part of it
  std::optional<char> decimal{};  ///< the decimal mark, '.' or ','; found where it is not stated
  std::optional<double> begin{};  ///< s: rows before it are left out
  std::optional<double> end{};    ///< s: rows from it on are left out
  std::size_t first_row = 1;      ///< rows of numbers before it are left out
  std::optional<std::size_t> last_row{};
  std::optional<SignalT> signal_t{};
  Resampling resampling = Resampling::None;  ///< of all columns that `ways` does not name
  std::vector<ColumnWay> ways{};
  std::vector<std::string> stepping{};  ///< columns that are held, however others are resampled: BOOL, DINT, WORD
  std::optional<double> sample_time{};  ///< s: what a record is resampled to; its own median step where none is given
  std::optional<double> origin{};  ///< s: a time of the grid that it is resampled to; its first where none is given

  [[nodiscard]] bool resamples() const { return resampling != Resampling::None || !ways.empty(); }
};

}  // namespace hysteron::records
