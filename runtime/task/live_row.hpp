// What the live page sees of a version of the diagram that an online change brought: rows with its own inner signals
// and parameters, beside those of the first version, whose places servers know.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/task/exchange.hpp"
#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

/// One cycle in a row: the points of the first version, a number by input that says whether it is forced, the inner
/// signals of the version, and those of its parameters that the first one has not.
class LiveRow {
 public:
  /// `common`: points and inputs; `parameters`: the version's own, by their places in it.
  LiveRow(std::size_t common, std::size_t inner, std::vector<std::size_t> parameters)
      : common_(common),
        inner_(inner),
        parameters_(std::move(parameters)),
        row_(common + inner + parameters_.size()),
        ring_(row_.size()) {}

  /// By the cyclic thread: `common` as all versions publish it. Allocates nothing.
  void publish(std::uint64_t cycle, std::span<const double> common, const StepProgram& version) noexcept {
    std::ranges::copy(common.first(common_), row_.begin());
    version.inner_values(std::span(row_).subspan(common_, inner_));
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      row_[common_ + inner_ + i] = version.parameter(parameters_[i]);
    }
    ring_.publish(cycle, row_);
  }
  /// From any thread. False where nothing was published yet.
  bool read(std::uint64_t& cycle, std::span<double> row) const noexcept { return ring_.read(cycle, row); }
  [[nodiscard]] std::size_t width() const noexcept { return row_.size(); }

 private:
  std::size_t common_;
  std::size_t inner_;
  std::vector<std::size_t> parameters_;
  std::vector<double> row_;
  SnapshotRing ring_;
};

/// Where a version publishes that is not the first; null of the first.
struct LiveVersion {
  LiveRow* row = nullptr;
  const StepProgram* program = nullptr;
};

/// The version of the diagram that runs, as servers are told of it.
struct RunningVersion {
  const StepProgram& program;
  /// By parameter that any version had: its place in the program. Those of the first version come first.
  std::span<const std::optional<std::size_t>> places{};
  std::span<const ProgramSignal> parameters{};  ///< that any version had
  std::shared_ptr<LiveRow> live{};              ///< where it publishes; none of the first version
  std::uint64_t number = 1;
};

}  // namespace hysteron::runtime
