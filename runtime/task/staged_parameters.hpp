// Parameters on their way into a running task: staged one by one, checked as a set, applied between two steps or not at
// all.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

/// Equal, or both no number: a limit that is off is none, and may stay so.
[[nodiscard]] inline bool is_same_value(double a, double b) noexcept {
  return a == b || (std::isnan(a) && std::isnan(b));
}

class StagedParameters {
 public:
  /// The shape must outlive it.
  StagedParameters(const ProgramShape& shape, std::vector<double> values);

  /// Nothing is checked but that the number is one: a set may be out of range while it is being entered.
  void stage(std::size_t parameter, double value);
  void discard();
  /// Another set counts, which did not come from here. What waits for a commit goes on waiting.
  void follow(const std::vector<double>& committed);
  /// The set becomes what counts, whole; or, where anything is refused, nothing changes and the reason is given. What
  /// was staged stays staged then, to be mended. What stays as it is in the program is not judged.
  [[nodiscard]] std::string commit();

  /// Whether another value waits for a commit.
  [[nodiscard]] bool is_staged(std::size_t parameter) const {
    return !is_same_value(staged_[parameter], committed_[parameter]);
  }
  [[nodiscard]] bool any_staged() const { return staged_ != committed_; }
  [[nodiscard]] const std::vector<double>& staged() const { return staged_; }
  [[nodiscard]] const std::vector<double>& committed() const { return committed_; }

 private:
  const ProgramShape* shape_;
  std::vector<double> committed_;
  std::vector<double> staged_;
};

/// Why a type does not hold a value, as a sentence that begins with the name; empty where it does.
[[nodiscard]] std::string refusal_by_type(const std::string& name, PointType type, double value);
/// Why a signal cannot take a value, as a sentence that names it; empty where it can.
[[nodiscard]] std::string refusal_of(const ProgramSignal& signal, double value);
/// Why a program cannot take new values in the place of those that it has; empty where it can. What does not change is
/// not judged, nor are relations in which nothing changes.
[[nodiscard]] std::string refusal_of(const ProgramShape& shape, std::span<const double> values,
                                     std::span<const double> has);

}  // namespace hysteron::runtime
