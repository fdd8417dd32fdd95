// Fits, and loops tuned for a goal. Ipopt keeps things in places of its own, so one of them runs at a time.
#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>

#include "bindings/c/record.hpp"
#include "support/errors.hpp"
#include "tuning/fit_json.hpp"
#include "tuning/goal/contradiction.hpp"
#include "tuning/goal/goal_json.hpp"
#include "tuning/goal/goal_search.hpp"
#include "tuning/output_error.hpp"

struct hysteron_fit {
  std::string json;
  std::string parameters;
};

namespace {

/// Most fits take some thirty iterations, most goals some fifty; how many are left nobody knows.
constexpr double usual_iterations = 30.0;
constexpr double usual_iterations_of_goal = 50.0;

std::mutex& one_fit_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

/// Tells how far the work is; false where the user ends it.
class Told {
 public:
  Told(hysteron_progress progress, void* user, int starts) : progress_(progress), user_(user), starts_(starts) {}

  [[nodiscard]] bool goes_on(int start, int iteration, double usual) const {
    const double within = std::min(0.95, static_cast<double>(iteration) / usual);
    return progress_ == nullptr || progress_(user_, (start + within) / starts_, iteration) == 0;
  }

 private:
  hysteron_progress progress_;
  void* user_;
  int starts_;
};

std::unique_ptr<hysteron_fit> tuned_to_records(const hysteron_diagram& diagram,
                                               const std::vector<hysteron::records::Record>& measured, int starts,
                                               const Told& told) {
  const auto problem = hysteron::output_error_problem(*diagram.compiled, diagram.file, measured);
  const hysteron::OutputErrorOptions fitting{.starts = starts,
                                             .progress = [&](int start, const hysteron::FitProgress& now) {
                                               return told.goes_on(start, now.iteration, usual_iterations);
                                             }};
  const std::lock_guard lock(one_fit_at_a_time());
  const hysteron::OutputErrorFit fit = hysteron::fit_output_error(problem, fitting);
  auto result = std::make_unique<hysteron_fit>();
  result->json = hysteron::fit_json(problem, fit).dump(2) + "\n";
  result->parameters = hysteron::parameters::parameter_text(hysteron::tuned_file(diagram.file, problem, fit),
                                                            hysteron::tuned_remarks(problem, fit),
                                                            hysteron::tuned_heading(problem, fit));
  return result;
}

std::unique_ptr<hysteron_fit> tuned_for_goal(const hysteron_diagram& diagram,
                                             const std::vector<hysteron::records::Record>& records, int starts,
                                             const Told& told, hysteron::Diagnostics& diagnostics,
                                             hysteron::bindings::Call& call) {
  const auto problem = hysteron::goal_problem(*diagram.compiled, diagram.file, records);
  diagnostics.add_all(problem.found);
  call.note(records.empty() ? std::string() : records.front().file(), problem.notes);
  const hysteron::GoalOptions tuning{.starts = starts, .progress = [&](const hysteron::GoalProgress& now) {
                                       return told.goes_on(now.start, now.iteration, usual_iterations_of_goal);
                                     }};
  const std::lock_guard lock(one_fit_at_a_time());
  const hysteron::GoalResult tuned = hysteron::tune_for_goal(problem, tuning);
  if (tuned.status == hysteron::GoalStatus::Contradiction) {
    hysteron::report_contradiction(problem, tuned, diagnostics);
  }
  auto result = std::make_unique<hysteron_fit>();
  result->json = hysteron::goal_json(problem, tuned).dump(2) + "\n";
  result->parameters =
      hysteron::parameters::parameter_text(hysteron::tuned_file(diagram.file, problem, tuned),
                                           hysteron::tuned_remarks(problem), hysteron::tuned_heading(problem, tuned));
  return result;
}

}  // namespace

extern "C" {

hysteron_fit* hysteron_tune(const hysteron_diagram* diagram, const hysteron_record* const* records, size_t record_count,
                            const char* options, hysteron_progress progress, void* user, hysteron_messages** messages) {
  hysteron::bindings::Call call(messages);
  return call([&]() -> hysteron_fit* {
    hysteron::bindings::require(diagram, "The diagram");
    hysteron::bindings::Options given(options);
    const auto starts = static_cast<int>(given.whole("starts", 1, 1000000).value_or(1));
    given.finish();
    const bool has_goal = diagram->file.goal.is_given();
    if (record_count == 0 && !has_goal) {
      throw hysteron::InputError(hysteron::error::bad_usage, {.file = diagram->file.file},
                                 "There is nothing to tune for: no record is given, and the parameters have no [goal].",
                                 "give a measured record to fit it, or a [goal] for a control loop.");
    }
    hysteron::Diagnostics diagnostics = diagram->warnings;
    const auto measured =
        record_count == 0 ? std::vector<hysteron::records::Record>()
                          : hysteron::bindings::in_units_of(*diagram, records, record_count, true, diagnostics, call);
    const Told told(progress, user, starts);
    auto result = has_goal ? tuned_for_goal(*diagram, measured, starts, told, diagnostics, call)
                           : tuned_to_records(*diagram, measured, starts, told);
    call.warn(diagnostics);
    return result.release();
  });
}

const char* hysteron_fit_json(const hysteron_fit* fit) {
  return fit != nullptr ? fit->json.c_str() : nullptr;
}

const char* hysteron_fit_parameters(const hysteron_fit* fit) {
  return fit != nullptr ? fit->parameters.c_str() : nullptr;
}

void hysteron_fit_free(hysteron_fit* fit) {
  delete fit;
}

}  // extern "C"
