// A file of SQLite, and the statements that run on it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace hysteron::database {

/// What kept SQLite from its work.
enum class Trouble : std::uint8_t {
  Full,         ///< no room on the disk
  Unreachable,  ///< the file cannot be opened, read or written
  Damaged,      ///< it is no file of SQLite, or was one
  Held,         ///< another process writes, or holds it
  Other,        ///< a statement that is wrong, no memory
};

/// What SQLite says of a file: "fleet.sqlite: database is locked".
class DatabaseError : public std::runtime_error {
 public:
  DatabaseError(const std::string& text, Trouble trouble, int reason = 0)
      : std::runtime_error(text), trouble_(trouble), reason_(reason) {}
  [[nodiscard]] Trouble trouble() const { return trouble_; }
  /// As errno says it; 0 where the system did not.
  [[nodiscard]] int reason() const { return reason_; }
  /// Another try may succeed, as where another process writes or the disk is full.
  [[nodiscard]] bool is_passing() const { return trouble_ != Trouble::Damaged && trouble_ != Trouble::Other; }

 private:
  Trouble trouble_;
  int reason_;
};

/// As way_out(reason) of support, and of a file that another program has.
[[nodiscard]] std::string way_out(const DatabaseError& problem);

class Statement;

/// Renames a file with its log, to the first name that is free, NAME.aside1, and gives that. Throws DatabaseError.
[[nodiscard]] std::string put_aside(const std::filesystem::path& path);

/// An open file. One thread at a time uses it; several processes may open the same file.
class Database {
 public:
  enum class Mode { Read, Write };

  /// Opens a file; to write, it is made where it is not there. A writer keeps a write-ahead log, so that readers never
  /// wait for it and a power cut loses no more than the last transaction. Waits up to 5 s for other writers. A new file
  /// gives the pages of what is deleted back where it is asked to (`PRAGMA incremental_vacuum`). A file that nobody
  /// writes can be read from a folder that may not be written.
  /// Throws DatabaseError where it cannot be opened, or is no file of SQLite.
  Database(const std::filesystem::path& path, Mode mode);

  /// One or more statements without values, as `CREATE TABLE …; CREATE INDEX …`. Throws DatabaseError.
  void run(const std::string& sql);

  /// A statement with values at its `?`. Throws DatabaseError where the text is wrong.
  [[nodiscard]] Statement prepared(std::string_view sql);

  /// What a program calls the version of its tables (`PRAGMA user_version`); 0 in a new file.
  [[nodiscard]] int version();
  void set_version(int version);

 private:
  friend class Statement;
  void open(const std::string& name, int flags);
  [[noreturn]] void fail() const;

  struct Closed {
    void operator()(sqlite3* file) const;
  };
  std::string name_;
  std::unique_ptr<sqlite3, Closed> file_;
};

/// A statement that may run many times: bind its values from 1, step through its rows, reset. It ends before its
/// database.
class Statement {
 public:
  Statement& bind(int place, double value);  ///< NaN is stored as NULL: SQLite has no other word for it
  Statement& bind(int place, std::int64_t value);
  Statement& bind(int place, std::string_view value);
  Statement& bind_null(int place);

  /// The next row: false at the end. Throws DatabaseError.
  bool step();
  /// Runs to the end and is ready for other values.
  void run();
  /// Ready to run again; the values stay bound.
  void reset();

  /// Cells of the row, from 0. NULL is NaN, 0, and empty.
  [[nodiscard]] double number(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] bool is_null(int column) const;

 private:
  friend class Database;
  struct Ended {
    void operator()(sqlite3_stmt* statement) const;
  };
  explicit Statement(const Database& database) : database_(&database) {}
  void check(int code) const;

  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Ended> statement_{};
};

/// All between its begin and commit() is there, or nothing of it: without commit() it is rolled back.
class Transaction {
 public:
  /// Takes the right to write at once, so that two writers never both fail at their end. Throws DatabaseError.
  explicit Transaction(Database& database);
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  void commit();

 private:
  Database* database_;
  bool is_open_ = true;
};

}  // namespace hysteron::database
