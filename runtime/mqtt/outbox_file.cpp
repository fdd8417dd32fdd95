#include "runtime/mqtt/outbox_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "support/descriptor.hpp"

namespace hysteron::runtime {
namespace {

using database::Database;
using database::DatabaseError;
using database::Statement;
using database::Transaction;
using database::Trouble;

constexpr int tables_version = 2;
constexpr const char* tables = R"(
CREATE TABLE owner (name TEXT NOT NULL);
CREATE TABLE points (place INTEGER PRIMARY KEY, name TEXT NOT NULL);
CREATE TABLE waiting (number INTEGER PRIMARY KEY, utc_ms INTEGER NOT NULL, cycle INTEGER NOT NULL, "values" TEXT NOT NULL);
)";

/// "0 1.5 0 3 nan 2": place, value, quality, and so on. A value is read back to the same bits.
std::string text_of(const MqttRow& row) {
  std::string text;
  for (const MqttValue& one : row.values) {
    fmt::format_to(std::back_inserter(text), "{}{} {} {}", text.empty() ? "" : " ", one.point, one.value,
                   static_cast<unsigned>(one.quality));
  }
  return text;
}

/// Nothing where it is not understood.
std::optional<std::vector<MqttValue>> values_in(std::string_view text) {
  std::vector<MqttValue> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto take = [&](auto& into) {
    at += at != end && *at == ' ' ? 1 : 0;
    const auto read = std::from_chars(at, end, into);
    at = read.ptr;
    return read.ec == std::errc{};
  };
  while (at != end) {
    MqttValue one;
    unsigned quality = 0;
    if (!take(one.point) || !take(one.value) || !take(quality) || quality > static_cast<unsigned>(ValueQuality::Bad)) {
      return {};
    }
    one.quality = static_cast<ValueQuality>(quality);
    values.push_back(one);
  }
  return values;
}

bool has_tables(Database& database) {
  Statement asked = database.prepared("SELECT count(*) FROM sqlite_master");
  return asked.step() && asked.integer(0) > 0;
}

/// Looked at first, for a file of another program is not even opened to write.
void require_own(const std::filesystem::path& path) {
  std::error_code unknown;
  if (std::filesystem::file_size(path, unknown) == 0 || unknown) {
    return;
  }
  Database database(path, Database::Mode::Read);
  if (has_tables(database) && database.version() != tables_version) {
    throw DatabaseError(path.string() + ": is no file of rows that wait, and is left alone", Trouble::Other);
  }
}

/// The process that has a file locked, with its command: "process 4711 (hysteron serve b.st)". Not to be asked where
/// this process itself has it: what it has locked is free then.
std::string holder_of(const std::filesystem::path& path) {
  constexpr std::size_t longest_command = 200;
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  if (!file.is_open() || ::fcntl(file.number(), F_GETLK, &lock) != 0 || lock.l_type == F_UNLCK || lock.l_pid <= 0) {
    return "another process";
  }
  std::ifstream told(fmt::format("/proc/{}/cmdline", lock.l_pid));
  std::string command{std::istreambuf_iterator<char>(told), {}};
  while (command.ends_with('\0')) {
    command.pop_back();
  }
  std::ranges::replace_if(
      command, [](char sign) { return static_cast<unsigned char>(sign) < ' '; }, ' ');
  return fmt::format("process {}{}", lock.l_pid,
                     command.empty() ? "" : " (" + command.substr(0, longest_command) + ")");
}

/// Opened alone, with the tables of these rows.
Database opened(const std::filesystem::path& path) {
  require_own(path);
  Database database(path, Database::Mode::Write);
  // From the next read on, for as long as it is open.
  database.run("PRAGMA locking_mode = EXCLUSIVE;");
  Transaction all(database);
  if (!has_tables(database)) {
    database.run(tables);
    database.set_version(tables_version);
  }
  all.commit();
  return database;
}

}  // namespace

OutboxFile::OutboxFile(const std::filesystem::path& file, const std::vector<std::string>& points,
                       const std::string& owner)
    : path_(file) {
  std::error_code unknown;  // the next call says what is wrong
  std::filesystem::create_directories(file.parent_path(), unknown);
  try {
    open(file);
    read(file, points, owner);
  } catch (const DatabaseError& problem) {
    if (problem.trouble() == Trouble::Held) {
      throw OutboxOfAnother(fmt::format("{}: {} has it open", file.string(), holder_of(file)), Trouble::Held);
    }
    if (problem.trouble() != Trouble::Damaged) {
      throw;
    }
    insert_.reset();
    delete_.reset();
    database_.reset();
    rows_ = {};
    first_ = end_ = 0;
    aside_ = database::put_aside(file);
    open(file);
    read(file, points, owner);
  }
  identity_ = file_behind(path_);
}

bool OutboxFile::is_there() const {
  return identity_ && file_behind(path_) == identity_;
}

void OutboxFile::open(const std::filesystem::path& file) {
  database_.emplace(opened(file));
  insert_.emplace(database_->prepared("INSERT INTO waiting (number, utc_ms, cycle, \"values\") VALUES (?, ?, ?, ?)"));
  delete_.emplace(database_->prepared("DELETE FROM waiting WHERE number < ?"));
}

void OutboxFile::read(const std::filesystem::path& file, const std::vector<std::string>& points,
                      const std::string& owner) {
  std::optional<std::string> owned_by;
  if (Statement owned = database_->prepared("SELECT name FROM owner"); owned.step()) {
    owned_by = owned.text(0);
  }
  if (owned_by && *owned_by != owner) {
    Statement counted = database_->prepared("SELECT count(*) FROM waiting");
    if (counted.step() && counted.integer(0) > 0) {
      throw OutboxOfAnother(
          fmt::format("{}: holds {} rows of {}, and is left alone", file.string(), counted.integer(0), *owned_by),
          Trouble::Other);
    }
  }
  std::vector<std::string> names;
  Statement named = database_->prepared("SELECT name FROM points ORDER BY place");
  while (named.step()) {
    names.push_back(named.text(0));
  }
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    places.push_back(static_cast<std::size_t>(std::ranges::find(points, name) - points.begin()));
  }
  Statement asked = database_->prepared("SELECT number, utc_ms, cycle, \"values\" FROM waiting ORDER BY number");
  while (asked.step()) {
    const auto values = values_in(asked.text(3));
    MqttRow row{.utc_ms = asked.integer(1), .cycle = static_cast<std::uint64_t>(asked.integer(2))};
    for (const MqttValue& one : values.value_or(std::vector<MqttValue>{})) {
      if (one.point < places.size() && places[one.point] < points.size()) {
        row.values.push_back({.point = places[one.point], .value = one.value, .quality = one.quality});
      }
    }
    if (rows_.empty()) {
      first_ = static_cast<std::uint64_t>(asked.integer(0));
    }
    if (!row.values.empty()) {
      rows_.push_back(std::move(row));
    }
    end_ = static_cast<std::uint64_t>(asked.integer(0)) + 1;
  }
  const bool is_as_written = owned_by == owner && names == points && end_ - first_ == rows_.size();
  if (!is_as_written) {
    write_anew(points, owner);
  }
}

void OutboxFile::write_anew(const std::vector<std::string>& points, const std::string& owner) {
  Transaction all(*database_);
  database_->run("DELETE FROM owner; DELETE FROM points; DELETE FROM waiting;");
  database_->prepared("INSERT INTO owner (name) VALUES (?)").bind(1, owner).run();
  Statement named = database_->prepared("INSERT INTO points (place, name) VALUES (?, ?)");
  for (std::size_t i = 0; i < points.size(); ++i) {
    named.bind(1, static_cast<std::int64_t>(i)).bind(2, points[i]).run();
  }
  end_ = first_;
  for (const MqttRow& row : rows_) {
    insert(end_++, row);
  }
  all.commit();
}

void OutboxFile::insert(std::uint64_t number, const MqttRow& row) {
  insert_->bind(1, static_cast<std::int64_t>(number))
      .bind(2, row.utc_ms)
      .bind(3, static_cast<std::int64_t>(row.cycle))
      .bind(4, text_of(row))
      .run();
}

void OutboxFile::follow(std::uint64_t first, const std::vector<const MqttRow*>& added) {
  const bool deletes = first > first_ && first_ < end_;
  if (!deletes && added.empty()) {
    first_ = std::max(first_, first);
    end_ = std::max(end_, first_);
    return;
  }
  std::uint64_t next = std::max(end_, first);
  Transaction all(*database_);
  if (deletes) {
    delete_->bind(1, static_cast<std::int64_t>(first)).run();
  }
  for (const MqttRow* const row : added) {
    insert(next++, *row);
  }
  all.commit();
  first_ = std::max(first_, first);
  end_ = next;
}

}  // namespace hysteron::runtime
