#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnosis/noise/noise_floor.hpp"
#include "diagnosis/noise/spectrum.hpp"
#include "records/read.hpp"
#include "records/statistics.hpp"
#include "records/table.hpp"
#include "records/uneven_record.hpp"
#include "support/atomic_file.hpp"
#include "support/counted.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/rounded_text.hpp"
#include "support/text_file.hpp"
#include "support/wrapped.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/picture_file.hpp"
#include "tool/record_figures.hpp"
#include "tool/record_options.hpp"
#include "tool/tune_words.hpp"
#include "tuning/excitation.hpp"
#include "tuning/record_units.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view record_examples = R"(Examples:
  hysteron record log.csv
  hysteron record scope.csv --time "x-axis[s]" --column U=1 --column Y=2 --picture scope.svg
  hysteron record drive.csv --resample hold --json
  hysteron record log.csv --for plant.st --params p.toml

Says what was understood of a record, as run, tune and diagnose read it with the same options: its time, its columns
with units and ranges, how finely each resolves, how much it repeats and rests, and how much noise it has.
resolution: the smallest step between two values, before resampling. noise: that of fast differences, and after
resampling no less than what a sensor of this resolution rounds off; slow noise is not in it.
--for holds it against a diagram: which inputs and outputs have a column, and whether the record excites what [fit] of
the parameter file names. The standard errors are those that the noise alone would leave, were the diagram right.
Uneven times are shown, too, with all gaps, before they are refused.
Exit codes: 0 read; 2 the file cannot be read as a record, or none of its columns holds numbers.
)";

struct Row {
  const records::Column* column = nullptr;
  records::ColumnStatistics statistics{};
  double noise = 0.0;
};

struct RecordCommandOptions {
  std::string file;
  std::string picture;
  DiagramOptions diagram;  ///< that it is for; none where it has no file
  RecordOptions record;
  bool json = false;
};

/// What was understood of a file, and what stands against its use.
struct Shown {
  records::Record record;
  std::vector<Row> rows{};
  records::TimeSurvey times{};
  std::optional<Excitation> excitation{};
};

/// Resampling hides the step of a sensor: what lies between two readings is made up, and no finer than they are.
Row row_of(const records::Column& column) {
  Row row{.column = &column,
          .statistics = records::statistics_of(column.values),
          .noise = diagnosis::noise_by_differences(column.values)};
  if (column.step > 0.0) {
    row.statistics.resolution = column.step;
    const double rounding = diagnosis::rounded_off(column.step);
    const bool is_small = rounding < diagnosis::most_rounding * (row.statistics.high - row.statistics.low);
    row.noise = is_small ? std::max(row.noise, rounding) : row.noise;  // of a switch the step is no noise
  }
  return row;
}

std::vector<Row> rows_of(const records::Record& record) {
  std::vector<Row> rows;
  for (const records::Column& column : record.columns()) {
    rows.push_back(row_of(column));
  }
  return rows;
}

std::string first_sentence(const Diagnostic& fault) {
  return fmt::format("HY{}: {}", fault.number, fault.cause);
}

/// One line where the times are even; else what is uneven in them.
std::string times_text(const Shown& shown) {
  const records::TimeSurvey& times = shown.times;
  if (times.is_even()) {
    return fmt::format("times lie within {:.2g} s of the even grid\n", records::jitter_of(shown.record));
  }
  std::string text = fmt::format("times are uneven: most rows are {} s apart, with a jitter of {:.2g} s RMS\n",
                                 rounded_text(times.usual), times.jitter);
  if (times.gaps > 0) {
    text += fmt::format("{}, in which {} missing; the first is behind row {}, the longest lasts {} s\n",
                        counted(times.gaps, "gap"),
                        times.missing == 1 ? "one row is" : fmt::format("some {} rows are", times.missing),
                        times.first_gap, rounded_text(times.longest_gap));
  }
  if (times.close > 0) {
    text += fmt::format("{} less than half of that behind the row before\n",
                        times.close == 1 ? "one row is" : fmt::format("{} rows are", times.close));
  }
  if (times.backward > 0) {
    text += fmt::format("at {} the time repeats itself or runs back, first at row {}\n", counted(times.backward, "row"),
                        times.first_backward);
  }
  return text;
}

std::string_view word_of(Excited excited) {
  return excited == Excited::Well ? "well" : excited == Excited::Weakly ? "weakly" : "no";
}

std::string excitation_text(const Excitation& excitation) {
  std::size_t width = 9;
  for (const Excitation::OfParameter& one : excitation.parameters) {
    width = std::max(width, one.name.size());
  }
  std::string text = fmt::format("\n{:<{}}  {:<14}  {:<24}  excited\n", "parameter", width, "value", "standard error");
  for (const Excitation::OfParameter& one : excitation.parameters) {
    const std::string error = !std::isfinite(one.standard_error) ? std::string("not determined")
                              : one.value == 0.0                 ? fmt::format("{:.2g}", one.standard_error)
                                                                 : fmt::format("{:.2g} ({:.2g} %)", one.standard_error,
                                                                               100.0 * one.standard_error / std::abs(one.value));
    text += fmt::format("{:<{}}  {:<14}  {:<24}  {}\n", one.name, width,
                        fmt::format("{:.6g}{}", one.value, unit_behind(one.unit)), error, word_of(one.excited));
  }
  for (const std::string& note : excitation.notes) {
    text += note + "\n";
  }
  return text;
}

std::size_t widest_name(const std::vector<Row>& rows) {
  std::size_t width = std::string_view("column").size();
  for (const Row& row : rows) {
    width = std::max(width, row.column->name.size());
  }
  return width;
}

/// Of the columns of the table behind the names.
constexpr std::size_t width_of_figures = 81;

std::string columns_as_table(const std::vector<Row>& rows, std::size_t width, double step) {
  std::string text = fmt::format("\n{:<{}}  {:<8} {:>12} {:>12} {:>11} {:>10} {:>8} {:>12}\n", "column", width, "unit",
                                 "from", "to", "resolution", "noise", "repeats", "rests up to");
  for (const Row& row : rows) {
    const records::ColumnStatistics& found = row.statistics;
    text +=
        fmt::format("{:<{}}  {:<8} {:>12.6g} {:>12.6g} {:>11.3g} {:>10.2g} {:>7.1f}% {:>11.4g}s\n", row.column->name,
                    width, row.column->unit.empty() ? "-" : row.column->unit, found.low, found.high, found.resolution,
                    row.noise, 100.0 * found.repeats, static_cast<double>(found.longest_rest - 1) * step);
  }
  return text;
}

/// The same for a terminal in which the table has no room.
std::string columns_in_words(const std::vector<Row>& rows, double step) {
  std::string text;
  for (const Row& row : rows) {
    const records::ColumnStatistics& found = row.statistics;
    text += fmt::format(
        "\n{}{}\n  from {:.6g} to {:.6g}, resolution {:.3g}, noise {:.2g}, repeats {:.1f} %, rests up to {:.4g} s\n",
        row.column->name, unit_behind(row.column->unit), found.low, found.high, found.resolution, row.noise,
        100.0 * found.repeats, static_cast<double>(found.longest_rest - 1) * step);
  }
  return text;
}

std::string as_text(const Shown& shown) {
  const records::Record& record = shown.record;
  const double step = record.sample_time();
  std::string text = fmt::format("{}: {} rows every {} s ({} a second), from {} s to {} s\n", record.file(),
                                 record.size(), rounded_text(step), fmt::format("{:.6g}", 1.0 / step),
                                 number_text(record.time().front()), number_text(record.time().back()));
  text += times_text(shown);
  for (const std::string& note : record.notes()) {
    text += note + "\n";
  }
  const std::size_t width = widest_name(shown.rows);
  const std::size_t terminal = terminal_width(stdout);
  text += terminal != 0 && terminal < width + width_of_figures ? columns_in_words(shown.rows, step)
                                                               : columns_as_table(shown.rows, width, step);
  for (const records::Record::Unreadable& one : record.unreadable()) {
    text += fmt::format("{:<{}}  {}\n", one.name, width, first_sentence(one.fault));
    if (one.fault.mend != records::another_column) {
      text += fmt::format("{:<{}}  mend: {}\n", "", width, one.fault.mend);
    }
  }
  return text + (shown.excitation ? excitation_text(*shown.excitation) : std::string());
}

std::string as_json(const Shown& shown) {
  const records::Record& record = shown.record;
  nlohmann::ordered_json json{{"file", record.file()},
                              {"rows", record.size()},
                              {"sample_time", record.sample_time()},
                              {"begin", record.time().front()},
                              {"end", record.time().back()},
                              {"jitter", shown.times.is_even() ? records::jitter_of(record) : shown.times.jitter},
                              {"gaps", shown.times.gaps},
                              {"missing_rows", shown.times.missing},
                              {"backward_rows", shown.times.backward},
                              {"notes", record.notes()},
                              {"columns", nlohmann::ordered_json::array()},
                              {"unreadable", nlohmann::ordered_json::array()}};
  for (const Row& row : shown.rows) {
    json["columns"].push_back({{"name", row.column->name},
                               {"unit", row.column->unit},
                               {"low", row.statistics.low},
                               {"high", row.statistics.high},
                               {"resolution", row.statistics.resolution},
                               {"noise", row.noise},
                               {"repeats", row.statistics.repeats},
                               {"rest", static_cast<double>(row.statistics.longest_rest - 1) * record.sample_time()}});
  }
  for (const records::Record::Unreadable& one : record.unreadable()) {
    json["unreadable"].push_back({{"name", one.name}, {"cause", one.fault.cause}, {"mend", one.fault.mend}});
  }
  if (shown.excitation) {
    json["excitation"] = nlohmann::ordered_json::array();
    for (const Excitation::OfParameter& one : shown.excitation->parameters) {
      json["excitation"].push_back({{"name", one.name},
                                    {"unit", one.unit},
                                    {"value", one.value},
                                    {"standard_error", one.standard_error},  // null where it is not determined
                                    {"excited", word_of(one.excited)}});
    }
    json["excitation_notes"] = shown.excitation->notes;
  }
  return json.dump(2) + "\n";
}

/// A record of uneven times is shown before it is refused; `faults` has what refuses it.
records::Record read_to_be_shown(const RecordCommandOptions& options, const std::string& bytes,
                                 const records::ReadOptions& reading, Diagnostics& faults) {
  try {
    return records::parse_record(options.file, bytes, reading);
  } catch (const InputError& refused) {
    const auto is_of_times = [](const Diagnostic& one) {
      return one.number == error::uneven_time || one.number == error::reversed_time;
    };
    if (!std::ranges::all_of(refused.diagnostics().all(), is_of_times)) {
      throw;
    }
    records::Record record = records::parse_uneven_record(options.file, bytes, reading);
    if (!(record.sample_time() > 0.0)) {
      throw;
    }
    faults = refused.diagnostics();
    return record;
  }
}

/// Holds a record against the diagram that it is for.
Excitation excitation_by(records::Record& record, const Program& program, const parameters::ParameterFile& file) {
  const OutputErrorProblem problem = output_error_problem(program, file, std::span(&record, 1));
  std::vector<double> noise;
  for (std::size_t output = 0; output < problem.outputs.size(); ++output) {
    noise.push_back(diagnosis::noise_floor(problem.experiments, output).value);
  }
  return excitation_of(problem, noise);
}

int show(const RecordCommandOptions& options, Console& console) {
  if (!options.picture.empty()) {
    refuse_unfit_picture(options.picture, "--picture", {{.file = options.file, .named_by = "LOG"}});
  }
  Diagnostics warnings;
  std::optional<Program> program;
  if (!options.diagram.file.empty()) {
    if (options.diagram.parameters.empty()) {
      throw InputError(error::bad_usage, {},
                       "--for asks whether the record excites what is to be fitted, and no file says what that is.",
                       fmt::format("name the parameter file with tables [fit], as --params {}.",
                                   std::filesystem::path(options.diagram.file).stem().string() + ".toml"));
    }
    program = compile_file(options.diagram.file, {.top = options.diagram.top}, warnings);
  }
  const std::string bytes = read_text_file(options.file);
  console.sources().put(options.file, bytes);
  const RecordOptions reading = with_settings_of(options.diagram.parameters, options.record);
  Diagnostics faults;
  Shown shown{.record = read_to_be_shown(options, bytes, read_options(reading, program ? &*program : nullptr), faults)};
  if (shown.record.columns().empty()) {
    for (const records::Record::Unreadable& one : shown.record.unreadable()) {
      faults.add(one.fault);
    }
    if (faults.has_errors()) {
      throw InputError(faults);
    }
  }
  shown.rows = rows_of(shown.record);
  shown.times = records::survey_of(shown.record.time());
  if (!options.picture.empty()) {
    const std::vector<NamedRecord> drawn{{.name = options.file, .record = shown.record}};
    const std::vector<plots::Figure> figures{figure_over_time(drawn)};
    write_file_atomically(options.picture, picture_bytes(options.picture, options.file, figures));
  }
  records::Record converted = shown.record;
  if (program) {
    try {
      convert_units(converted, *program, faults);
      say_what_was_read(converted, *program, true);
      if (!faults.has_errors()) {
        shown.excitation =
            excitation_by(converted, *program, parameters::read_parameter_file(options.diagram.parameters));
      }
    } catch (const InputError& refused) {
      faults.add_all(refused.diagnostics());
    }
  }
  console.print(options.json ? as_json(shown) : as_text(shown));
  console.report(warnings);
  if (faults.has_errors()) {
    throw InputError(faults);
  }
  console.report(faults);
  return exit_ok;
}

}  // namespace

Action add_record(CLI::App& app) {
  const auto options = std::make_shared<RecordCommandOptions>();
  app.add_option("LOG", options->file, "The record.")->required()->option_text("LOG");
  add_record_options(app, options->record);
  app.add_option("--for", options->diagram.file,
                 "The diagram that the record is for: whether it excites what is to be fitted.")
      ->option_text("FILE.st");
  app.add_option("--top", options->diagram.top, "The block to take, where the file has several that no other contains.")
      ->option_text("NAME");
  app.add_option("--params", options->diagram.parameters,
                 "Takes [record] of a parameter file, where no option says otherwise; with --for also [fit].")
      ->option_text("P.toml");
  app.add_option("--picture", options->picture, "Draws the columns over the time: .svg, .png, .html.")
      ->option_text("FILE");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(record_examples));
  return [options](Console& console) { return show(*options, console); };
}

}  // namespace hysteron::tool
