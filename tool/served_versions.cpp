#include "tool/served_versions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "codegen/program_hash.hpp"
#include "runtime/config/run_config.hpp"
#include "runtime/host/host.hpp"
#include "runtime/host/notices.hpp"
#include "runtime/host/served_map.hpp"
#include "support/errors.hpp"
#include "support/render.hpp"
#include "support/text_file.hpp"
#include "tool/change_messages.hpp"
#include "tool/inner_signals.hpp"
#include "tool/live_diagram.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {
namespace {

std::vector<OutputFile> files_of(const DiagramOptions& options) {
  std::vector<OutputFile> files;
  for (const InputFile& one : inputs_of(options)) {
    // Only what can be read again, and brought back: a pipe is read once.
    if (std::error_code unknown; std::filesystem::is_regular_file(one.file, unknown)) {
      files.push_back({.path = std::filesystem::absolute(one.file), .contents = read_text_file(one.file)});
    }
  }
  return files;
}

bool are_all_read_again(const DiagramOptions& options) {
  const auto inputs = inputs_of(options);
  return std::ranges::all_of(inputs, [](const InputFile& one) {
    std::error_code unknown;
    return one.file.empty() || std::filesystem::is_regular_file(one.file, unknown);
  });
}

bool are_same_files(const std::vector<OutputFile>& a, const std::vector<OutputFile>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const OutputFile& one, const OutputFile& other) {
    return one.path == other.path && one.contents == other.contents;
  });
}

/// Read until nothing was written meanwhile, or a second has passed. A text that is half written is an error of that
/// moment alone.
LoadedVersion load(const DiagramOptions& options, Diagnostics& warnings) {
  constexpr int most_tries = 10;
  constexpr std::chrono::milliseconds pause{100};
  for (int tries = 1;; ++tries) {
    Diagnostics own;
    auto files = files_of(options);
    try {
      Program diagram = load_diagram(options, own);
      const bool is_steady = are_same_files(files, files_of(options));
      if (is_steady || tries == most_tries) {
        warnings.add_all(own);
        return {.diagram = std::move(diagram), .files = std::move(files), .is_steady = is_steady};
      }
    } catch (const InputError&) {
      if (tries == most_tries || are_same_files(files, files_of(options))) {
        throw;
      }
    }
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace

LoadedVersion load_version(const DiagramOptions& options, Diagnostics& warnings) {
  LoadedVersion loaded = load(options, warnings);
  if (!loaded.is_steady) {
    throw InputError(error::online_change_not_now, {.file = options.file},
                     "The diagram or its parameters were written while they were read.",
                     "ask again once they are whole.");
  }
  return loaded;
}

LoadedVersion first_version(const DiagramOptions& options, Diagnostics& warnings) {
  LoadedVersion loaded = load(options, warnings);
  if (!loaded.is_steady) {
    runtime::tell("Start", fmt::format("{} or its parameters are written again and again; what was read last runs.",
                                       options.file));
  }
  return loaded;
}

ServedVersions::NextVersion ServedVersions::next_version(const runtime::OnlineChange& change,
                                                         const runtime::ChangeWish& wish, Diagnostics& warnings,
                                                         const Progress& progress) const {
  try {
    progress("reads the diagram");
    LoadedVersion loaded = load_version(options_, warnings);
    const auto inner = shows_inner_ ? inner_signals(loaded.diagram) : std::vector<InnerSignal>();
    // Interpreted, it is there at once: what is refused anyway does not wait for a compiler.
    const std::string picture = shows_inner_ ? live_diagram(loaded.diagram.graph, inner) : "";
    auto program = step_program(loaded.diagram, Engine::interpreter, options_.float32, inner, picture);
    change.require_sound(program->shape(), wish);
    require_next_start(*program);
    if (is_asked_for_nothing(loaded, wish)) {
      return {};
    }
    if (engine_ == Engine::compiled) {
      progress("compiles the new version");
      program = step_program(loaded.diagram, engine_, options_.float32, inner, picture);
    }
    progress("steps the new version beside the running one");
    return {.program = std::move(program), .files = std::move(loaded.files), .hash = program_hash(loaded.diagram)};
  } catch (const InputError& refused) {
    if (!wish.only_check) {
      change.tell_refused(refused);
    }
    throw;
  }
}

/// A version that is the running one would take the place of the one before, which is the way back.
bool ServedVersions::is_asked_for_nothing(const LoadedVersion& loaded, const runtime::ChangeWish& wish) const {
  return !wish.only_check && wish.as_given.empty() && are_same_files(loaded.files, running_) &&
         program_hash(loaded.diagram) == running_hash_ && are_all_read_again(options_);
}

void ServedVersions::require_next_start(const runtime::StepProgram& program) const {
  const auto config = runtime::parse_run_config(start_.run_file, read_text_file(start_.run_file), program.shape());
  runtime::refuse_to_overwrite_inputs(config, start_.inputs);
  runtime::check_register_map(config, program);
}

bool ServedVersions::is_run_file_edited() const {
  try {
    return read_text_file(start_.run_file) != start_.text;
  } catch (const InputError&) {
    return true;  // it is gone
  }
}

std::string ServedVersions::answer(runtime::OnlineChange& change, const std::string& request,
                                   const Progress& progress) {
  Json answer = Json::object();
  Diagnostics warnings;
  try {
    const Json asked = Json::parse(request);
    const std::string what = asked.at("what");
    const runtime::ChangeWish wish{
        .only_check = what == "check" || what == "check-back",
        .bumps = asked.at("bumps"),
        .as_given = asked.at("as_given"),
        .load = asked.contains("load") ? std::optional(asked.at("load").get<double>()) : std::nullopt};
    if (what == "files") {
      answer["files"] = as_json(former_);
    } else if (what == "back" || what == "check-back") {
      answer["report"] = as_json(change.change_back(wish));
      if (!wish.only_check) {
        std::swap(running_, former_);
        std::swap(running_hash_, former_hash_);
      }
    } else {
      NextVersion next = next_version(change, wish, warnings, progress);
      const bool is_same = next.program == nullptr;
      answer["report"] =
          as_json(is_same ? change.nothing_to_change() : change.change_to(std::move(next.program), wish));
      if (!wish.only_check && !is_same) {
        former_ = std::exchange(running_, std::move(next.files));
        former_hash_ = std::exchange(running_hash_, std::move(next.hash));
      }
    }
    if (answer.contains("report")) {
      answer["report"]["run_file_edited"] = is_run_file_edited();
      answer["report"]["way_back"] = !former_.empty();
    }
    answer["warnings"] = as_json(warnings);
  } catch (const InputError& refused) {
    Diagnostics all = warnings;
    all.add_all(refused.diagnostics());
    answer["errors"] = as_json(all);
  } catch (const std::exception& fault) {
    Diagnostics other;
    other.error(error::no_online_change, {}, std::string("The request is not understood: ") + fault.what() + ".",
                "give the command `hysteron online-change` of the same version as the task.");
    answer["errors"] = as_json(other);
  }
  return answer.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace hysteron::tool
