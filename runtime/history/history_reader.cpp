#include "runtime/history/history_reader.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "runtime/history/tables.hpp"
#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

using database::Database;
using database::DatabaseError;
using database::Statement;

constexpr double smallest_step = 0.5;  ///< seconds: less is a clock that is brought to the right time by and by

Database opened(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& cause, const std::string& mend) {
    return InputError(error::unreadable_history, Place{.file = file.string()}, cause, mend);
  };
  try {
    switch (kind_of_history(file)) {
      case HistoryKind::Fits:
        return {file, Database::Mode::Read};
      case HistoryKind::None:
        throw refuse(std::filesystem::exists(file) ? "The file is empty." : "There is no such file.",
                     "name the file that [history] in the run file names; it is there a second after the start.");
      case HistoryKind::Other:
        throw refuse("It is a history of another version of Hysteron.", "export it with the version that wrote it.");
      case HistoryKind::Damaged:
        throw refuse("The file is damaged.",
                     "save what is left with `sqlite3 FILE .recover`, and look after the disk.");
      case HistoryKind::Foreign:
        break;
    }
  } catch (const DatabaseError& problem) {
    // A reader makes a file of its name and -shm beside a history that a task writes.
    const std::string of_machine = mend_of_machine(problem.reason());
    throw refuse(fmt::format("It cannot be opened: {}.", problem.what()),
                 (of_machine.empty() ? "let this user read it, and write to its folder" : of_machine) +
                     "; or copy it, with the file of its name and -wal, to a folder of yours.");
  }
  throw refuse("It is no history.", "name the file that [history] in the run file names.");
}

/// The rows of a span, from which the values are read: conditions that a statement ends with, and their values.
std::string condition(const HistorySpan& span) {
  return fmt::format("{}{}{}", span.from_ms ? fmt::format(" AND utc_ms >= {}", *span.from_ms) : "",
                     span.to_ms ? fmt::format(" AND utc_ms <= {}", *span.to_ms) : "",
                     span.run ? fmt::format(" AND run = {}", *span.run) : "");
}

}  // namespace

HistoryReader::HistoryReader(const std::filesystem::path& file) : database_(opened(file)) {}

std::vector<RecordedRun> HistoryReader::runs() {
  std::vector<RecordedRun> runs;
  Statement asked = database_.prepared(
      "SELECT run, title, begun_ms, period_ns, step FROM runs WHERE run BETWEEN (SELECT run FROM rows ORDER BY row "
      "LIMIT "
      "1) AND (SELECT run FROM rows ORDER BY row DESC LIMIT 1) ORDER BY run");
  Statement points = database_.prepared(
      "SELECT points.\"column\", name, unit, meaning FROM recorded JOIN points USING (\"column\") WHERE run = ? ORDER "
      "BY "
      "place");
  while (asked.step()) {
    RecordedRun& run = runs.emplace_back(RecordedRun{.run = asked.integer(0),
                                                     .title = asked.text(1),
                                                     .begun_ms = asked.integer(2),
                                                     .period = asked.integer(3),
                                                     .step = asked.integer(4)});
    points.bind(1, run.run);
    while (points.step()) {
      run.points.push_back(
          {.column = points.text(0), .name = points.text(1), .unit = points.text(2), .meaning = points.text(3)});
    }
    points.reset();
  }
  return runs;
}

std::optional<std::int64_t> HistoryReader::newest_ms() {
  Statement asked = database_.prepared("SELECT utc_ms FROM rows ORDER BY row DESC LIMIT 1");
  return asked.step() ? std::optional(asked.integer(0)) : std::nullopt;
}

StretchList HistoryReader::stretches(const HistorySpan& span) {
  StretchList found;
  for (const RecordedRun& run : runs()) {
    if (span.run && *span.run != run.run) {
      continue;
    }
    HistorySpan of_run = span;
    of_run.run = run.run;
    Statement rows =
        database_.prepared("SELECT row, elapsed, utc_ms FROM rows WHERE 1" + condition(of_run) + " ORDER BY row");
    std::optional<double> offset;  // of the wall clock from the periods of the run
    std::int64_t slot_before = 0;
    for (bool is_first = true; rows.step(); is_first = false) {
      const std::int64_t elapsed = rows.integer(1);
      const std::int64_t slot = elapsed / run.step;
      const double here = static_cast<double>(rows.integer(2)) * 1e-3 -
                          static_cast<double>(elapsed) * static_cast<double>(run.period) * 1e-9;
      if (offset && std::abs(here - *offset) > smallest_step) {
        found.clock_steps.push_back({.at_ms = rows.integer(2), .seconds = here - *offset});
      }
      offset = here;
      if (is_first || slot != slot_before + 1) {
        found.stretches.push_back(
            {.run = run.run, .first = rows.integer(0), .first_slot = slot, .first_ms = rows.integer(2)});
      }
      Stretch& stretch = found.stretches.back();
      stretch.last = rows.integer(0);
      stretch.last_ms = rows.integer(2);
      ++stretch.rows;
      stretch.late += elapsed % run.step == 0 ? 0 : 1;
      slot_before = slot;
    }
  }
  return found;
}

std::vector<std::vector<double>> HistoryReader::values(const Stretch& stretch, std::span<const RecordedPoint> points) {
  std::string columns;
  for (const RecordedPoint& point : points) {
    columns += (columns.empty() ? "" : ", ") + sql_name(point.column);
  }
  std::vector<std::vector<double>> values(points.size());
  for (std::vector<double>& one : values) {
    one.reserve(static_cast<std::size_t>(stretch.rows));
  }
  Statement rows = database_.prepared(
      fmt::format("SELECT {} FROM rows WHERE row BETWEEN ? AND ? AND run = ? ORDER BY row", columns));
  rows.bind(1, stretch.first).bind(2, stretch.last).bind(3, stretch.run);
  while (rows.step()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      values[i].push_back(rows.number(static_cast<int>(i)));
    }
  }
  return values;
}

std::string utc_text(std::int64_t ms) {
  const auto seconds = static_cast<std::time_t>(ms >= 0 ? ms / 1000 : (ms - 999) / 1000);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(seconds), ms - seconds * 1000);
}

}  // namespace hysteron::runtime
