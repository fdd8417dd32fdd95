// The file of a history as its writer has it: rows are added in transactions, and the oldest go where it grows too
// large or they too old.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "database/sqlite.hpp"
#include "runtime/point.hpp"
#include "runtime/task/sample_tap.hpp"
#include "support/descriptor.hpp"
#include "support/file_identity.hpp"

namespace hysteron::runtime {

/// The run that writes: the same for as long as the task runs, whatever becomes of the file.
struct HistoryRun {
  std::string key{};  ///< of no other run
  std::string title{};
  std::int64_t begun_ms = 0;  ///< UTC
  std::int64_t period = 0;    ///< of a cycle, in ns
  std::uint64_t step = 1;     ///< periods from row to row
};

/// All of one file: what it may take, and what is written into it.
struct HistoryPlan {
  std::filesystem::path file{};
  std::uint64_t bytes = 0;
  HistoryRun run{};
  std::vector<Point> points{};
};

/// Another task writes the history. It is held by a file beside it, NAME.lock.
class HistoryLock {
 public:
  /// Throws database::DatabaseError: Held where another process has it.
  explicit HistoryLock(const std::filesystem::path& file);
  /// False where somebody deleted or moved that file: another task may hold one of its name.
  [[nodiscard]] bool is_there() const { return identity_ && file_behind(path_) == identity_; }

 private:
  std::filesystem::path path_;
  Descriptor held_{};
  std::optional<FileIdentity> identity_{};
};

class HistoryFile {
 public:
  /// Opens the file, or makes it. What cannot be gone on with, a damaged file or one of another version, is renamed.
  /// `anew`: whatever is there is renamed. Throws database::DatabaseError.
  explicit HistoryFile(const HistoryPlan& plan, bool anew = false);

  /// The name that what was there has now; empty where nothing was put aside.
  [[nodiscard]] const std::string& aside() const { return aside_; }
  /// False where the name is another file's by now, or nobody's: what is written would be lost.
  [[nodiscard]] bool is_there() const;
  /// Takes all rows over from the log into the file, as far as that can be: a file that is moved leaves its log behind.
  void finish_log() noexcept;
  /// One transaction: all rows are on the disk, or none. `utc_ms`, a time for each row.
  void add(std::span<const Sample> rows, std::span<const std::int64_t> utc_ms);
  /// Deletes the oldest rows: what is beyond the size, and those from before `oldest_ms`. Gives up after some portions,
  /// so that a turn is short; the next goes on.
  void trim(std::optional<std::int64_t> oldest_ms);
  /// Of the file and of its log, in bytes.
  [[nodiscard]] std::uint64_t size() const;

 private:
  void begin_run(const HistoryPlan& plan);
  [[nodiscard]] std::string column_of(const Point& point);
  void empty_log();
  bool delete_oldest(std::int64_t count);

  std::filesystem::path path_;
  std::uint64_t bytes_;
  std::string aside_;
  std::optional<database::Database> database_{};
  std::optional<database::Statement> insert_{};
  std::int64_t run_ = 0;
  std::optional<FileIdentity> identity_{};
};

}  // namespace hysteron::runtime
