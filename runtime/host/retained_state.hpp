// What a run goes on from: the retained values of its folder, taken into the program before it starts.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/task/carry.hpp"
#include "runtime/task/retain.hpp"
#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

class RetainedState {
 public:
  /// Takes parameters and state into the program, which is as after its reset; changes nothing in the folder. `inputs`:
  /// those that clients write and that are retained. Throws
  /// InputError HY811 where what is there is of no use, HY815 where another task holds the folder, HY816 where it
  /// cannot be used.
  RetainedState(const RetainConfig& config, StepProgram& program, std::vector<std::size_t> inputs = {});

  /// The inputs that are retained, as it was told.
  [[nodiscard]] const std::vector<std::size_t>& inputs() const { return inputs_; }
  /// By input of the program: what it goes on from; nothing where it begins as the diagram says.
  [[nodiscard]] const std::vector<std::optional<double>>& starts() const { return starts_; }

  /// For the status line, beginning with a comma: what the program goes on from, and the parameters that are retained
  /// and not as they were given. Empty at a first start.
  [[nodiscard]] const std::string& told() const { return told_; }
  /// What was retained by another version of the diagram and is not taken over, each with its reason.
  [[nodiscard]] const std::vector<std::string>& left() const { return left_; }
  /// What was retained and is lost, for standard error; empty where nothing is.
  [[nodiscard]] std::string loss() const;
  [[nodiscard]] const std::vector<std::byte>& after_reset() const { return after_reset_; }
  /// Before anything is written: files that do not fit and are not wanted are renamed, those carried over are copied.
  /// What cannot be yet is left to the Retainer.
  void put_aside();
  [[nodiscard]] RetainFolder& folder() { return folder_; }
  [[nodiscard]] const Recovery& recovery() const { return recovery_; }

 private:
  void take(StepProgram& program, std::span<const double> given);
  /// For the status line: the parameters that are retained and not as they were given; empty where there are none.
  [[nodiscard]] std::string not_as_given(const StepProgram& program, std::span<const double> given) const;
  void carry(StepProgram& program, std::span<const double> given, const KeptLayout& kept);

  RetainConfig config_;
  RetainFolder folder_;
  Recovery recovery_{};
  std::string told_{};
  std::vector<std::string> left_{};
  std::vector<std::size_t> inputs_;
  std::vector<std::optional<double>> starts_{};
  std::vector<std::byte> after_reset_{};
};

}  // namespace hysteron::runtime
