#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnosis/noise/noise_floor.hpp"
#include "diagnosis/noise/spectrum.hpp"
#include "records/read.hpp"
#include "records/statistics.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/rounded_text.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/picture_file.hpp"
#include "tool/record_figures.hpp"
#include "tool/record_options.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view record_examples = R"(Examples:
  hysteron record log.csv
  hysteron record scope.csv --time "x-axis[s]" --column U=1 --column Y=2 --picture scope.svg
  hysteron record drive.csv --resample hold --json

Says what was understood of a record, as run, tune and diagnose read it with the same options: its time, its columns
with units and ranges, how finely each resolves, how much it repeats and rests, and how much noise it has.
resolution: the smallest step between two values, before resampling. noise: that of fast differences, and after
resampling no less than what a sensor of this resolution rounds off; slow noise is not in it.
Exit codes: 0 read; 2 the file cannot be read as a record, or none of its columns holds numbers.
)";

struct RecordCommandOptions {
  std::string file;
  std::string picture;
  std::string parameters;
  RecordOptions record;
  bool json = false;
};

struct Row {
  const records::Column* column = nullptr;
  records::ColumnStatistics statistics{};
  double noise = 0.0;
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

std::string as_text(const records::Record& record, const std::vector<Row>& rows) {
  const double step = record.sample_time();
  std::string text = fmt::format("{}: {} rows every {} s ({} a second), from {} s to {} s\n", record.file(),
                                 record.size(), rounded_text(step), fmt::format("{:.6g}", 1.0 / step),
                                 number_text(record.time().front()), number_text(record.time().back()));
  text += fmt::format("times lie within {:.2g} s of the even grid\n", records::jitter_of(record));
  for (const std::string& note : record.notes()) {
    text += note + "\n";
  }
  std::size_t width = 6;
  for (const Row& row : rows) {
    width = std::max(width, row.column->name.size());
  }
  text += fmt::format("\n{:<{}}  {:<8} {:>12} {:>12} {:>11} {:>10} {:>8} {:>12}\n", "column", width, "unit", "from",
                      "to", "resolution", "noise", "repeats", "rests up to");
  for (const Row& row : rows) {
    const records::ColumnStatistics& found = row.statistics;
    text +=
        fmt::format("{:<{}}  {:<8} {:>12.6g} {:>12.6g} {:>11.3g} {:>10.2g} {:>7.1f}% {:>11.4g}s\n", row.column->name,
                    width, row.column->unit.empty() ? "-" : row.column->unit, found.low, found.high, found.resolution,
                    row.noise, 100.0 * found.repeats, static_cast<double>(found.longest_rest - 1) * step);
  }
  for (const records::Record::Unreadable& one : record.unreadable()) {
    text += fmt::format("{:<{}}  {}\n", one.name, width, first_sentence(one.fault));
  }
  return text;
}

std::string as_json(const records::Record& record, const std::vector<Row>& rows) {
  nlohmann::ordered_json json{{"file", record.file()},
                              {"rows", record.size()},
                              {"sample_time", record.sample_time()},
                              {"begin", record.time().front()},
                              {"end", record.time().back()},
                              {"jitter", records::jitter_of(record)},
                              {"notes", record.notes()},
                              {"columns", nlohmann::ordered_json::array()},
                              {"unreadable", nlohmann::ordered_json::array()}};
  for (const Row& row : rows) {
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
  return json.dump(2) + "\n";
}

int show(const RecordCommandOptions& options, Console& console) {
  if (!options.picture.empty()) {
    refuse_unfit_picture(options.picture, "--picture", {{.file = options.file, .named_by = "LOG"}});
  }
  const std::string bytes = read_text_file(options.file);
  console.sources().put(options.file, bytes);
  const RecordOptions reading = with_settings_of(options.parameters, options.record);
  const records::Record record = records::parse_record(options.file, bytes, read_options(reading));
  if (record.columns().empty()) {
    Diagnostics faults;
    for (const records::Record::Unreadable& one : record.unreadable()) {
      faults.add(one.fault);
    }
    if (faults.has_errors()) {
      throw InputError(faults);
    }
  }
  const std::vector<Row> rows = rows_of(record);
  if (!options.picture.empty()) {
    const std::vector<NamedRecord> drawn{{.name = options.file, .record = record}};
    const std::vector<plots::Figure> figures{figure_over_time(drawn)};
    write_file_atomically(options.picture, picture_bytes(options.picture, options.file, figures));
  }
  console.print(options.json ? as_json(record, rows) : as_text(record, rows));
  return exit_ok;
}

}  // namespace

Action add_record(CLI::App& app) {
  const auto options = std::make_shared<RecordCommandOptions>();
  app.add_option("LOG", options->file, "The record.")->required()->option_text("LOG");
  add_record_options(app, options->record);
  app.add_option("--params", options->parameters, "Takes [record] of a parameter file, where no option says otherwise.")
      ->option_text("P.toml");
  app.add_option("--picture", options->picture, "Draws the columns over the time: .svg, .png, .html.")
      ->option_text("FILE");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(record_examples));
  return [options](Console& console) { return show(*options, console); };
}

}  // namespace hysteron::tool
