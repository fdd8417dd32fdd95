// The file that a trace is written to: locked against a second writer, begun only once the one before is put aside, and
// never ending within a record. The files before are kept by number, FILE.1 the newest of them, and no more of them
// than asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace hysteron::runtime {

/// Where the trace before is kept: FILE.1; those before it are FILE.2, …
[[nodiscard]] std::filesystem::path previous_trace(const std::filesystem::path& file, std::size_t number = 1);

class TraceOutput {
 public:
  /// What stands there is moved to previous_trace(file), where it has any bytes, and the others on by one: the one
  /// numbered `kept`, at least 1, goes. A trace without a step is written over instead. Throws std::system_error where
  /// something is in the way that is no file; std::errc::resource_unavailable_try_again where another process writes
  /// it. Where it cannot be for another reason, it is not open.
  explicit TraceOutput(std::filesystem::path file, std::size_t kept = 1);
  ~TraceOutput();
  TraceOutput(const TraceOutput&) = delete;
  TraceOutput& operator=(const TraceOutput&) = delete;

  /// The bytes that were written, from the first on; all of them, or problem() says why not.
  [[nodiscard]] std::size_t write(std::string_view bytes);
  /// Brings the file and its name to the disk, so that after a power cut it is known for what it is. That it cannot be
  /// is no fault: what is written next says so.
  void flush() const noexcept;
  /// Takes back the last bytes that were written, as far as the file allows.
  void take_back(std::size_t bytes) noexcept;
  /// Nothing begins here after all: what was moved away has its name again.
  void give_back() noexcept;
  /// Ends this file and begins another, as after a start. False, with the problem, where it cannot be: writing then
  /// goes on where it was.
  bool begin_next();
  /// In this file so far.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Whether somebody else has moved or cut the file, as a rotation of logs does.
  [[nodiscard]] bool is_taken_away() const;
  /// Whether it has no name any more, and what is in it is lost.
  [[nodiscard]] bool is_deleted() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// Why writing failed last, with the file's name; empty where it did not.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// The same, as errno says it.
  [[nodiscard]] int reason() const { return reason_; }

 private:
  void open_next();

  std::filesystem::path file_;
  std::size_t kept_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  bool has_moved_ = false;
  std::string problem_{};
  int reason_ = 0;
};

}  // namespace hysteron::runtime
