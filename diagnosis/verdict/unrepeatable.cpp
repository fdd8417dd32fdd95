#include "diagnosis/verdict/unrepeatable.hpp"

#include <utility>

#include "diagnosis/verdict/hidden_by_steps.hpp"
#include "diagnosis/verdict/uneven_steps.hpp"
#include "diagnosis/verdict/varying_delay.hpp"

namespace hysteron::diagnosis {

std::optional<Unrepeatable> unrepeatable(const Task& task, const std::string& top, const Search& search,
                                         double floor_cost, const SearchOptions& options,
                                         const Materiality& materiality, Budget& budget, Judgement& judgement) {
  std::optional<Unrepeatable> found = with_uneven_steps(task, search, floor_cost, judgement);
  if (!found) {
    budget.at_least(0.2);  // what hides beside a delay takes a search of its own
    found = with_varying_delay(task, top, search, floor_cost, options, judgement);
  }
  if (!materiality.is_left(found ? found->residuals : judgement.chosen->fit.residuals)) {
    return found;
  }
  std::optional<Unrepeatable> hidden = hidden_by_steps(task, search.calibrated, *judgement.chosen);
  if (!hidden || (found && found->residuals.squaredNorm() < hidden->residuals.squaredNorm())) {
    return found;
  }
  if (found) {
    hidden->set = std::move(found->set);  // the chosen one, which it keeps
    hidden->remark = found->remark + " " + hidden->remark;
  }
  return hidden;
}

}  // namespace hysteron::diagnosis
