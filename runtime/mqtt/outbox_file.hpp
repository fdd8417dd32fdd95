// Rows that wait for the broker, on the disk: what is there is whole after a kill or a power cut at any moment.
//
// The file follows an outbox: rows are numbered on and on, the oldest go first. It is SQLite's, with a log that is
// flushed with each transaction. Only one process at a time has it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "database/sqlite.hpp"
#include "runtime/mqtt/row.hpp"
#include "support/file_identity.hpp"

namespace hysteron::runtime {

/// The file is another task's: it has the file open, or its rows wait there.
class OutboxOfAnother : public database::DatabaseError {
 public:
  using DatabaseError::DatabaseError;
};

class OutboxFile {
 public:
  /// Opens the file, or makes it; a damaged one is renamed. `points`: the names of those that are published.
  /// `owner`: the task, and where its rows go; rows of another one are never read. Throws OutboxOfAnother where another
  /// process has it or rows of another owner wait in it, database::DatabaseError else; the file is left alone then.
  OutboxFile(const std::filesystem::path& file, const std::vector<std::string>& points, const std::string& owner = "");

  /// The name that a damaged file has now; empty where nothing was put aside.
  [[nodiscard]] const std::string& aside() const { return aside_; }
  /// The rows of earlier runs, oldest first: of a point that is no longer published they have no value, and what has
  /// none left is none.
  [[nodiscard]] const std::vector<MqttRow>& rows() const { return rows_; }
  void forget_rows() { rows_ = {}; }
  /// Whether the file still has its name: one that was deleted or moved takes rows that nobody finds.
  [[nodiscard]] bool is_there() const;
  /// The number of the first of them, and of what is added next where there are none.
  [[nodiscard]] std::uint64_t first() const { return first_; }
  [[nodiscard]] std::uint64_t end() const { return end_; }

  /// One transaction: rows before `first` are gone, and these, from `end()` or `first` on, whichever is later, are
  /// there. Nothing is written where that changes nothing.
  void follow(std::uint64_t first, const std::vector<const MqttRow*>& added);

 private:
  void open(const std::filesystem::path& file);
  void read(const std::filesystem::path& file, const std::vector<std::string>& points, const std::string& owner);
  void write_anew(const std::vector<std::string>& points, const std::string& owner);
  void insert(std::uint64_t number, const MqttRow& row);

  std::filesystem::path path_;
  std::optional<FileIdentity> identity_{};
  std::string aside_;
  std::vector<MqttRow> rows_{};
  std::uint64_t first_ = 0;
  std::uint64_t end_ = 0;
  std::optional<database::Database> database_{};
  std::optional<database::Statement> insert_{};
  std::optional<database::Statement> delete_{};
};

}  // namespace hysteron::runtime
