#include "tool/record_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "support/shell_words.hpp"
#include "tool/console.hpp"

namespace hysteron::tool {

void add_record_options(CLI::App& app, RecordOptions& options) {
  app.add_option("--time", options.time, "The column of the time, where it is not found by itself, and its unit.")
      ->option_text("NAME[ms]");
  app.add_option("--rate", options.rate, "Rows per second of a record without times, or the time between two.")
      ->option_text("1kHz");
  app.add_option(
         "--column", options.columns,
         "The column that holds a signal of the diagram, by name or by number from 1 on, and its unit where the "
         "file states another; may be repeated.")
      ->option_text("U=NAME[mV]")
      ->allow_extra_args(false);
  app.add_option("--skip", options.skip, "Leaves out that many lines at the top of the file.")->option_text("N");
  app.add_option("--range", options.range, "Reads the rows of these times alone.")->option_text("2s..8s");
  app.add_option("--rows", options.rows, "Reads these rows of numbers alone, from 1 on.")->option_text("1..600");
  app.add_option("--decimal", options.decimal, "The decimal mark, where it could be read in two ways.")
      ->option_text("point|comma");
  app.add_option("--resample", options.resample,
                 "Brings uneven times, or another rate, to the diagram's sample time: linear for slow analog signals, "
                 "hold for encoders and commands, average for noisy signals at a higher rate. U=hold says it of one "
                 "signal; may be repeated.")
      ->option_text("linear|hold|average|U=hold")
      ->allow_extra_args(false);
}

std::string record_arguments(const RecordOptions& options) {
  std::string text;
  for (const auto& [key, value] : texts_of(options)) {
    text += value->empty() ? "" : fmt::format(" --{} {}", key, shell_word(*value));
  }
  for (const std::string& column : options.columns) {
    text += " --column " + shell_word(column);
  }
  for (const std::string& way : options.resample) {
    text += " --resample " + shell_word(way);
  }
  return text;
}

void say_what_was_read(const records::Record& record, const Program& program, bool tell_unused, std::string_view used) {
  for (const std::string& note : what_was_read(record, program, tell_unused, used)) {
    Console::note(record.file(), note);
  }
}

std::vector<records::Record> read_and_told(const std::vector<std::string>& logs, const RecordOptions& options,
                                           const Program& program, bool tell_unused, Diagnostics& diagnostics,
                                           std::string_view used) {
  std::vector<records::Record> records = read_measured_records(logs, options, program, diagnostics);
  for (const records::Record& record : records) {
    say_what_was_read(record, program, tell_unused, used);
  }
  return records;
}

}  // namespace hysteron::tool
