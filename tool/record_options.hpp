// Records as commands take them: the options that say how a file is to be read, and what of it the diagram uses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "records/read_options.hpp"
#include "records/record.hpp"
#include "tool/console.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library is so named
class App;
}

namespace hysteron::tool {

/// As they are written.
struct RecordOptions {
  std::string time{};                  ///< NAME or NAME[ms]
  std::string rate{};                  ///< 1kHz, 1 ms
  std::vector<std::string> columns{};  ///< U=MAIN.u
  std::string skip{};
  std::string range{};  ///< 2s..8s
  std::string rows{};   ///< 1..60
  std::string decimal{};
  std::string resample{};
};

/// The options --time, --rate, --column, --skip, --range, --rows, --decimal and --resample.
void add_record_options(CLI::App& app, RecordOptions& options);

/// The same, with what [record] of a parameter file says where no option does.
[[nodiscard]] RecordOptions with_settings(RecordOptions options, const parameters::RecordSettings& settings);

/// The same from a parameter file, where one is named.
[[nodiscard]] RecordOptions with_settings_of(const std::string& parameter_file, const RecordOptions& options);

/// The same as they stand on a command line, each with a space before it; nothing where none is given.
[[nodiscard]] std::string record_arguments(const RecordOptions& options);

/// A word of a command line, in quotes where the shell would take it apart.
[[nodiscard]] std::string quoted(const std::string& word);

/// What they say. Throws InputError HY730 for one that says nothing. With a diagram, a record is resampled to its
/// sample time.
[[nodiscard]] records::ReadOptions read_options(const RecordOptions& options, const Program* program = nullptr);

/// Says what was understood of a record: notes of the reader, inputs that have no column and keep their defaults, and,
/// with `tell_unused`, the columns that the diagram has no port for.
void say_what_was_read(const records::Record& record, const Program& program, bool tell_unused);

/// Reads measured records for a diagram, in its units, and says what was read. Throws InputError HY730 where two are
/// the same file, under whatever names: a repeated record would count as a second measurement, and shrink the standard
/// errors of what is fitted; else as records::read_record does.
[[nodiscard]] std::vector<records::Record> read_measured_records(const std::vector<std::string>& logs,
                                                                 const RecordOptions& options, const Program& program,
                                                                 bool tell_unused, Diagnostics& diagnostics);

}  // namespace hysteron::tool
