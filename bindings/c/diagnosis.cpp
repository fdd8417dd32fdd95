// The diagnosis behind its handle: the files that `hysteron diagnose` writes, by their names.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <thread>

#include "bindings/c/record.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/effects/known_effects.hpp"
#include "diagnosis/model/ignored_columns.hpp"
#include "diagnosis/model/limits.hpp"
#include "diagnosis/report/diagnosis_files.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "tuning/recorded_run.hpp"

struct hysteron_diagnosis {
  struct File {
    std::string name;
    std::string contents;
  };
  std::vector<File> files;
};

namespace hysteron::bindings {
namespace {

double above_zero(Options& options, std::string_view key, double otherwise, bool zero_too) {
  const double value = options.number(key).value_or(otherwise);
  if (!(value > 0.0) && !(zero_too && value == 0.0)) {
    throw InputError(error::bad_usage, {}, fmt::format("The option {} is {}.", key, number_text(value)),
                     zero_too ? "give a number from 0 on." : "give a number above 0.");
  }
  return value;
}

struct Asked {
  diagnosis::DiagnosisOptions diagnosis{};
  std::vector<std::string> ignored{};
};

Asked asked(Options& options, const Program& program) {
  Asked result;
  diagnosis::DiagnosisOptions& how = result.diagnosis;
  how.material = above_zero(options, "material", how.material, true);
  how.effects = options.texts("effects");
  how.most_effects = static_cast<int>(options.whole("most", 1, 4).value_or(how.most_effects));
  how.effort = above_zero(options, "effort", how.effort, false);
  how.time_limit = above_zero(options, "time_limit", how.time_limit, false);
  constexpr long long largest_whole = 1LL << std::numeric_limits<double>::digits;
  how.seed = static_cast<std::uint64_t>(options.whole("seed", 0, largest_whole).value_or(1));
  how.explain = options.flag("explain");
  how.without = options.texts("without");
  how.threads = static_cast<unsigned>(
      options.whole("threads", 1, 4096).value_or(std::max(1U, std::thread::hardware_concurrency())));
  std::vector<std::string> limits;
  for (const auto& [name, value] : options.members("limits")) {
    limits.push_back(fmt::format("{}={}", name, value.is_number() ? number_text(value.get<double>()) : value.dump()));
  }
  how.limits = diagnosis::read_limits(program.graph, limits);
  result.ignored = options.texts("ignore");
  options.finish();
  diagnosis::refuse_undiagnosable(how.effects, program);
  return result;
}

}  // namespace
}  // namespace hysteron::bindings

extern "C" {

hysteron_diagnosis* hysteron_diagnose(const hysteron_diagram* diagram, const hysteron_record* const* records,
                                      size_t record_count, const char* options, hysteron_messages** messages) {
  hysteron::bindings::Call call(messages);
  return call([&]() -> hysteron_diagnosis* {
    hysteron::bindings::require(diagram, "The diagram");
    hysteron::bindings::Options given(options);
    const auto asked = hysteron::bindings::asked(given, *diagram->compiled);
    hysteron::Diagnostics diagnostics = diagram->warnings;
    hysteron::diagnosis::DiagnosisInput input{
        .program = *diagram->compiled,
        .text = *diagram->compiled->graph.source->text,
        .file = diagram->file,
        .records = hysteron::bindings::in_units_of(*diagram, records, record_count, false, diagnostics, call)};
    for (const std::string& column : asked.ignored) {
      input.file.diagnose.ignore.push_back({.text = column, .place = {}});
    }
    hysteron::diagnosis::ignore_columns(input);
    const auto found = hysteron::diagnosis::diagnose(input, asked.diagnosis);
    auto result = std::make_unique<hysteron_diagnosis>();
    for (auto& file : hysteron::diagnosis::diagnosis_files({}, found)) {
      result->files.push_back({file.path.filename().string(), std::move(file.contents)});
    }
    call.warn(diagnostics);
    return result.release();
  });
}

const char* hysteron_diagnosis_verdict(const hysteron_diagnosis* diagnosis) {
  return hysteron_diagnosis_file(diagnosis, "verdict.json");
}

const char* hysteron_diagnosis_file(const hysteron_diagnosis* diagnosis, const char* name) {
  if (diagnosis == nullptr || name == nullptr) {
    return nullptr;
  }
  const auto found = std::ranges::find(diagnosis->files, std::string_view(name), &hysteron_diagnosis::File::name);
  return found == diagnosis->files.end() ? nullptr : found->contents.c_str();
}

size_t hysteron_diagnosis_file_count(const hysteron_diagnosis* diagnosis) {
  return diagnosis != nullptr ? diagnosis->files.size() : 0;
}

const char* hysteron_diagnosis_file_name(const hysteron_diagnosis* diagnosis, size_t index) {
  return index < hysteron_diagnosis_file_count(diagnosis) ? diagnosis->files[index].name.c_str() : nullptr;
}

void hysteron_diagnosis_free(hysteron_diagnosis* diagnosis) {
  delete diagnosis;
}

}  // extern "C"
