#include "runtime/web/live_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "runtime/config/page_rights.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/json_number.hpp"

namespace hysteron::runtime::web {
namespace {

using nlohmann::json;

std::string_view name_of(PointKind kind) {
  switch (kind) {
    case PointKind::input:
      return "input";
    case PointKind::output:
      return "output";
    case PointKind::parameter:
      return "parameter";
    case PointKind::status:
      return "status";
    case PointKind::command:
      return "command";
  }
  return {};
}

std::string_view name_of(PointType type) {
  return type == PointType::boolean ? "boolean" : is_real(type) ? "real" : "integer";
}

/// Texts are the user's: what is no UTF-8 is replaced.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

void add_number(std::string& text, double value) {
  if (std::isfinite(value)) {
    fmt::format_to(std::back_inserter(text), "{}", value);
  } else {
    text += "null";
  }
}

void add_list(std::string& text, std::span<const double> values) {
  text += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += i == 0 ? "" : ",";
    add_number(text, values[i]);
  }
  text += ']';
}

}  // namespace

std::string description_text(const Subject& subject, const LiveView& view, const Access& access) {
  json points = json::array();
  for (const Point& point : view.points) {
    points.push_back({{"name", point.name},
                      {"kind", name_of(point.kind)},
                      {"type", name_of(point.type)},
                      {"data_type", modbus::name_of(point.type)},
                      {"unit", point.unit},
                      {"low", number_or_null<json>(point.low)},
                      {"high", number_or_null<json>(point.high)},
                      {"meaning", point.meaning}});
  }
  json inner = json::array();
  for (const Point& signal : view.inner) {
    inner.push_back({{"name", signal.name},
                     {"type", name_of(signal.type)},
                     {"data_type", modbus::name_of(signal.type)},
                     {"unit", signal.unit}});
  }
  json rights = json::array();
  for (const PageRight& right : page_rights) {
    if (access.can_write() && access.rights.*right.is_given) {
      rights.push_back(right.name);
    }
  }
  return text_of({{"name", subject.name},
                  {"period", static_cast<double>(subject.period) * 1e-9},
                  {"version", view.version},
                  {"diagram", view.picture},
                  {"points", std::move(points)},
                  {"inner", std::move(inner)},
                  {"history", subject.history_points},
                  {"writable", access.can_write()},
                  {"rights", std::move(rights)},
                  {"token_to_read", access.reading_needs_token()}});
}

std::string values_text(const LiveValues& live) {
  std::string text = fmt::format("{{\"version\":{},\"cycle\":{},\"values\":", live.version, live.cycle);
  add_list(text, live.values);
  text += ",\"inner\":";
  add_list(text, live.inner);
  text += ",\"staged\":[";
  for (std::size_t i = 0; i < live.staged.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{}[{},", i == 0 ? "" : ",", live.staged[i].point);
    add_number(text, live.staged[i].value);
    text += ']';
  }
  return text + fmt::format("],\"forced\":[{}]}}", fmt::join(live.forced, ","));
}

std::string trend_text(const Trend& trend) {
  std::string text = fmt::format("{{\"unit\":{},\"rows\":{},\"looked_at\":{},\"set_back\":{},\"places\":[",
                                 text_of(trend.unit), trend.rows, trend.looked_at, trend.set_back);
  for (std::size_t i = 0; i < trend.places.size(); ++i) {
    const TrendPlace& place = trend.places[i];
    text += i == 0 ? "" : place.begins ? ",null," : ",";
    fmt::format_to(std::back_inserter(text), "[{}", place.utc_ms);
    for (const double value : {place.low, place.mean, place.high}) {
      text += ',';
      add_number(text, value);
    }
    text += ']';
  }
  return text + "]}";
}

std::string refusal_text(const std::string& refusal) {
  return text_of({{"refusal", refusal}});
}

}  // namespace hysteron::runtime::web
