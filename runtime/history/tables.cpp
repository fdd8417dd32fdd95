#include "runtime/history/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <system_error>

namespace hysteron::runtime {
namespace {

constexpr int application = 0x48795374;  // "HySt"
constexpr std::string_view magic("SQLite format 3\0", 16);

/// Of what SQLite does not read.
HistoryKind kind_by_beginning(const std::filesystem::path& file) {
  std::array<char, 16> begin{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), begin.size());
  const bool is_whole = stream.gcount() == static_cast<std::streamsize>(begin.size());
  const bool is_zero = std::ranges::all_of(begin, [](char byte) { return byte == 0; });
  return is_whole && (is_zero || std::string_view(begin.data(), begin.size()) == magic) ? HistoryKind::Damaged
                                                                                        : HistoryKind::Foreign;
}

}  // namespace

HistoryKind kind_of_history(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown) ||
      (std::filesystem::is_regular_file(file, unknown) && std::filesystem::file_size(file, unknown) == 0)) {
    return HistoryKind::None;
  }
  if (!std::filesystem::is_regular_file(file, unknown)) {
    return HistoryKind::Foreign;
  }
  try {
    database::Database database(file, database::Database::Mode::Read);
    database::Statement asked = database.prepared("PRAGMA application_id");
    const bool is_ours = asked.step() && asked.integer(0) == application;
    asked.reset();
    if (is_ours) {
      return database.version() == history_version ? HistoryKind::Fits : HistoryKind::Other;
    }
    // A start that was killed before its tables were there leaves a file of SQLite without any.
    database::Statement tables = database.prepared("SELECT count(*) FROM sqlite_master");
    return tables.step() && tables.integer(0) == 0 ? HistoryKind::None : HistoryKind::Foreign;
  } catch (const database::DatabaseError& problem) {
    if (problem.trouble() != database::Trouble::Damaged) {
      throw;
    }
  }
  return kind_by_beginning(file);
}

void make_history_tables(database::Database& database) {
  database::Transaction all(database);
  database.run(
      "CREATE TABLE runs (run INTEGER PRIMARY KEY AUTOINCREMENT, key TEXT NOT NULL UNIQUE, title TEXT NOT NULL, "
      "begun_ms INTEGER NOT NULL, period_ns INTEGER NOT NULL, step INTEGER NOT NULL);"
      "CREATE TABLE points (\"column\" TEXT PRIMARY KEY COLLATE NOCASE, name TEXT NOT NULL, unit TEXT NOT NULL, type "
      "TEXT NOT NULL, meaning TEXT NOT NULL);"
      "CREATE TABLE recorded (run INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, place INTEGER NOT NULL, "
      "\"column\" TEXT NOT NULL REFERENCES points, PRIMARY KEY (run, place)) WITHOUT ROWID;"
      "CREATE TABLE rows (row INTEGER PRIMARY KEY, run INTEGER NOT NULL, cycle INTEGER NOT NULL, elapsed INTEGER NOT "
      "NULL, utc_ms INTEGER NOT NULL);");
  database.run(fmt::format("PRAGMA application_id = {}", application));
  database.set_version(history_version);
  all.commit();
}

std::string sql_name(std::string_view name) {
  std::string text = "\"";
  for (const char sign : name) {
    text += sign == '"' ? "\"\"" : std::string(1, sign);
  }
  return text + '"';
}

}  // namespace hysteron::runtime
