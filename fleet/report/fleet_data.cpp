#include "fleet/report/fleet_data.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fleet/report/words.hpp"
#include "fleet/when.hpp"
#include "support/csv_cell.hpp"
#include "support/json_number.hpp"

namespace hysteron::fleet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 3> changes{"none", "ramp", "step"};
constexpr std::array<std::string_view, 3> whats{"change", "level", "effect"};

std::string_view name_of(Change change) {
  return changes.at(static_cast<std::size_t>(change));
}

constexpr double a_day_in_seconds = 86400.0;

Json track_json(const Analysis& all, const Track& track) {
  const Parameter& parameter = all.parameters[track.parameter];
  Json json{{"machine", track.machine},
            {"group", parameter.kind.group},
            {"command", name_of(parameter.kind.command)},
            {"name", parameter.name},
            {"unit", parameter.unit},
            {"records", track.value.size()},
            {"level", number_or_null<Json>(track.level)},
            {"sibling_median", number_or_null<Json>(parameter.median)},
            {"sibling_deviation", number_or_null<Json>(parameter.deviation)},
            {"sibling_p", track.has_siblings ? Json(track.sibling_p) : Json(nullptr)},
            {"stands_out", track.stands_out},
            {"slope_per_day", number_or_null<Json>(track.trend.slope * a_day_in_seconds)}};
  Json trend = nullptr;
  if (track.has_trend) {
    trend = {{"form", name_of(track.trend.change)},
             {"since", date_text(track.trend.since)},
             {"from", number_or_null<Json>(track.trend.from)},
             {"to", number_or_null<Json>(track.trend.to)},
             {"p", track.trend.p}};
  }
  json["trend"] = std::move(trend);
  json["changes"] = track.changes;
  return json;
}

}  // namespace

std::string report_json(const Analysis& all, const std::vector<Row>& rows, std::string_view version) {
  Json json{{"schema", "hysteron-fleet-report/1"},
            {"version", version},
            {"summary", headline(all, rows)},
            {"machines", all.machines.size()},
            {"records", rows.size()},
            {"machines_found", all.machines_found},
            {"tests", all.tests},
            {"false_share", all.false_share},
            {"p_limit", all.findings.empty() ? Json(nullptr) : Json(all.threshold)}};
  json["findings"] = Json::array();
  for (const Finding& finding : all.findings) {
    json["findings"].push_back(
        {{"machine", finding.machine},
         {"what", whats.at(static_cast<std::size_t>(finding.what))},
         {"name", finding.what == Finding::What::Effect ? all.presences[finding.index].effect
                                                        : all.parameters[all.tracks[finding.index].parameter].name},
         {"p", finding.p},
         {"text", sentence(all, finding)}});
  }
  json["parameters"] = Json::array();
  for (const Track& track : all.tracks) {
    json["parameters"].push_back(track_json(all, track));
  }
  json["effects"] = Json::array();
  for (const Presence& one : all.presences) {
    json["effects"].push_back({{"machine", one.machine},
                               {"group", one.kind.group},
                               {"effect", one.effect},
                               {"named", one.named},
                               {"records", one.records},
                               {"since", date_text(one.since)},
                               {"sibling_share", one.sibling_share},
                               {"p", one.has_siblings ? Json(one.p) : Json(nullptr)},
                               {"stands_out", one.stands_out}});
  }
  json["failures"] = Json::array();
  for (const std::size_t row : all.failures) {
    json["failures"].push_back({{"machine", rows[row].unit.machine},
                                {"when", rows[row].unit.when},
                                {"command", name_of(rows[row].unit.command)},
                                {"status", name_of(rows[row].result.status)},
                                {"reason", rows[row].result.reason},
                                {"folder", folder_of("", rows[row].key).string()}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string report_csv(const Analysis& all) {
  std::string text =
      "machine,group,command,name,unit,records,level,sibling_median,sibling_deviation,sibling_p,stands_out,slope_per_"
      "day,form,"
      "since,from,to,change_p,changes\n";
  for (const Track& track : all.tracks) {
    const Parameter& parameter = all.parameters[track.parameter];
    const Trend& trend = track.trend;
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_cell(track.machine),
                        csv_cell(parameter.kind.group), name_of(parameter.kind.command), csv_cell(parameter.name),
                        csv_cell(parameter.unit), track.value.size(), number_cell(track.level),
                        number_cell(parameter.median), number_cell(parameter.deviation),
                        track.has_siblings ? number_cell(track.sibling_p) : "", track.stands_out ? 1 : 0,
                        number_cell(trend.slope * a_day_in_seconds), track.has_trend ? name_of(trend.change) : "",
                        date_text(trend.since), number_cell(trend.from), number_cell(trend.to),
                        track.has_trend ? number_cell(trend.p) : "", track.changes ? 1 : 0);
  }
  return text;
}

}  // namespace hysteron::fleet
