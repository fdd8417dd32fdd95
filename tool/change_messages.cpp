#include "tool/change_messages.hpp"

#include <string>
#include <utility>

#include "support/json_number.hpp"

namespace hysteron::tool {
namespace {

Place place_of(const Json& json) {
  return {.file = json.at("file"),
          .line = json.value("line", 0U),
          .column = json.value("column", 0U),
          .length = json.value("length", 1U)};
}

/// What no restart moves has null there.
Json registers_json(const std::vector<runtime::PointRegister>& registers) {
  Json list = Json::array();
  for (const runtime::PointRegister& one : registers) {
    list.push_back({{"name", one.name},
                    {"address", one.address},
                    {"after_restart", one.after_restart.empty() ? Json() : Json(one.after_restart)}});
  }
  return list;
}

}  // namespace

Json as_json(const runtime::ChangeReport& report) {
  Json outputs = Json::array();
  for (const runtime::OutputChange& one : report.outputs) {
    outputs.push_back({{"name", one.name},
                       {"unit", one.unit},
                       {"before", number_or_null<Json>(one.bump.before)},
                       {"after", number_or_null<Json>(one.bump.after)},
                       {"bump", one.bump.size},
                       {"limit", one.limit},
                       {"limit_from", one.origin}});
  }
  return {{"program", report.program},
          {"version", report.version},
          {"changed", report.is_done},
          {"outputs", outputs},
          {"parameters", report.parameters},
          {"parameters_carried", report.parameters_carried},
          {"states", report.states},
          {"states_carried", report.states_carried},
          {"left", report.left},
          {"other_values", report.other_values},
          {"registers", registers_json(report.registers.added)},
          {"without_register", report.registers.without},
          {"registers_until_restart", registers_json(report.registers.until_restart)},
          {"as_before", report.as_before},
          {"step_time_ns", report.step_time},
          {"steps_tried", report.rehearsed},
          {"load", report.load},
          {"load_limit", report.most_load},
          {"retained", report.is_retained}};
}

Diagnostics diagnostics_of(const Json& json) {
  Diagnostics diagnostics;
  for (const Json& one : json) {
    Diagnostic diagnostic{.number = std::stoi(one.at("number").get<std::string>().substr(2)),
                          .severity = one.at("severity") == "error" ? Severity::Error : Severity::Warning,
                          .place = place_of(one),
                          .cause = one.at("cause"),
                          .mend = one.at("mend")};
    for (const Json& note : one.at("notes")) {
      diagnostic.notes.push_back({.place = place_of(note), .text = note.at("text")});
    }
    diagnostics.add(std::move(diagnostic));
  }
  return diagnostics;
}

Json as_json(const std::vector<OutputFile>& files) {
  Json list = Json::array();
  for (const OutputFile& one : files) {
    list.push_back({{"path", one.path.string()}, {"contents", one.contents}});
  }
  return list;
}

std::vector<OutputFile> files_of(const Json& json) {
  std::vector<OutputFile> files;
  for (const Json& one : json) {
    files.push_back({.path = one.at("path").get<std::string>(), .contents = one.at("contents")});
  }
  return files;
}

}  // namespace hysteron::tool
