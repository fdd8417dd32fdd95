#include "runtime/history/history_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "runtime/history/tables.hpp"
#include "runtime/modbus/value_bits.hpp"

namespace hysteron::runtime {
namespace {

using database::Database;
using database::DatabaseError;
using database::Statement;
using database::Transaction;
using database::Trouble;

constexpr std::int64_t portion = 5000;      ///< rows deleted at once, at the most
constexpr int portions = 20;                ///< a turn
constexpr int vacuumed_pages = 512;         ///< given back to the disk at once
constexpr std::size_t most_columns = 1900;  ///< of the 2000 that SQLite has

std::filesystem::path beside(const std::filesystem::path& path, const char* ending) {
  return std::filesystem::path(path).concat(ending);
}

std::uint64_t size_of(const std::filesystem::path& path) {
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  return unknown ? 0 : size;
}

std::int64_t number_of(Database& database, const char* question) {
  Statement asked = database.prepared(question);
  return asked.step() ? asked.integer(0) : 0;
}

}  // namespace

HistoryLock::HistoryLock(const std::filesystem::path& file) : path_(beside(file, ".lock")) {
  std::error_code unknown;  // the next call says what is wrong
  std::filesystem::create_directories(file.parent_path(), unknown);
  held_ = Descriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (held_.number() < 0 || ::flock(held_.number(), LOCK_EX | LOCK_NB) != 0) {
    const int cause = errno;
    if (cause == EWOULDBLOCK) {
      throw DatabaseError(file.string() + ": another task writes it", Trouble::Held);
    }
    throw DatabaseError(fmt::format("{}: {}", path_.string(), std::generic_category().message(cause)),
                        Trouble::Unreachable);
  }
  struct stat mine {};
  if (::fstat(held_.number(), &mine) == 0) {
    identity_ = identity_of(mine);
  }
}

HistoryFile::HistoryFile(const HistoryPlan& plan, bool anew) : path_(plan.file), bytes_(plan.bytes) {
  std::error_code unknown;
  std::filesystem::create_directories(path_.parent_path(), unknown);
  HistoryKind kind = kind_of_history(path_);
  if (kind == HistoryKind::Foreign) {
    throw DatabaseError(path_.string() + ": is no history, and is left alone", Trouble::Damaged);
  }
  if (kind == HistoryKind::Damaged || kind == HistoryKind::Other || (anew && kind == HistoryKind::Fits)) {
    aside_ = database::put_aside(path_);
    kind = HistoryKind::None;
  }
  database_.emplace(path_, Database::Mode::Write);
  // A quarter of the size is the log's: it grows for as long as somebody reads.
  database_->run(fmt::format("PRAGMA journal_size_limit = {}; PRAGMA wal_autocheckpoint = {};", bytes_ / 4,
                             std::clamp<std::uint64_t>(bytes_ / 8 / 4096, 8, 1000)));
  if (kind == HistoryKind::None) {
    make_history_tables(*database_);
  }
  begin_run(plan);
  identity_ = file_behind(path_);
}

void HistoryFile::begin_run(const HistoryPlan& plan) {
  Transaction all(*database_);
  const HistoryRun& run = plan.run;
  database_->prepared("INSERT OR IGNORE INTO runs (key, title, begun_ms, period_ns, step) VALUES (?, ?, ?, ?, ?)")
      .bind(1, run.key)
      .bind(2, run.title)
      .bind(3, run.begun_ms)
      .bind(4, run.period)
      .bind(5, static_cast<std::int64_t>(run.step))
      .run();
  Statement asked = database_->prepared("SELECT run FROM runs WHERE key = ?");
  run_ = asked.bind(1, run.key).step() ? asked.integer(0) : 0;
  asked.reset();
  std::string columns = "run, cycle, elapsed, utc_ms";
  std::string places = "?, ?, ?, ?";
  Statement recorded = database_->prepared("INSERT OR REPLACE INTO recorded (run, place, \"column\") VALUES (?, ?, ?)");
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const std::string column = column_of(plan.points[i]);
    recorded.bind(1, run_).bind(2, static_cast<std::int64_t>(i)).bind(3, column).run();
    columns += ", " + sql_name(column);
    places += ", ?";
  }
  insert_.emplace(database_->prepared(fmt::format("INSERT INTO rows ({}) VALUES ({})", columns, places)));
  all.commit();
}

/// The column of a point, made where it is not there. A point whose unit is another now has another column.
std::string HistoryFile::column_of(const Point& point) {
  Statement known = database_->prepared("SELECT \"column\" FROM points WHERE name = ? COLLATE NOCASE AND unit = ?");
  if (known.bind(1, point.name).bind(2, point.unit).step()) {
    const std::string column = known.text(0);
    database_->prepared("UPDATE points SET type = ?, meaning = ? WHERE \"column\" = ?")
        .bind(1, modbus::name_of(point.type))
        .bind(2, point.meaning)
        .bind(3, column)
        .run();
    return column;
  }
  std::vector<std::string> taken;
  Statement there = database_->prepared("SELECT name FROM pragma_table_info('rows')");
  while (there.step()) {
    taken.push_back(there.text(0));
  }
  if (taken.size() > most_columns) {
    throw DatabaseError(fmt::format("{}: has had {} points; name another file", path_.string(), taken.size()),
                        Trouble::Damaged);
  }
  Statement same = database_->prepared("SELECT ? = ? COLLATE NOCASE");
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::any_of(taken, [&](const std::string& one) {
      same.reset();
      return same.bind(1, one).bind(2, name).step() && same.integer(0) != 0;
    });
  };
  std::string column = point.name;
  for (int number = 1; is_taken(column); ++number) {
    column = fmt::format("{} [{}]{}", point.name, point.unit, number == 1 ? "" : fmt::format(" {}", number));
  }
  same.reset();
  there.reset();
  known.reset();
  database_->run(fmt::format("ALTER TABLE rows ADD COLUMN {} REAL", sql_name(column)));
  database_->prepared("INSERT INTO points (\"column\", name, unit, type, meaning) VALUES (?, ?, ?, ?, ?)")
      .bind(1, column)
      .bind(2, point.name)
      .bind(3, point.unit)
      .bind(4, modbus::name_of(point.type))
      .bind(5, point.meaning)
      .run();
  return column;
}

bool HistoryFile::is_there() const {
  return identity_ && file_behind(path_) == identity_;
}

void HistoryFile::finish_log() noexcept {
  try {
    (void)number_of(*database_, "PRAGMA wal_checkpoint(TRUNCATE)");
  } catch (const DatabaseError&) {
    // What the log holds is lost then, as is said of every file that is gone.
  }
}

std::uint64_t HistoryFile::size() const {
  return size_of(path_) + size_of(beside(path_, "-wal"));
}

void HistoryFile::add(std::span<const Sample> rows, std::span<const std::int64_t> utc_ms) {
  empty_log();
  Transaction all(*database_);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    insert_->bind(1, run_)
        .bind(2, static_cast<std::int64_t>(rows[i].cycle))
        .bind(3, static_cast<std::int64_t>(rows[i].elapsed))
        .bind(4, utc_ms[i]);
    for (std::size_t k = 0; k < rows[i].values.size(); ++k) {
      insert_->bind(static_cast<int>(5 + k), rows[i].values[k]);
    }
    insert_->run();
  }
  all.commit();
}

/// A program that reads for long keeps the log from being taken over into the file.
void HistoryFile::empty_log() {
  const auto log = beside(path_, "-wal");
  if (size_of(log) <= bytes_ / 4) {
    return;
  }
  (void)number_of(*database_, "PRAGMA wal_checkpoint(TRUNCATE)");
  if (size_of(log) > bytes_ / 4) {
    throw DatabaseError(
        fmt::format("{}: another program has been reading for so long that its log is full", path_.string()),
        Trouble::Held);
  }
}

/// Of the rows that are there, the first `count` by their number. False where there are none.
bool HistoryFile::delete_oldest(std::int64_t count) {
  Statement first = database_->prepared("SELECT min(row) FROM rows");
  if (!first.step() || first.is_null(0)) {
    return false;
  }
  const std::int64_t lowest = first.integer(0);
  first.reset();
  Transaction all(*database_);
  database_->prepared("DELETE FROM rows WHERE row < ?").bind(1, lowest + count).run();
  database_
      ->prepared("DELETE FROM runs WHERE run <> ? AND run < coalesce((SELECT run FROM rows ORDER BY row LIMIT 1), ?)")
      .bind(1, run_)
      .bind(2, run_)
      .run();
  all.commit();
  return true;
}

void HistoryFile::trim(std::optional<std::int64_t> oldest_ms) {
  const auto page = static_cast<std::uint64_t>(number_of(*database_, "PRAGMA page_size"));
  const std::uint64_t limit = bytes_ / 4 * 3 / std::max<std::uint64_t>(page, 1);
  const auto pages = [&] { return static_cast<std::uint64_t>(number_of(*database_, "PRAGMA page_count")); };
  const auto unused = [&] { return static_cast<std::uint64_t>(number_of(*database_, "PRAGMA freelist_count")); };
  for (int turn = 0; turn < portions && pages() - unused() > limit; ++turn) {
    const std::int64_t rows = number_of(*database_, "SELECT max(row) - min(row) + 1 FROM rows");
    empty_log();
    if (!delete_oldest(std::clamp<std::int64_t>(rows / 50, 1, portion))) {
      break;
    }
  }
  for (int turn = 0; turn < portions && oldest_ms; ++turn) {
    // Most turns end here: to look at a portion of rows takes milliseconds, and this is asked every second.
    Statement first = database_->prepared("SELECT utc_ms FROM rows ORDER BY row LIMIT 1");
    if (!first.step() || first.integer(0) >= *oldest_ms) {
      break;
    }
    first.reset();
    // The first of the oldest that is young enough: nothing behind it is deleted, whatever its time.
    Statement asked = database_->prepared(
        "SELECT min(row), max(row), min(CASE WHEN utc_ms >= ? THEN row END) FROM (SELECT row, utc_ms FROM rows ORDER "
        "BY "
        "row LIMIT ?)");
    if (!asked.bind(1, *oldest_ms).bind(2, portion).step() || asked.is_null(0)) {
      break;
    }
    const std::int64_t count = (asked.is_null(2) ? asked.integer(1) + 1 : asked.integer(2)) - asked.integer(0);
    asked.reset();
    if (count <= 0) {
      break;
    }
    empty_log();
    (void)delete_oldest(count);
  }
  if (pages() > limit && unused() > 0) {
    database_->run(fmt::format("PRAGMA incremental_vacuum({})", vacuumed_pages));
  }
}

}  // namespace hysteron::runtime
