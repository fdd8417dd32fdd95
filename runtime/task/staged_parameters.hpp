// Parameters on their way into a running task: staged one by one, checked as a set, applied between two steps or not at
// all.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

/// Why a set of parameters cannot be; empty where it can. For what no single range says: an order, a sum.
using SetCheck = std::function<std::string(std::span<const double>)>;

class StagedParameters {
 public:
  StagedParameters(std::vector<ProgramSignal> parameters, std::vector<double> values, SetCheck check = {});

  /// Nothing is checked but that the number is one: a set may be out of range while it is being entered.
  void stage(std::size_t parameter, double value);
  void discard();
  /// The set becomes what counts, whole; or, where anything is refused, nothing changes and the reason is given. What
  /// was staged stays staged then, to be mended.
  [[nodiscard]] std::string commit();

  [[nodiscard]] bool any_staged() const { return staged_ != committed_; }
  [[nodiscard]] const std::vector<double>& staged() const { return staged_; }
  [[nodiscard]] const std::vector<double>& committed() const { return committed_; }

 private:
  std::vector<ProgramSignal> parameters_;
  std::vector<double> committed_;
  std::vector<double> staged_;
  SetCheck check_;
};

/// Why a signal cannot take a value, as a sentence that names it; empty where it can.
[[nodiscard]] std::string refusal_of(const ProgramSignal& signal, double value);

}  // namespace hysteron::runtime
