// The parameter file beside a diagram: values, which of them are fitted, and how.
//
//   [parameters.INV]                      # values of the instance INV, by name without regard to case
//   C1 = 0.05
//   C2 = 1.3
//
//   [initial.SUM]                         # values that states have after a reset, instead of the block's own
//   SUM = 0.3
//
//   [fit.INV]                             # what `hysteron tune` may change; every key may be left out
//   C1 = {min = 0.0, max = 1.0, start = 0.05, scale = 1e-3}
//   C2 = {}
//
//   [fit.record.SENSOR]                   # what has a value of its own in each record: the zero of a day
//   OFFSET = {min = -1.0, max = 1.0}
//
//   [tune]
//   outputs = ["Y"]
//   train = [1.0, 21.0]
//
//   [diagnose]
//   ignore = ["SP"]                       # columns of the records that drive nothing
//
// The reader knows the form of the file; whether INV and C1 exist, and of what type and range, the diagram knows.
// Hence every value carries its place. Why the file has this shape: docs/decisions/0002-parameter-files.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "support/diagnostic.hpp"

namespace hysteron::parameters {

/// A whole number stands for an INT or for a REAL parameter alike: C1 = 1.
using Value = std::variant<bool, std::int64_t, double, std::vector<double>, std::vector<bool>>;

struct ParameterValue {
  std::string path{};  ///< "INV.C1", instance by instance, as written
  Value value{};
  Place place{};        ///< of the name, for a name that the diagram does not have
  Place value_place{};  ///< of the value, for a value out of range
};

struct PlacedNumber {
  double value = 0.0;
  Place place{};
};

struct PlacedText {
  std::string text{};
  Place place{};
};

/// A parameter to be fitted. Bounds and start lie in no contradiction to each other, nor to the value in the file.
struct FitSetting {
  std::string path{};
  Place place{};
  std::optional<PlacedNumber> minimum{};  ///< finite, or −∞
  std::optional<PlacedNumber> maximum{};  ///< finite, or +∞
  std::optional<PlacedNumber> start{};    ///< default: the value of the parameter
  std::optional<PlacedNumber> scale{};    ///< above 0: the size of a notable change
  bool by_record = false;                 ///< stands under [fit.record]: each record has a value of its own
  std::optional<std::size_t> record{};    ///< of this record alone; no file says so, but who has taken records apart
};

enum class Loss : std::uint8_t { Squares, Huber };

/// begin ≤ t < end, in seconds.
struct Interval {
  double begin = 0.0;
  double end = 0.0;
  Place place{};
};

struct TuneSettings {
  std::vector<PlacedText> outputs{};  ///< default, where empty: all outputs that the record has
  Loss loss = Loss::Squares;
  std::vector<Interval> train{};             ///< default, where empty: the whole record
  std::vector<Interval> test{};              ///< default, where empty: none
  std::vector<PlacedText> initial_states{};  ///< states whose initial values are fitted too
};

struct DiagnoseSettings {
  std::vector<PlacedText> ignore{};  ///< columns of the records that the diagnosis does not look at
};

/// How records are read where no option says otherwise: keys and texts are those of the tool's options.
struct RecordSettings {
  struct Setting {
    std::string key{};  ///< time, rate, skip, range, rows, decimal, resample; of columns, the name in the diagram
    PlacedText value{};
  };
  std::vector<Setting> settings{};
  std::vector<Setting> columns{};  ///< below [record.columns]: U = "MAIN.u"
};

/// A comment of the user, which is kept when the file is written anew.
struct Comment {
  enum class Where : std::uint8_t {
    Head,    ///< above all keys, and a blank line away from them
    Above,   ///< above a key or the head of a table
    Beside,  ///< behind it, on the same line
    End      ///< below all keys
  };
  Where where = Where::Above;
  std::string key{};   ///< in capitals, with its table: PARAMETERS.INV.C1
  std::string text{};  ///< of one or several lines, each with its #
};

struct ParameterFile {
  std::string file{};
  std::vector<ParameterValue> values{};   ///< in the order of the file
  std::vector<ParameterValue> initial{};  ///< of states, as SUM.SUM, in the order of the file
  std::vector<FitSetting> fits{};         ///< in the order of the file
  TuneSettings tune{};
  DiagnoseSettings diagnose{};
  RecordSettings record{};
  std::vector<Comment> comments{};  ///< in the order of the file

  /// The value of a path, without regard to case; null where the file has none.
  [[nodiscard]] const ParameterValue* find(std::string_view path) const;
  /// Gives a state its initial value, in place of one that the file has.
  void set_initial(const std::string& path, double value);
};

/// Throws InputError with every error found: HY100 where the file cannot be read, HY601 to HY606.
[[nodiscard]] ParameterFile read_parameter_file(const std::string& path);

/// The same from a text; `file` stands in the places of errors.
[[nodiscard]] ParameterFile parse_parameter_file(const std::string& file, std::string_view text);

/// What is written beside a value, as a comment.
struct Remark {
  std::string unit{};
  std::string meaning{};
  std::optional<double> standard_error{};
};

/// Remarks by key in capitals, with its table: PARAMETERS.INV.C1, INITIAL.SUM.SUM.
using Remarks = std::map<std::string, Remark>;

/// The file as TOML: the same bytes for the same contents, and the same bits when it is read back. `heading` becomes
/// a comment at the top, line by line. A comment of the user beside a key that has a remark moves above it, or goes
/// where it is an older remark of the same key. Throws std::invalid_argument where a value is not finite, or a path
/// names both a value and an instance: no file says that.
[[nodiscard]] std::string parameter_text(const ParameterFile& file, const Remarks& remarks = {},
                                         std::string_view heading = {});

}  // namespace hysteron::parameters
