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
//   [goal]                                # what `hysteron tune` tunes a control loop for
//   settling_time = 0.5
//   loop = "PID.XOUT"
//
//   [goal.limits]
//   phase_margin_deg = 50.0
//
//   [diagnose]
//   ignore = ["SP"]                       # columns of the records that drive nothing
//
// The reader knows the form of the file; whether INV and C1 exist, and of what type and range, the diagram knows.
// Hence every value carries its place. Why the file has this shape: docs/decisions/0002-parameter-files.md.
#pragma once

#include <array>
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
#include "support/numbers.hpp"

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

/// What a control loop is tuned for: [goal], with [goal.limits]. Times in seconds, all else in the units of the ports.
struct GoalSettings {
  enum class Signal : std::uint8_t { Step, Ramp, Record };
  enum class Robust : std::uint8_t { Worst, Mean };

  Place place{};                      ///< of [goal]; line 0: the file has none
  std::optional<PlacedText> input{};  ///< which input the test signal drives; default: the only one that has no default
  std::optional<PlacedText> output{};  ///< which output has to respond; default: the only one
  Signal signal = Signal::Step;
  std::optional<PlacedNumber> from{};           ///< where the signal stands before; default 0
  std::optional<PlacedNumber> size{};           ///< of the step, or of the ramp in a second; default 1
  std::optional<PlacedNumber> duration{};       ///< behind the step; default 3 settling times of the wish
  std::optional<PlacedNumber> rise_time{};      ///< of the wished response, 10 to 90 %
  std::optional<PlacedNumber> settling_time{};  ///< of the wished response, to 2 %
  std::optional<PlacedNumber> order{};          ///< of the wished response: 1 or 2, the default
  std::optional<PlacedNumber> damping{};        ///< of that of second order; default 1
  std::optional<PlacedNumber> dead_time{};      ///< of the wished response; default 0
  std::optional<PlacedText> wished{};           ///< the column of a record that is the wished response
  std::optional<PlacedText> loop{};             ///< the signal at which the loop is cut for its margins
  std::optional<PlacedText> effort{};           ///< the signal that counts as effort; default: that of the loop
  std::optional<PlacedNumber> effort_weight{};  ///< of the root mean square of its rate; default 0
  std::vector<PlacedText> plants{};             ///< parameter files, each one plant; default: this file alone
  Robust robust = Robust::Worst;

  // [goal.limits]
  std::optional<PlacedNumber> largest_effort{};
  std::optional<PlacedNumber> largest_rate{};       ///< of the effort, in a second
  std::optional<PlacedNumber> largest_overshoot{};  ///< percent of the step
  std::optional<PlacedNumber> gain_margin{};        ///< dB
  std::optional<PlacedNumber> phase_margin{};       ///< degrees
  std::optional<PlacedNumber> sensitivity{};        ///< largest |S|, Ms

  [[nodiscard]] bool is_given() const { return place.line > 0; }
  [[nodiscard]] bool limits_margins() const { return gain_margin || phase_margin || sensitivity; }
};

/// A key of [goal.limits], and what it sets.
struct GoalLimitKey {
  std::string_view name;
  std::optional<PlacedNumber> GoalSettings::*setting;
  std::optional<double> above{};  ///< a value has to lie above it; none: at 0 or above
  double below = infinity;
};
/// In the order in which they are written.
inline constexpr std::array<GoalLimitKey, 6> goal_limit_keys{
    {{"effort", &GoalSettings::largest_effort, 0.0},
     {"effort_rate", &GoalSettings::largest_rate, 0.0},
     {"overshoot_percent", &GoalSettings::largest_overshoot},
     {"gain_margin_db", &GoalSettings::gain_margin, 0.0},
     {"phase_margin_deg", &GoalSettings::phase_margin, 0.0, 180.0},
     {"sensitivity", &GoalSettings::sensitivity, 1.0}}};

struct DiagnoseSettings {
  std::vector<PlacedText> ignore{};  ///< columns of the records that the diagnosis does not look at
};

/// How records are read where no option says otherwise: keys and texts are those of the tool's options.
struct RecordSettings {
  struct Setting {
    std::string key{};  ///< time, … resample (hold, or Q=hold, again and again); of columns, the name in the diagram
    PlacedText value{};
  };
  std::vector<Setting> settings{};
  std::vector<Setting> columns{};  ///< below [record.columns]: U = "MAIN.u"
};

/// A comment of the user, which is kept when the file is written anew.
struct Comment {
  enum class Where : std::uint8_t {
    Head,           ///< above all keys, and a blank line away from them
    Above,          ///< above a key or the head of a table
    Beside,         ///< behind it, on the same line
    InList,         ///< on a line of its own in a list over several lines, behind `element` of its elements
    BesideElement,  ///< behind that element, on the same line; of 0, behind the bracket that opens the list
    End             ///< below all keys
  };
  Where where = Where::Above;
  std::uint32_t element = 0;  ///< counted from 1
  std::string key{};          ///< in capitals, with its table: PARAMETERS.INV.C1
  std::string text{};         ///< of one or several lines, each with its #
};

struct ParameterFile {
  std::string file{};
  std::vector<ParameterValue> values{};   ///< in the order of the file
  std::vector<ParameterValue> initial{};  ///< of states, as SUM.SUM, in the order of the file
  std::vector<FitSetting> fits{};         ///< in the order of the file
  TuneSettings tune{};
  GoalSettings goal{};
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
