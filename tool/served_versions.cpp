#include "tool/served_versions.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "support/errors.hpp"
#include "support/render.hpp"
#include "support/text_file.hpp"
#include "tool/change_messages.hpp"
#include "tool/inner_signals.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {
namespace {

std::vector<OutputFile> files_of(const DiagramOptions& options) {
  std::vector<OutputFile> files;
  for (const InputFile& one : inputs_of(options)) {
    if (!one.file.empty()) {
      files.push_back({.path = std::filesystem::absolute(one.file), .contents = read_text_file(one.file)});
    }
  }
  return files;
}

bool are_same_files(const std::vector<OutputFile>& a, const std::vector<OutputFile>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const OutputFile& one, const OutputFile& other) {
    return one.path == other.path && one.contents == other.contents;
  });
}

}  // namespace

LoadedVersion load_version(const DiagramOptions& options, Diagnostics& warnings) {
  auto files = files_of(options);
  Program diagram = load_diagram(options, warnings);
  if (!are_same_files(files, files_of(options))) {
    throw InputError(error::online_change_not_now, {.file = options.file},
                     "The diagram or its parameters were written while they were read.",
                     "ask again once they are whole.");
  }
  return {.diagram = std::move(diagram), .files = std::move(files)};
}

ServedVersions::NextVersion ServedVersions::next_version(const runtime::OnlineChange& change,
                                                         const runtime::ChangeWish& wish, Diagnostics& warnings) const {
  try {
    LoadedVersion loaded = load_version(options_, warnings);
    const auto inner = shows_inner_ ? inner_signals(loaded.diagram) : std::vector<InnerSignal>();
    return {.program = step_program(loaded.diagram, engine_, options_.float32, inner),
            .files = std::move(loaded.files)};
  } catch (const InputError& refused) {
    if (!wish.only_check) {
      change.tell_refused(refused);
    }
    throw;
  }
}

std::string ServedVersions::answer(runtime::OnlineChange& change, const std::string& request) {
  Json answer = Json::object();
  Diagnostics warnings;
  try {
    const Json asked = Json::parse(request);
    const std::string what = asked.at("what");
    const runtime::ChangeWish wish{.only_check = what == "check" || what == "check-back",
                                   .bumps = asked.at("bumps"),
                                   .as_given = asked.at("as_given")};
    if (what == "files") {
      answer["files"] = as_json(former_);
    } else if (what == "back" || what == "check-back") {
      answer["report"] = as_json(change.change_back(wish));
      if (!wish.only_check) {
        std::swap(running_, former_);
      }
    } else {
      NextVersion next = next_version(change, wish, warnings);
      answer["report"] = as_json(change.change_to(std::move(next.program), wish));
      if (!wish.only_check) {
        former_ = std::exchange(running_, std::move(next.files));
      }
    }
    answer["warnings"] = as_json(warnings);
  } catch (const InputError& refused) {
    Diagnostics all = warnings;
    for (const Diagnostic& one : refused.diagnostics().all()) {
      all.add(one);
    }
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
