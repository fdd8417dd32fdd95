// The columns of a table at an even sample time, each by the way that is stated for it, and what that did to them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "records/read_options.hpp"
#include "records/resample.hpp"
#include "records/table.hpp"
#include "records/time/time_column.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::records {

class ResampledColumns {
 public:
  /// All three outlive it. A way for a column that the table has not is noted there where a parameter file says it.
  /// Throws InputError: HY502 where an option says it, HY514 where a column is given two ways, HY730 where something
  /// would be made up between two values of a switch; HY514 or HY501 where rows would be made up, or none is left.
  ResampledColumns(Table& table, const Times& times, const ReadOptions& options);

  /// s: the new times, and the step between them.
  [[nodiscard]] const std::vector<double>& seconds() const { return seconds_; }
  [[nodiscard]] double sample_time() const { return sample_time_; }

  /// Whether a missing number of this column is bridged, as its way says.
  [[nodiscard]] bool bridges(std::size_t index) const;

  struct Brought {
    std::vector<double> values{};
    double step = 0.0;                  ///< the smallest one between two values before; 0: there is none to be told
    std::optional<Diagnostic> fault{};  ///< its times are others, and no way is stated
  };
  /// A signal at the new times. What it cost is kept.
  [[nodiscard]] Brought bring(std::size_t index);

  /// What was done, a sentence each, of the columns that were brought.
  [[nodiscard]] std::vector<std::string> said() const;

 private:
  struct Way {
    Resampling way = Resampling::None;
    bool steps = false;  ///< held, whatever is said of the others
  };
  struct Group {
    Way way{};
    ResamplingCost cost{};
    std::vector<std::string> names{};
  };

  void state_ways();
  void find_grid();
  void keep(const std::string& name, const Way& way, const ResamplingCost& cost);

  Table& table_;
  const Times& times_;
  const ReadOptions& options_;
  std::vector<Way> ways_{};  ///< of each column
  std::vector<double> seconds_{};
  double sample_time_ = 0.0;
  std::vector<Group> groups_{};  ///< of columns to which the same was done
};

}  // namespace hysteron::records
