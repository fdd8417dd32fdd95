#include "diagnosis/findings/doubts.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "diagnosis/verdict/plausibility.hpp"
#include "diagnosis/verdict/start_state.hpp"

namespace hysteron::diagnosis {
namespace {

using Reasons = std::optional<std::vector<std::string>>;

/// What is named may be bent to by parameters that another cause has moved. Partial and Unknown say already that more
/// is there.
Reasons far_off(const Doubted& doubted) {
  if (doubted.verdict == Verdict::Partial || doubted.verdict == Verdict::Unknown) {
    return std::nullopt;
  }
  std::vector<std::string> far = far_parameters(doubted.task, doubted.kept);
  return far.empty() ? Reasons() : Reasons(std::move(far));
}

/// Each effect shows as one shape of the response then, and many have it.
Reasons one_motion(const Doubted& doubted) {
  return doubted.one_motion ? Reasons(std::in_place) : Reasons();
}

Reasons missed_start(const Doubted& doubted) {
  std::string reason = doubted.is_related ? unexplained_start(doubted.task, doubted.chosen) : std::string();
  return reason.empty() ? Reasons() : Reasons({std::move(reason)});
}

constexpr std::array doubts{
    Doubt{policy::sure_of_far_parameters, far_off},
    Doubt{policy::sure_of_one_motion, one_motion},
    Doubt{policy::sure_of_missed_start, missed_start},
};

}  // namespace

void doubt(const Doubted& doubted, Rules& rules, Diagnosis& result) {
  for (const Doubt& one : doubts) {
    if (Reasons reasons = one.reasons(doubted)) {
      std::ranges::move(*reasons, std::back_inserter(result.warnings));
      result.confidence = rules.capped(one.most, result.confidence);
    }
  }
}

}  // namespace hysteron::diagnosis
