// hysteron history: what a task has kept for days, listed or written as a record.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "database/sqlite.hpp"
#include "records/csv.hpp"
#include "runtime/config/run_config.hpp"
#include "runtime/history/history_reader.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/overwriting.hpp"
#include "support/rounded_text.hpp"
#include "support/time_heading.hpp"
#include "tool/commands.hpp"
#include "tool/history_time.hpp"
#include "tool/option_values.hpp"

namespace hysteron::tool {
namespace {

using runtime::HistoryReader;
using runtime::HistorySpan;
using runtime::RecordedPoint;
using runtime::RecordedRun;
using runtime::Stretch;
using runtime::StretchList;
using runtime::utc_text;

constexpr std::string_view history_examples = R"(Examples:
  hysteron history history.sqlite
  hysteron history history.sqlite --json
  hysteron history history.sqlite --out log.csv
  hysteron history history.sqlite --from 2h --points U,Y --out log.csv
  hysteron history history.sqlite --from 2026-11-28T06:00 --to 2026-11-28T07:30 --run 3 --out log.csv

Without --out it lists the runs of a task in the history, and the stretches of each without a gap. With it, the longest
stretch of what is asked for becomes a record that tune and diagnose read: its time counts periods of the task, so that
a wall clock that was set does not matter. It can be called while the task runs, and never holds it up.
Times are UTC; 90s, 30min, 2h or 3d count back from the newest row.
Exit codes: 0 done; 2 the history cannot be read, or has nothing of that.
)";

constexpr std::size_t most_listed = 12;  ///< stretches of a run

struct HistoryOptions {
  std::string file;
  std::string from;
  std::string to;
  std::vector<std::string> points;
  std::int64_t run = 0;
  bool gaps = false;
  bool json = false;
  std::string output;
};

InputError nothing(const HistoryOptions& options, const std::string& cause, const std::string& mend) {
  return {error::nothing_in_history, Place{.file = options.file}, cause, mend};
}

std::string span_text(std::int64_t first_ms, std::int64_t last_ms) {
  return utc_text(first_ms) + " to " + utc_text(last_ms);
}

std::string point_text(const RecordedPoint& point) {
  return point.name + (point.unit.empty() || point.unit == "1" ? "" : " [" + point.unit + "]");
}

std::string clock_text(const StretchList& found) {
  std::string text;
  for (const runtime::ClockStep& step : found.clock_steps) {
    text += fmt::format("the wall clock was set {} by {:.1f} s before {}; rows keep their order\n",
                        step.seconds > 0.0 ? "forward" : "back", std::abs(step.seconds), utc_text(step.at_ms));
  }
  return text;
}

std::string listed(const std::vector<RecordedRun>& runs, const StretchList& found) {
  std::string text;
  for (const RecordedRun& run : runs) {
    std::vector<Stretch> own;
    std::ranges::copy_if(found.stretches, std::back_inserter(own),
                         [&](const Stretch& one) { return one.run == run.run; });
    if (own.empty()) {
      continue;
    }
    text += fmt::format("run {}: {}, a row every {} s; ", run.run, run.title, rounded_text(run.sample_time()));
    for (const RecordedPoint& point : run.points) {
      text += (&point == run.points.data() ? "" : ", ") + point_text(point);
    }
    text += '\n';
    for (std::size_t i = 0; i < own.size() && i < most_listed; ++i) {
      text += fmt::format("  {}, {} rows without a gap\n", span_text(own[i].first_ms, own[i].last_ms), own[i].rows);
    }
    text += own.size() > most_listed ? fmt::format("  and {} more stretches\n", own.size() - most_listed) : "";
  }
  return text + clock_text(found);
}

/// What `listed` says, all stretches of it, in the order in which they were written.
std::string as_json(const std::string& file, const std::vector<RecordedRun>& runs, const StretchList& found) {
  using nlohmann::ordered_json;
  ordered_json json{{"file", file}, {"runs", ordered_json::array()}, {"clock_steps", ordered_json::array()}};
  for (const RecordedRun& run : runs) {
    ordered_json stretches = ordered_json::array();
    for (const Stretch& one : found.stretches) {
      if (one.run == run.run) {
        stretches.push_back(
            {{"from", utc_text(one.first_ms)}, {"to", utc_text(one.last_ms)}, {"rows", one.rows}, {"late", one.late}});
      }
    }
    if (stretches.empty()) {
      continue;
    }
    ordered_json points = ordered_json::array();
    for (const RecordedPoint& point : run.points) {
      points.push_back(
          {{"name", point.name}, {"unit", point.unit == "1" ? "" : point.unit}, {"meaning", point.meaning}});
    }
    json["runs"].push_back({{"run", run.run},
                            {"title", run.title},
                            {"begun", utc_text(run.begun_ms)},
                            {"period", static_cast<double>(run.period) / 1e9},
                            {"sample_time", run.sample_time()},
                            {"points", std::move(points)},
                            {"stretches", std::move(stretches)}});
  }
  for (const runtime::ClockStep& step : found.clock_steps) {
    json["clock_steps"].push_back({{"before", utc_text(step.at_ms)}, {"seconds", step.seconds}});
  }
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::vector<RecordedPoint> points_of(const RecordedRun& run, const HistoryOptions& options) {
  if (options.points.empty()) {
    return run.points;
  }
  std::vector<RecordedPoint> points;
  for (const std::string& name : options.points) {
    const auto found =
        std::ranges::find_if(run.points, [&](const RecordedPoint& one) { return equal_ignoring_case(one.name, name); });
    if (found == run.points.end()) {
      std::string there;
      for (const RecordedPoint& point : run.points) {
        there += (there.empty() ? "" : ", ") + point.name;
      }
      throw nothing(options, fmt::format("Run {} has no point {}.", run.run, name),
                    fmt::format("it has: {}. Name some of these, or another run: --run N.", there));
    }
    points.push_back(*found);
  }
  return points;
}

/// The rows of one stretch after the other; their times count periods from the first row on.
records::Record record_of(HistoryReader& reader, const RecordedRun& run, const std::vector<Stretch>& stretches,
                          const std::vector<RecordedPoint>& points) {
  std::vector<double> time;
  std::vector<records::Column> columns;
  for (const RecordedPoint& point : points) {
    columns.push_back({.name = point.name, .unit = point.unit == "1" ? "" : point.unit});
  }
  for (const Stretch& stretch : stretches) {
    const auto values = reader.values(stretch, points);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      columns[i].values.insert(columns[i].values.end(), values[i].begin(), values[i].end());
    }
    for (std::int64_t row = 0; row < stretch.rows; ++row) {
      const std::int64_t slot = stretch.first_slot - stretches.front().first_slot + row;
      time.push_back(static_cast<double>(slot * run.step * run.period) / 1e9);
    }
  }
  records::Record record(std::move(time), run.sample_time(), std::move(columns), Place{});
  record.set_beside_t(std::ranges::any_of(run.points, is_called_t, &RecordedPoint::name));
  return record;
}

std::string left_out(const std::vector<Stretch>& all, const Stretch& taken) {
  std::string text;
  std::size_t count = 0;
  for (const Stretch& one : all) {
    if (one.first == taken.first) {
      continue;
    }
    ++count;
    text += count <= most_listed ? fmt::format("  left out: run {}, {}, {} rows\n", one.run,
                                               span_text(one.first_ms, one.last_ms), one.rows)
                                 : "";
  }
  return count == 0 ? ""
                    : fmt::format("there are gaps: the longest of {} stretches was taken\n{}{}", count + 1, text,
                                  count > most_listed ? fmt::format("  and {} more\n", count - most_listed) : "");
}

int export_record(HistoryReader& reader, const std::vector<RecordedRun>& runs, const StretchList& found,
                  const HistoryOptions& options, Console& console) {
  const Stretch& longest = *std::ranges::max_element(found.stretches, {}, &Stretch::rows);
  const RecordedRun& run = *std::ranges::find(runs, longest.run, &RecordedRun::run);
  std::vector<Stretch> taken{longest};
  if (options.gaps) {
    taken.clear();
    std::ranges::copy_if(found.stretches, std::back_inserter(taken),
                         [&](const Stretch& one) { return one.run == run.run; });
  }
  const auto points = points_of(run, options);
  const records::Record record = record_of(reader, run, taken, points);
  records::write_csv(options.output, record);
  std::int64_t late = 0;
  for (const Stretch& one : taken) {
    late += one.late;
  }
  std::string text =
      fmt::format("{}: run {}, {} rows every {} s, {}\n", options.output, run.run, record.size(),
                  rounded_text(run.sample_time()), span_text(taken.front().first_ms, taken.back().last_ms));
  text += options.gaps && taken.size() == 1 ? "there is no gap\n"
          : options.gaps ? fmt::format("{} stretches with gaps between them: read it with --resample\n", taken.size())
                         : left_out(found.stretches, longest);
  for (const records::Column& column : record.columns()) {
    const auto lost = std::ranges::count_if(column.values, [](double value) { return std::isnan(value); });
    text += lost == 0 ? "" : fmt::format("{} is not a number in {} rows\n", column.name, lost);
  }
  text += late == 0 ? "" : fmt::format("{} rows were taken late, since cycles were skipped\n", late);
  console.print(text + clock_text(found));
  return exit_ok;
}

int history(const HistoryOptions& options, Console& console) {
  refuse_to_overwrite({.file = options.output}, {{.file = options.file}, {.file = options.file + "-wal"}});
  try {
    HistoryReader reader(options.file);
    reader.hold_still();
    const auto runs = reader.runs();
    const auto newest = reader.newest_ms();
    if (!newest) {
      throw nothing(options, "There is no row in this history yet.", "wait until the task has run for a second.");
    }
    HistorySpan span;
    span.from_ms = history_time(options.from, "--from", *newest);
    span.to_ms = history_time(options.to, "--to", *newest);
    span.run = options.run == 0 ? std::nullopt : std::optional(options.run);
    const StretchList found = reader.stretches(span);
    if (found.stretches.empty()) {
      throw nothing(options, "No row of this history is in that time and run.",
                    fmt::format("call `hysteron history {}`, which lists runs and times.", options.file));
    }
    if (options.output.empty()) {
      console.print(options.json ? as_json(options.file, runs, found) : listed(runs, found));
      return exit_ok;
    }
    return export_record(reader, runs, found, options, console);
  } catch (const database::DatabaseError& problem) {
    throw InputError(error::unreadable_history, Place{.file = options.file},
                     fmt::format("It cannot be read: {}.", problem.what()),
                     "where it is damaged, save what is left with `sqlite3 FILE .recover`.");
  }
}

}  // namespace

Action add_history(CLI::App& app) {
  const auto options = std::make_shared<HistoryOptions>();
  app.add_option("FILE", options->file, "The history, as [history] in a run file names it.")
      ->required()
      ->option_text("FILE");
  app.add_option("--from", options->from, "Rows from this time on, UTC, or so long before the newest row.")
      ->option_text("TIME");
  app.add_option("--to", options->to, "Rows up to this time.")->option_text("TIME");
  app.add_option("--points", options->points, "Some points alone, with commas between.")
      ->delimiter(',')
      ->option_text("NAMES");
  app.add_option("--run", options->run, "Rows of this run alone.")->check(whole_number_from(1))->option_text("N");
  app.add_option("--out", options->output, "The record, CSV.")->option_text("LOG.csv");
  app.add_flag("--gaps", options->gaps, "All stretches of the run, with the gaps between them.")->needs("--out");
  app.add_flag("--json", options->json, "Prints the list as JSON.")->excludes("--out");
  app.footer(std::string(history_examples));
  return [options](Console& console) { return history(*options, console); };
}

}  // namespace hysteron::tool
