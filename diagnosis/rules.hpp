// The rules of a diagnosis at work: each asks a threshold of the policy, and what it answered is kept.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/policy.hpp"

namespace hysteron::diagnosis {

/// One answer of a rule, for whoever wants to know why a verdict is what it is.
struct Decision {
  std::string rule{};
  std::string about{};     ///< of what: a family, a record; empty where there is but one
  double measured = 0.0;   ///< in the unit of the threshold
  double threshold = 0.0;  ///< as it was in force
  std::string unit{};
  std::string outcome{};  ///< what followed
};

class Rules {
 public:
  Rules() = default;
  /// Without the rules of these names, as policy.hpp has them; "-" and "_" stand for a space, too.
  /// @throws InputError for a name that is no rule, with those that are.
  explicit Rules(const std::vector<std::string>& without);

  /// The threshold in force: that of the policy, or the one at which the rule changes nothing.
  [[nodiscard]] double operator[](const Threshold& threshold) const;

  /// Whether something measured lies above the threshold in force; and keeps the answer.
  bool is_above(const Threshold& threshold, double measured, std::string_view about = {});

  /// A confidence that is no higher than the threshold in force; keeps it where that holds it down.
  double capped(const Threshold& threshold, double confidence, std::string_view about = {});

  /// In the order in which they were asked.
  [[nodiscard]] const std::vector<Decision>& decisions() const { return decisions_; }

 private:
  std::vector<std::string_view> without_{};  ///< names of the policy
  std::vector<Decision> decisions_{};
};

}  // namespace hysteron::diagnosis
