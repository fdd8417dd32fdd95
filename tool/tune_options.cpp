#include "tool/tune_options.hpp"

#include <fmt/format.h>

#include <csignal>

#include "support/errors.hpp"
#include "support/overwriting.hpp"
#include "tool/writable.hpp"

namespace hysteron::tool {

namespace {

volatile std::sig_atomic_t interrupts = 0;

}  // namespace

InterruptWatch::InterruptWatch() : before_(std::signal(SIGINT, [](int /*signal*/) { interrupts = 1; })) {
  interrupts = 0;
}

InterruptWatch::~InterruptWatch() {
  (void)std::signal(SIGINT, before_);
}

bool InterruptWatch::interrupted() const {
  return interrupts != 0;
}

void prove_outputs(const TuneOptions& options, const std::vector<std::filesystem::path>& reports) {
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  for (const std::string& log : options.logs) {
    inputs.push_back({.file = log, .named_by = "--log"});
  }
  refuse_to_overwrite({.file = options.output}, inputs);
  refuse_unwritable(options.output);
  if (options.report.empty()) {
    return;
  }
  for (const std::filesystem::path& file : reports) {
    refuse_to_overwrite({.file = file.string(), .mend = "give another folder for --report."}, inputs);
    if (same_file(file.string(), options.output)) {
      throw InputError(error::overwrites_input, {.file = file.string()},
                       fmt::format("--out and --report would both write {}.", options.output),
                       "give another name for --out, or another folder for --report.");
    }
  }
  const std::filesystem::path report = std::filesystem::absolute(options.report).lexically_normal();
  for (std::filesystem::path folder = report; folder.has_relative_path(); folder = folder.parent_path()) {
    if (same_file(folder.string(), options.output)) {
      throw InputError(error::overwrites_input, {.file = options.output},
                       fmt::format("--out would write the file {} where --report needs a folder.", options.output),
                       "give another name for --out, or another folder for --report.");
    }
  }
  refuse_unwritable_folder(options.report);
}

}  // namespace hysteron::tool
