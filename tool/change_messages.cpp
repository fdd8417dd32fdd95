#include "tool/change_messages.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace hysteron::tool {
namespace {

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json place_json(const Place& place) {
  return {{"file", place.file}, {"line", place.line}, {"column", place.column}, {"length", place.length}};
}

Place place_of(const Json& json) {
  return {.file = json.at("file"), .line = json.at("line"), .column = json.at("column"), .length = json.at("length")};
}

}  // namespace

Json as_json(const runtime::ChangeReport& report) {
  Json outputs = Json::array();
  for (const runtime::OutputChange& one : report.outputs) {
    outputs.push_back({{"name", one.name},
                       {"unit", one.unit},
                       {"before", number(one.bump.before)},
                       {"after", number(one.bump.after)},
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
          {"without_register", report.without_register},
          {"step_time_ns", report.step_time},
          {"retained", report.is_retained}};
}

Json as_json(const Diagnostics& diagnostics) {
  Json list = Json::array();
  for (const Diagnostic& one : diagnostics.all()) {
    Json notes = Json::array();
    for (const Note& note : one.notes) {
      notes.push_back({{"place", place_json(note.place)}, {"text", note.text}});
    }
    list.push_back({{"number", one.number},
                    {"is_error", one.severity == Severity::Error},
                    {"place", place_json(one.place)},
                    {"cause", one.cause},
                    {"mend", one.mend},
                    {"notes", notes}});
  }
  return list;
}

Diagnostics diagnostics_of(const Json& json) {
  Diagnostics diagnostics;
  for (const Json& one : json) {
    Diagnostic diagnostic{.number = one.at("number"),
                          .severity = one.at("is_error") ? Severity::Error : Severity::Warning,
                          .place = place_of(one.at("place")),
                          .cause = one.at("cause"),
                          .mend = one.at("mend")};
    for (const Json& note : one.at("notes")) {
      diagnostic.notes.push_back({.place = place_of(note.at("place")), .text = note.at("text")});
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
