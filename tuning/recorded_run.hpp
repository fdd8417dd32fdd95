// A run of a diagram over a record: what `hysteron run` and the API compute, from columns to signals.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "records/record.hpp"
#include "support/diagnostic.hpp"
#include "tuning/simulation.hpp"

namespace hysteron {

struct RunRequest {
  /// Signals inside, watched besides the outputs: variables, INSTANCE.PIN, PLANT.INSTANCE.PIN. The names of variables
  /// are known only to a program that was compiled with keep_names.
  std::vector<std::string> traces{};
  bool float32 = false;
  std::function<void(double)> progress{};
};

/// The outputs, then the traces.
struct RecordedRun {
  Program program{};  ///< with the record's sample time, where the diagram states none
  Drive drive{};
  std::vector<std::string> names{};
  std::vector<std::string> units{};  ///< of the outputs; empty of traces
  std::vector<Signal> values{};
};

/// Runs a program from its reset over a record, whose columns are brought to the units of the ports. Throws InputError
/// with everything found where they do not fit: HY502, HY704, HY707, HY708, HY729. Adds warnings, and HY706 as
/// an error where an output is no finite number: the values are given all the same.
[[nodiscard]] RecordedRun run_over(Program program, records::Record& record, const RunRequest& request,
                                   Diagnostics& diagnostics);

/// What a record drives a program by: its columns brought to the units of the ports, its sample time held against that
/// of the diagram. Reports what does not fit.
[[nodiscard]] Drive drive_of(Program& program, records::Record& record, Diagnostics& diagnostics);

/// Reports HY706 for each column that holds an infinity or not-a-number: the first step where it does, and how many.
/// \p places are those of the columns in the diagram; none where it is known from elsewhere.
void check_finite(const std::vector<Place>& places, std::span<const double> time, const std::vector<std::string>& names,
                  const std::vector<Signal>& columns, Diagnostics& diagnostics);

}  // namespace hysteron
