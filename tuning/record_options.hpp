// How a record is to be read for a diagram, as a user writes it: on a command line, in a parameter file, in a call.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "records/read_options.hpp"
#include "records/record.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// As they are written.
struct RecordOptions {
  std::string time{};                          ///< NAME or NAME[ms]
  std::string rate{};                          ///< 1kHz, 1 ms
  std::vector<std::string> columns{};          ///< U=MAIN.u
  std::vector<std::string> general_columns{};  ///< the same, from a parameter file: for records that have them
  std::string skip{};
  std::string range{};  ///< 2s..8s
  std::string rows{};   ///< 1..60
  std::string decimal{};
  std::vector<std::string> resample{};          ///< hold, Q=hold
  std::vector<std::string> general_resample{};  ///< the same, from a parameter file
  std::map<std::string, Place> places{};  ///< of what a parameter file says: `rate`, `column U=MAIN.u`, `resample hold`
};

/// Those that are one text, by their names on a command line.
template <class Options>
auto texts_of(Options& options) {
  return std::array{
      std::pair(std::string_view("time"), &options.time), std::pair(std::string_view("rate"), &options.rate),
      std::pair(std::string_view("skip"), &options.skip), std::pair(std::string_view("range"), &options.range),
      std::pair(std::string_view("rows"), &options.rows), std::pair(std::string_view("decimal"), &options.decimal)};
}

/// The same, with what [record] of a parameter file says where no option does.
[[nodiscard]] RecordOptions with_settings(RecordOptions options, const parameters::RecordSettings& settings);

/// The same from a parameter file, where one is named.
[[nodiscard]] RecordOptions with_settings_of(const std::string& parameter_file, const RecordOptions& options);

/// What they say. Throws InputError HY730 for one that says nothing. With a diagram, a record is resampled to its
/// sample time, its BOOL, INT, DINT and WORD are held, and a port T is told from the time.
[[nodiscard]] records::ReadOptions read_options(const RecordOptions& options, const Program* program = nullptr);

/// The same for a record of which the inputs alone are taken: a T among the outputs leaves a t no second reading.
[[nodiscard]] records::ReadOptions drive_options(const RecordOptions& options, const Program& program);

/// What was understood of a record, a sentence each without capital and point: notes of the reader, inputs that have no
/// column and keep their defaults, and, with `tell_unused`, the columns that the diagram has no port for, but one that
/// is used all the same.
[[nodiscard]] std::vector<std::string> what_was_read(const records::Record& record, const Program& program,
                                                     bool tell_unused, std::string_view used = {});

/// Reads measured records for a diagram, in its units. Throws InputError HY730 where two are the same file, under
/// whatever names: a repeated record would count as a second measurement, and shrink the standard errors of what is
/// fitted; else as records::read_record does.
[[nodiscard]] std::vector<records::Record> read_measured_records(const std::vector<std::string>& logs,
                                                                 const RecordOptions& options, const Program& program,
                                                                 Diagnostics& diagnostics);

}  // namespace hysteron
