// The program of a task whose diagram may change while it runs: one version steps, another takes over between two
// steps, with the states that both have.
//
// A change is planned beside the cycle and proposed whole. In the cycle that takes it up, both versions step from the
// same states on the same inputs. Where no output differs by more than its limit, the new version counts, and what it
// gave is what the task writes; else the old one goes on, as if nothing had been. That costs the cycle one more step
// and the copy of a state; nothing is allocated.
//
// Inputs, outputs, parameters and the inner signals keep their places: those of the first version. Parameters that come
// with a later one get further places, which no other parameter is given. A parameter that the running version has not
// does nothing.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "runtime/task/carry.hpp"
#include "runtime/task/live_row.hpp"
#include "runtime/task/retain.hpp"
#include "runtime/task/sound_state.hpp"
#include "runtime/task/step_program.hpp"
#include "runtime/task/trace.hpp"

namespace hysteron::runtime {

/// One version of the diagram, and how it stands behind the places of the first.
class ProgramVersion {
 public:
  /// The program as it is to begin. `first`: the shape of the first version; its own, where this is the first.
  /// `parameters`: those that any version before had.
  ProgramVersion(std::unique_ptr<StepProgram> program, const ProgramShape& first,
                 std::span<const ProgramSignal> parameters);

  [[nodiscard]] StepProgram& program() noexcept { return *program_; }
  [[nodiscard]] const StepProgram& program() const noexcept { return *program_; }
  /// By parameter that this version or any before it had: its place here.
  [[nodiscard]] std::span<const std::optional<std::size_t>> parameters() const noexcept { return parameters_; }
  [[nodiscard]] std::span<const std::optional<std::size_t>> inner() const noexcept { return inner_; }
  /// The inner signals of the newest step.
  [[nodiscard]] std::span<const double> inner_values() noexcept {
    program_->inner_values(inner_values_);
    return inner_values_;
  }
  /// Where its states are retained, its trace is begun and its sound state is kept. Made when it takes over for the
  /// first time; of the first version, the task has its own.
  std::unique_ptr<RetainImage> retained{};
  std::unique_ptr<TraceProgram> traced{};
  std::unique_ptr<SoundState> sound{};
  /// Where the live page sees it; null of the first version.
  std::shared_ptr<LiveRow> live{};

 private:
  std::unique_ptr<StepProgram> program_;
  std::vector<std::optional<std::size_t>> parameters_{};
  std::vector<std::optional<std::size_t>> inner_{};
  std::vector<double> inner_values_;
};

/// By how much an output may jump where the version changes. Values are looked at as the task limits them.
struct BumpLimit {
  double most = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// What one output does at a change.
struct Bump {
  double before = 0.0;  ///< as the old version gives it
  double after = 0.0;   ///< as the new version does in the same step
  double size = 0.0;    ///< their difference, as limited; 0 where the old one is no number
  [[nodiscard]] bool is_within(const BumpLimit& limit) const noexcept;
};
[[nodiscard]] Bump bump_of(double before, double after, const BumpLimit& limit) noexcept;

/// What the running version was when one of its steps began, and what that step gave.
struct StepImage {
  std::vector<double> parameters{};  ///< of the version
  std::vector<std::byte> state{};    ///< before the step
  std::vector<double> inputs{};
  std::vector<double> outputs{};
};

enum class ChangeVerdict : std::uint8_t {
  pending,
  taken,
  bump,          ///< an output would have jumped; the old version goes on
  other_values,  ///< parameters are not those that the change was planned with; the old version goes on
};

/// A change as it is proposed. The program to come has the parameters that it will have.
struct ProposedChange {
  ProgramVersion* to = nullptr;
  std::vector<double> parameters{};    ///< of the running version, when it was planned
  std::vector<SharedNumber> shared{};  ///< from its state
  std::vector<std::byte> from{};       ///< as large as its state
  std::vector<std::byte> start{};      ///< the state of the new version, where it is not shared
  std::vector<std::byte> into{};       ///< as large; after the change, what the new version's first step began with
  std::vector<double> outputs{};       ///< as many as there are
  std::vector<BumpLimit> limits{};     ///< by output
  std::vector<Bump> bumps{};           ///< by output; of the step in which it was taken up, up to the first too large
  ChangeVerdict verdict = ChangeVerdict::pending;
  std::size_t too_large = 0;  ///< the output whose bump is
};

/// Of the last change, as task.online_change says it.
enum class ChangeOutcome : std::uint8_t { none, changed, refused, back };

class ChangeableProgram final : public StepProgram {
 public:
  explicit ChangeableProgram(std::unique_ptr<StepProgram> first);

  // As the first version; state and size are those of the version that runs.
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override { running_->program().reset(); }
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override;
  void inner_values(std::span<double> into) const noexcept override;
  void set_parameter(std::size_t parameter, double value) noexcept override;
  [[nodiscard]] double parameter(std::size_t parameter) const noexcept override;
  [[nodiscard]] std::size_t state_size() const noexcept override { return running_->program().state_size(); }
  void save(std::span<std::byte> bytes) const noexcept override { running_->program().save(bytes); }
  void restore(std::span<const std::byte> bytes) noexcept override { running_->program().restore(bytes); }

  // For the cyclic thread:
  /// The change that the step just made took up; null where it took none. It stays whole until conclude().
  [[nodiscard]] ProposedChange* taken() noexcept { return std::exchange(taken_, nullptr); }
  /// Once all has followed the change that was taken up.
  void conclude() noexcept { change_.store(Ask::done, std::memory_order_release); }
  /// The version that runs.
  [[nodiscard]] ProgramVersion& running() noexcept { return *running_; }
  [[nodiscard]] LiveVersion live() const noexcept { return {running_->live.get(), &running_->program()}; }

  // For one thread beside it:
  /// The version that runs, as far as this thread has brought it about.
  [[nodiscard]] ProgramVersion& version() noexcept { return *owned_.front(); }
  /// The parameters that any version had, by their places.
  [[nodiscard]] std::span<const ProgramSignal> parameters() const noexcept { return parameters_; }
  /// That before it; null where there is none.
  [[nodiscard]] ProgramVersion* former() noexcept { return owned_.size() > 1 ? owned_.back().get() : nullptr; }
  /// Asks for an image of the next step; into buffers of the right sizes.
  void ask_for_image(StepImage& into) noexcept;
  /// Whether it is there.
  [[nodiscard]] bool has_image() noexcept { return image_.load(std::memory_order_acquire) == Ask::done; }
  /// The image is no longer wanted; false where it is being taken just now.
  [[nodiscard]] bool withdraw_image() noexcept;
  /// From now on a step takes it up, once all orders of before have reached the program: not the next, but the one
  /// after it.
  void propose(ProposedChange& change) noexcept;
  [[nodiscard]] bool is_decided() noexcept { return change_.load(std::memory_order_acquire) == Ask::done; }
  /// The change is not wanted any more; false where it is decided, or is being so.
  [[nodiscard]] bool withdraw() noexcept;
  /// Once a change to a version is taken: it is that which runs, and the one before is kept. Gives back what was kept.
  std::unique_ptr<ProgramVersion> keep(std::unique_ptr<ProgramVersion> taken);
  /// The same of a change back to the former.
  void keep_former() noexcept { std::swap(owned_.front(), owned_.back()); }

  void tell(ChangeOutcome outcome) noexcept { outcome_.store(outcome, std::memory_order_relaxed); }

  // From any thread:
  [[nodiscard]] ChangeOutcome outcome() const noexcept { return outcome_.load(std::memory_order_relaxed); }
  /// 1, and one more with each change.
  [[nodiscard]] std::uint64_t version_number() const noexcept { return number_.load(std::memory_order_relaxed); }

 private:
  enum class Ask : std::uint8_t { none, asked, seen, at_work, done };

  bool try_change(std::span<const double> inputs, std::span<double> outputs) noexcept;
  void plain_step(std::span<const double> inputs, std::span<double> outputs) noexcept;

  ProgramShape shape_;
  std::vector<ProgramSignal> parameters_;                 ///< of the thread beside
  std::vector<std::unique_ptr<ProgramVersion>> owned_{};  ///< of the thread beside: the running one, the former
  ProgramVersion* running_;                               ///< of the cyclic thread
  std::vector<double> values_;                            ///< of parameters, as they were last set or read
  ProposedChange* taken_ = nullptr;
  ProposedChange* proposed_ = nullptr;
  StepImage* wanted_ = nullptr;
  std::atomic<Ask> change_{Ask::none};
  std::atomic<Ask> image_{Ask::none};
  std::atomic<std::uint64_t> number_{1};
  std::atomic<ChangeOutcome> outcome_{ChangeOutcome::none};
};

}  // namespace hysteron::runtime
