// Records as commands take them: the options that say how a file is to be read, and what is said of what was read.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tuning/record_options.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library is so named
class App;
}

namespace hysteron::tool {

/// The options --time, --rate, --column, --skip, --range, --rows, --decimal and --resample.
void add_record_options(CLI::App& app, RecordOptions& options);

/// The same as they stand on a command line, each with a space before it; nothing where none is given.
[[nodiscard]] std::string record_arguments(const RecordOptions& options);

/// Prints what was understood of a record.
void say_what_was_read(const records::Record& record, const Program& program, bool tell_unused,
                       std::string_view used = {});

/// Reads measured records for a diagram, as read_measured_records does, and prints what was understood.
[[nodiscard]] std::vector<records::Record> read_and_told(const std::vector<std::string>& logs,
                                                         const RecordOptions& options, const Program& program,
                                                         bool tell_unused, Diagnostics& diagnostics,
                                                         std::string_view used = {});

}  // namespace hysteron::tool
