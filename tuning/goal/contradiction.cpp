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
    const std::string plant = problem.plants.size() > 1 ? " with " + problem.plants[limit.plant].name : std::string();
    place = parts.empty() ? one.place : place;
    const std::string part = fmt::format("{} = {}", text_of(one.kind).key.name, number_text(one.limit));
    if (std::ranges::find(parts, part) == parts.end()) {  // with several plants it is broken more than once
      parts.push_back(part);
    }
    notes.push_back(
        {.place = one.place, .text = fmt::format("{} is {:.4g}{}", text_of(one.kind).name, limit.value, plant)});
  }
  std::string mend = parts.size() > 1 ? "loosen one of them" : "loosen it";
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    if (result.at_bound[j] != AtBound::Free) {
      const FreeParameter& free = problem.parameters[j];
      notes.push_back({.place = free.place,
                       .text = fmt::format("{} is on its {} bound", free.name, bound_name(result.at_bound[j]))});
      mend = parts.size() > 1 ? "loosen one of them, or widen the bounds" : "loosen it, or widen the bounds";
    }
  }
  diagnostics.error(
      error::limits_contradict, place,
      parts.size() > 1 ? fmt::format("No controller was found that keeps {} together.", fmt::join(parts, " and "))
                       : fmt::format("No controller was found that keeps {}.", parts.empty() ? "the limits" : parts[0]),
      mend + ", free a further parameter of the controller, or search from more points: --start 20.", std::move(notes));
}

}  // namespace hysteron
