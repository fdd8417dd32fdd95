// The file that a trace is written to: locked against a second writer, begun only once the one before is put aside, and
// never ending within a record.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace hysteron::runtime {

/// Where the trace of the run before is kept: FILE.1.
[[nodiscard]] std::filesystem::path previous_trace(const std::filesystem::path& file);

class TraceOutput {
 public:
  /// What stands there is moved to previous_trace(file), where it has any bytes. Throws std::system_error where it
  /// cannot be; std::errc::resource_unavailable_try_again where another process writes it.
  explicit TraceOutput(std::filesystem::path file);
  ~TraceOutput();
  TraceOutput(const TraceOutput&) = delete;
  TraceOutput& operator=(const TraceOutput&) = delete;

  /// The bytes that were written, from the first on; all of them, or problem() says why not.
  [[nodiscard]] std::size_t write(std::string_view bytes);
  /// Takes back the last bytes that were written, as far as the file allows.
  void take_back(std::size_t bytes) noexcept;
  /// Nothing begins here after all: what was moved away has its name again.
  void give_back() noexcept;
  /// Why writing failed last, with the file's name; empty where it did not.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  bool has_moved_ = false;
  std::string problem_{};
};

}  // namespace hysteron::runtime
