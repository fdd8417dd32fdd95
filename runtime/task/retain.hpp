// Values that outlive the process: parameters and the state of the program, in two slots.
//
// The newest state goes into the slot that holds the older one, under a temporary name, flushed, and renamed; so a
// power cut at any byte leaves the other slot whole. A slot is a sequence number, the layout of the program, what its
// values mean (carry.hpp), parameters, state, inputs and a CRC32C over all of it. Files are written by a thread of
// their own; the cyclic thread only copies.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/task/exchange.hpp"
#include "runtime/task/remarks.hpp"
#include "runtime/task/step_program.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime {

struct RetainedValues {
  std::uint64_t sequence = 0;
  std::string layout{};
  std::string described{};  ///< see describe(); empty in files of before it
  std::vector<double> parameters{};
  std::vector<std::byte> state{};
  std::vector<double> inputs{};  ///< those that clients write and that are retained, as they are described
  std::uint64_t commits = 0;     ///< sets of parameters that the run had applied; in no file
};

enum class SlotStatus : std::uint8_t { whole, missing, broken };

struct Slot {
  SlotStatus status = SlotStatus::missing;
  RetainedValues values{};
};

/// The CRC-32C (Castagnoli) of bytes, as in iSCSI.
[[nodiscard]] std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept;

[[nodiscard]] std::vector<std::byte> encode_slot(const RetainedValues& values);
/// Whole only where every byte is as it was written; never reads beyond the bytes.
[[nodiscard]] Slot decode_slot(std::span<const std::byte> bytes);

/// Where slots are kept; a test puts a disk that fails in its place.
class RetainFiles {
 public:
  RetainFiles() = default;
  RetainFiles(const RetainFiles&) = delete;
  RetainFiles& operator=(const RetainFiles&) = delete;
  virtual ~RetainFiles() = default;
  /// Nothing where there is no such slot. Throws std::system_error where there is one that cannot be read: what it
  /// holds is not lost, and must not be taken for missing.
  [[nodiscard]] virtual std::optional<std::vector<std::byte>> read(std::size_t slot) = 0;
  /// Whole or not at all. Empty, or why it failed.
  virtual std::string write(std::size_t slot, std::span<const std::byte> bytes) = 0;
  /// Puts a slot aside where nothing overwrites it. Empty, or why it failed.
  virtual std::string put_aside(std::size_t slot) = 0;
  /// A copy of it there, the slot left as it is. Empty, or why it failed.
  virtual std::string copy_aside(std::size_t slot) = 0;
  /// What mends the last write that failed, as way_out() says it.
  [[nodiscard]] virtual std::string mend() const { return "Clear what is in the way there"; }
  /// What became of the files beside that, to be told once; mostly empty.
  [[nodiscard]] virtual std::string take_remark() { return {}; }
};

/// Files retain_a and retain_b in a folder.
class RetainFolder final : public RetainFiles {
 public:
  explicit RetainFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  RetainFolder(const RetainFolder&) = delete;
  RetainFolder& operator=(const RetainFolder&) = delete;
  ~RetainFolder() override = default;
  /// Makes the folder where it is missing, and holds it against a second task for as long as this lives. Where the disk
  /// has no room for it, it is made and held by the first state that finds some; so is another one where somebody
  /// deletes or moves it. Throws
  /// std::system_error where it cannot be written to; std::errc::resource_unavailable_try_again where another task
  /// holds it.
  void open();
  [[nodiscard]] std::optional<std::vector<std::byte>> read(std::size_t slot) override;
  std::string write(std::size_t slot, std::span<const std::byte> bytes) override;
  std::string put_aside(std::size_t slot) override;
  std::string copy_aside(std::size_t slot) override;
  [[nodiscard]] std::string mend() const override;
  [[nodiscard]] std::string take_remark() override { return std::exchange(remark_, {}); }
  [[nodiscard]] std::filesystem::path path_of(std::size_t slot) const;

 private:
  /// Whether the folder of that name is another one than was held, or is gone.
  [[nodiscard]] bool is_taken_away() const;
  std::string write_slot(std::size_t slot, std::span<const std::byte> bytes);
  std::string problem(const std::filesystem::path& path);

  std::filesystem::path folder_;
  Descriptor held_{};
  bool was_taken_away_ = false;
  int reason_ = 0;  ///< of the last problem
  std::string remark_{};
};

/// What a start does with the values of another diagram, or of an edited one. Those of the same diagram by another
/// engine are carried over whatever it is.
enum class MismatchPolicy : std::uint8_t {
  refuse,  ///< does not start
  cold,    ///< puts the files aside and starts without them
  carry,   ///< takes over by name what is still the same, and keeps a copy of the files
};

/// Why a task must not start with what is retained.
enum class RetainRefusal : std::uint8_t {
  none,
  of_another,  ///< diagram, or of other units
  unfit,       ///< its parameters cannot be
  not_finite,  ///< no slot has a state of numbers
  damaged,     ///< no slot is whole
};

struct Recovery {
  std::optional<RetainedValues> values{};
  bool by_name = false;  ///< the values are of another layout, to be carried over
  RetainRefusal refusal = RetainRefusal::none;
  std::string refused{};        ///< the same, a sentence
  std::string note{};           ///< what a reader of the status line should know
  std::string loss{};           ///< what was retained and is lost, a sentence for standard error
  std::uint64_t sequence = 0;   ///< of the newest slot
  std::size_t next_slot = 0;    ///< where to write first
  std::array<bool, 2> aside{};  ///< the slots to be put aside before anything is written; copied, if `by_name`
};

/// What only the program can say of retained values of its own layout.
struct RetainChecks {
  /// Why it cannot take their parameters, a sentence; empty where it can.
  std::function<std::string(const RetainedValues&)> refusal{};
  /// The number of their state that is not finite; empty where none is. Such a slot is as one that is broken.
  std::function<std::string(const RetainedValues&)> not_finite{};
  /// A value of theirs that the program has in another unit: "AMP.K is in V/mm there, V/um here". They are of another
  /// diagram then, though it has the same layout, in which units do not count. Empty where there is none.
  std::function<std::string(const RetainedValues&)> other_unit{};
};

/// Reads both slots and says how to start; changes nothing.
[[nodiscard]] Recovery recover(RetainFiles& files, const std::string& layout, MismatchPolicy policy,
                               const RetainChecks& checks = {});
/// Puts aside what the recovery says, and takes out of it what is. Empty, or why the rest is not.
std::string put_aside(RetainFiles& files, Recovery& recovery);

/// The values of one program on their way to the disk.
class RetainImage {
 public:
  /// A state is not written in which a number is not finite that is so in `after_reset`, the program's state when it
  /// begins; empty: whatever it is. `inputs`: those of the program that are retained. The program's shape must outlive
  /// it.
  RetainImage(const StepProgram& program, std::vector<std::byte> after_reset,
              const std::vector<std::size_t>& inputs = {});

  /// How many of them are on the disk; from any thread.
  [[nodiscard]] std::uint64_t written() const noexcept { return written_.load(std::memory_order_relaxed); }

 private:
  friend class Retainer;
  std::atomic<std::uint64_t> written_{0};
  const ProgramShape* shape_;
  std::vector<std::byte> after_reset_;
  Latest<RetainedValues> newest_;
};

/// Copies in the cyclic thread, writes in its own.
class Retainer {
 public:
  /// As RetainImage says of the program and its state when it begins. The program must outlive it. What `start` says
  /// is to be put aside is so before the first state is written.
  Retainer(RetainFiles& files, const StepProgram& program, const Recovery& start,
           std::vector<std::byte> after_reset = {}, std::vector<std::size_t> inputs = {});
  ~Retainer() { finish(); }
  Retainer(const Retainer&) = delete;
  Retainer& operator=(const Retainer&) = delete;

  /// From the cyclic thread, between two steps; `commits`: the sets of parameters applied in this run; `inputs`: all of
  /// the program's, where some are retained.
  void offer(const StepProgram& program, std::uint64_t commits = 0, std::span<const double> inputs = {}) noexcept;
  /// The inputs that are retained, of a version as of all.
  [[nodiscard]] const std::vector<std::size_t>& inputs() const noexcept { return inputs_; }
  /// From the cyclic thread: what is offered from now on is of another program, which has this image. What was offered
  /// before and is not written yet never is.
  void change(RetainImage& image) noexcept { image_.store(&image, std::memory_order_release); }
  /// From another thread: back when nothing reads an image that was changed for another one.
  void let_go() { const std::scoped_lock lock(writing_); }

  /// Sequence number of the newest slot on the disk.
  [[nodiscard]] std::uint64_t written() const noexcept { return written_.load(std::memory_order_relaxed); }
  /// The sets of parameters, of those applied in this run, that are on the disk.
  [[nodiscard]] std::uint64_t saved_commits() const noexcept { return saved_commits_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t failures() const noexcept { return failures_.load(std::memory_order_relaxed); }
  /// Whether the newest state is not on the disk, because writing it failed.
  [[nodiscard]] bool is_failing() const noexcept { return is_failing_.load(std::memory_order_relaxed); }
  /// Why the newest state is not on the disk; empty where it is, or none was offered. From any thread.
  [[nodiscard]] std::string problem() const;
  /// What somebody can do who reads of it.
  [[nodiscard]] std::string mend() const;
  /// What is to be told of the files beside that.
  [[nodiscard]] Remarks& remarks() noexcept { return remarks_; }
  /// Writes what was offered last, and ends.
  void finish();

 private:
  void write_newest();
  [[nodiscard]] std::string write(const RetainImage& image, const RetainedValues& values);

  RetainFiles* files_;
  std::vector<std::size_t> inputs_;
  RetainImage first_;
  std::atomic<RetainImage*> image_{&first_};  ///< of the program that runs
  std::mutex writing_{};                      ///< held while an image is read; never taken by the cyclic thread
  Recovery start_;
  std::size_t slot_;
  std::uint64_t sequence_;
  std::atomic<std::uint64_t> written_;
  std::atomic<std::uint64_t> failures_{0};
  std::atomic<bool> is_failing_{false};
  std::atomic<std::uint64_t> saved_commits_{0};
  mutable std::mutex mutex_;  ///< never taken by the cyclic thread
  std::string problem_{};
  std::string mend_{};
  Remarks remarks_{};
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace hysteron::runtime
