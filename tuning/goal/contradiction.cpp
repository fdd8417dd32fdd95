#include "tuning/goal/contradiction.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "tuning/goal/goal_message.hpp"

namespace hysteron {

void report_contradiction(const GoalProblem& problem, const GoalResult& result, Diagnostics& diagnostics) {
  std::vector<std::string> parts;
  std::vector<Note> notes;
  Place place = problem.settings.place;
  // A limit that is kept at this point stands against nothing there.
  std::vector<LimitResult> broken = result.limits;
  std::erase_if(broken, [](const LimitResult& limit) { return limit.is_kept; });
  std::ranges::stable_sort(broken, std::greater{}, &LimitResult::against);
  for (const LimitResult& limit : broken) {
    const GoalLimit& one = problem.limits[limit.limit];
    place = parts.empty() ? one.place : place;
    const std::string part = fmt::format("{} = {}", text_of(one.kind).key.name, number_text(one.limit));
    if (std::ranges::find(parts, part) == parts.end()) {  // with several plants it is broken more than once
      parts.push_back(part);
    }
    notes.push_back(
        {.place = one.place,
         .text = fmt::format("{} is {:.4g}{}", text_of(one.kind).name, limit.value, problem.with_plant(limit.plant))});
  }
  std::string mend = parts.size() > 1 ? "loosen one of them" : "loosen it";
  bool has_bound = false;
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    if (result.at_bound[j] != AtBound::Free) {
      has_bound = true;
      const FreeParameter& free = problem.parameters[j];
      notes.push_back({.place = free.place,
                       .text = fmt::format("{} is on its {} bound", free.name, bound_name(result.at_bound[j]))});
    }
  }
  mend += has_bound ? ", or widen the bounds" : "";
  const std::string limits = parts.empty()
                                 ? "the limits"
                                 : fmt::format("{}{}", fmt::join(parts, " and "), parts.size() > 1 ? " together" : "");
  if (result.is_held_by_test) {
    std::vector<std::string> values;
    for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
      values.push_back(fmt::format("{} = {:.4g}", problem.parameters[j].name, result.x[static_cast<Eigen::Index>(j)]));
    }
    notes.push_back({.place = problem.settings.place,
                     .text = fmt::format("beside {} the loop {}, {}, and has no value there", fmt::join(values, ", "),
                                         what_it_does(LoopState::TooSlow), length_of_test(problem))});
    diagnostics.error(
        error::limits_contradict, place,
        fmt::format("No controller was found that keeps {} and whose loop settles within the test.", limits),
        fmt::format("let the test last longer than its {}: duration in [goal], or a longer record. "
                    "A slower loop may keep the limits. Else {}.",
                    length_of_test(problem), mend),
        std::move(notes));
    return;
  }
  diagnostics.error(error::limits_contradict, place, fmt::format("No controller was found that keeps {}.", limits),
                    mend + ", free a further parameter of the controller, or search from more points: --start 20.",
                    std::move(notes));
}

}  // namespace hysteron
