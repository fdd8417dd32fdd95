// Fits. Ipopt keeps things in places of its own, so one fit runs at a time.
#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>

#include "bindings/c/record.hpp"
#include "tuning/fit_json.hpp"
#include "tuning/output_error.hpp"
#include "tuning/recorded_run.hpp"

struct hysteron_fit {
  std::string json;
  std::string parameters;
};

namespace {

/// Most fits take some thirty iterations; how many are left nobody knows.
constexpr double usual_iterations = 30.0;

std::mutex& one_fit_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

extern "C" {

hysteron_fit* hysteron_tune(const hysteron_diagram* diagram, const hysteron_record* const* records, size_t record_count,
                            const char* options, hysteron_progress progress, void* user, hysteron_messages** messages) {
  hysteron::bindings::Call call(messages);
  return call([&]() -> hysteron_fit* {
    hysteron::bindings::require(diagram, "The diagram");
    hysteron::bindings::Options given(options);
    hysteron::OutputErrorOptions fitting{.starts = static_cast<int>(given.whole("starts", 1, 1000000).value_or(1))};
    given.finish();
    hysteron::Diagnostics diagnostics = diagram->warnings;
    hysteron::refuse_ports_named_as_time(diagnostics);
    const auto measured = hysteron::bindings::in_units_of(*diagram, records, record_count, diagnostics);
    const auto problem = hysteron::output_error_problem(*diagram->compiled, diagram->file, measured);
    if (progress != nullptr) {
      fitting.progress = [&](int start, const hysteron::FitProgress& now) {
        const double within = std::min(0.95, static_cast<double>(now.iteration) / usual_iterations);
        return progress(user, (start + within) / fitting.starts, now.iteration) == 0;
      };
    }
    const std::lock_guard lock(one_fit_at_a_time());
    const hysteron::OutputErrorFit fit = hysteron::fit_output_error(problem, fitting);
    auto result = std::make_unique<hysteron_fit>();
    result->json = hysteron::fit_json(problem, fit).dump(2) + "\n";
    result->parameters = hysteron::parameters::parameter_text(hysteron::tuned_file(diagram->file, problem, fit),
                                                              hysteron::tuned_remarks(problem, fit),
                                                              hysteron::tuned_heading(problem, fit));
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
