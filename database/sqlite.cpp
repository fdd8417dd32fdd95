#include "database/sqlite.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <limits>
#include <system_error>

#include "support/atomic_file.hpp"

namespace hysteron::database {
namespace {

constexpr int patience_ms = 5000;

Trouble trouble_of(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return Trouble::Full;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Trouble::Held;
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return Trouble::Unreachable;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return Trouble::Damaged;
    default:
      return Trouble::Other;
  }
}

/// Without a write-ahead log beside it, nobody is about to write what is in the file.
bool is_at_rest(const std::filesystem::path& path) {
  std::error_code unknown;
  auto log = path;
  log += "-wal";
  return std::filesystem::exists(path, unknown) && !std::filesystem::exists(log, unknown);
}

/// A file that may not be written is opened to be read alone: what the system says last is of that, and not why.
int reason_of_unreachable(const std::string& name, int code, int cause) {
  if ((code & 0xff) != SQLITE_READONLY && (code & 0xff) != SQLITE_CANTOPEN) {
    return cause;
  }
  const std::filesystem::path path(name);
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const char* const written = ::access(name.c_str(), F_OK) == 0 ? name.c_str() : folder.c_str();
  return ::access(written, W_OK) != 0 ? errno : cause;
}

/// As a URI, in which the file is said to change no more.
std::string unchanging(const std::filesystem::path& path) {
  std::string uri = "file:";
  for (const char sign : std::filesystem::absolute(path).string()) {
    uri += sign == '%' || sign == '?' || sign == '#' ? fmt::format("%{:02X}", static_cast<unsigned>(sign))
                                                     : std::string(1, sign);
  }
  return uri + "?immutable=1";
}

}  // namespace

void Database::Closed::operator()(sqlite3* file) const {
  sqlite3_close_v2(file);
}

std::string way_out(const DatabaseError& problem) {
  return problem.trouble() == Trouble::Held ? "End the program that has it" : hysteron::way_out(problem.reason());
}

std::string put_aside(const std::filesystem::path& path) {
  const auto beside = [](const std::filesystem::path& name, const std::string& ending) {
    return std::filesystem::path(name).concat(ending);
  };
  std::error_code problem;
  for (int number = 1;; ++number) {
    const auto aside = beside(path, fmt::format(".aside{}", number));
    if (std::filesystem::exists(aside, problem)) {
      continue;
    }
    for (const char* const ending : {"-wal", "-shm", ""}) {
      std::filesystem::rename(beside(path, ending), beside(aside, ending), problem);
    }
    if (problem) {  // of the file itself, the last
      throw DatabaseError(fmt::format("{}: cannot be put aside: {}", path.string(), problem.message()),
                          Trouble::Unreachable);
    }
    return aside.string();
  }
}

Database::Database(const std::filesystem::path& path, Mode mode) : name_(path.string()) {
  open(name_, mode == Mode::Read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (mode == Mode::Write) {
    // The first counts for a new file alone, and only before anything is in it.
    run("PRAGMA auto_vacuum = INCREMENTAL; PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; "
        "PRAGMA foreign_keys = ON;");
    return;
  }
  const std::string look = "SELECT count(*) FROM sqlite_master;";  // says now that it is no file of SQLite
  try {
    run(look);
  } catch (const DatabaseError& refused) {
    if (refused.trouble() != Trouble::Unreachable || !is_at_rest(path)) {
      throw;
    }
    open(unchanging(path), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
    run(look);
  }
}

void Database::open(const std::string& name, int flags) {
  sqlite3* file = nullptr;
  const int code = sqlite3_open_v2(name.c_str(), &file, flags, nullptr);
  file_.reset(file);
  if (code != SQLITE_OK) {
    fail();
  }
  sqlite3_extended_result_codes(file, 1);
  sqlite3_busy_timeout(file, patience_ms);
}

void Database::fail() const {
  if (file_ == nullptr) {
    throw DatabaseError(name_ + ": out of memory", Trouble::Other);
  }
  const int code = sqlite3_errcode(file_.get());
  const int cause = sqlite3_system_errno(file_.get());
  const Trouble trouble = trouble_of(code);
  const int reason = trouble == Trouble::Full          ? ENOSPC
                     : trouble == Trouble::Unreachable ? reason_of_unreachable(name_, code, cause)
                                                       : cause;
  const bool tells = reason != 0 && trouble == Trouble::Unreachable;
  throw DatabaseError(fmt::format("{}: {}{}", name_, sqlite3_errmsg(file_.get()),
                                  tells ? fmt::format(" ({})", std::generic_category().message(reason)) : ""),
                      trouble, reason);
}

void Database::run(const std::string& sql) {
  if (sqlite3_exec(file_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    fail();
  }
}

Statement Database::prepared(std::string_view sql) {
  Statement result(*this);
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(file_.get(), sql.data(), static_cast<int>(sql.size()), &statement, nullptr);
  result.statement_.reset(statement);
  if (code != SQLITE_OK) {
    fail();
  }
  return result;
}

int Database::version() {
  Statement asked = prepared("PRAGMA user_version");
  return asked.step() ? static_cast<int>(asked.integer(0)) : 0;
}

void Database::set_version(int version) {
  run(fmt::format("PRAGMA user_version = {}", version));
}

void Statement::Ended::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void Statement::check(int code) const {
  if (code != SQLITE_OK) {
    database_->fail();
  }
}

Statement& Statement::bind(int place, double value) {
  check(std::isnan(value) ? sqlite3_bind_null(statement_.get(), place)
                          : sqlite3_bind_double(statement_.get(), place, value));
  return *this;
}

Statement& Statement::bind(int place, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), place, value));
  return *this;
}

Statement& Statement::bind(int place, std::string_view value) {
  // An empty text is a text: a null pointer would be NULL.
  check(sqlite3_bind_text(statement_.get(), place, value.empty() ? "" : value.data(), static_cast<int>(value.size()),
                          SQLITE_TRANSIENT));  // NOLINT(performance-no-int-to-ptr): a macro of SQLite
  return *this;
}

Statement& Statement::bind_null(int place) {
  check(sqlite3_bind_null(statement_.get(), place));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    database_->fail();
  }
  return code == SQLITE_ROW;
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

void Statement::reset() {
  sqlite3_reset(statement_.get());
}

double Statement::number(int column) const {
  return is_null(column) ? std::numeric_limits<double>::quiet_NaN() : sqlite3_column_double(statement_.get(), column);
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string Statement::text(int column) const {
  const unsigned char* const found = sqlite3_column_text(statement_.get(), column);
  return found == nullptr ? std::string()
                          : std::string(reinterpret_cast<const char*>(found),
                                        static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)));
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

Transaction::Transaction(Database& database) : database_(&database) {
  database_->run("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  if (is_open_) {
    try {
      database_->run("ROLLBACK");
    } catch (const DatabaseError&) {
      // What failed before has said so; SQLite rolls back by itself when the file is closed.
      is_open_ = false;
    }
  }
}

void Transaction::commit() {
  database_->run("COMMIT");
  is_open_ = false;
}

}  // namespace hysteron::database
