#include "runtime/web/responder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "runtime/history/history_trend.hpp"
#include "runtime/web/assets.hpp"
#include "runtime/web/parameter_text.hpp"
#include "support/diagnostic.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime::web {
namespace {

constexpr std::string_view history_target = "/api/history?";
constexpr double usual_hours = 8.0;
constexpr double most_hours = 876'000.0;  ///< a hundred years: what keep can be

Answer refusal(unsigned status, const std::string& why) {
  return {.status = status, .body = refusal_text(why)};
}

std::string with_unit(double value, const std::string& unit) {
  return number_text(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

/// Why a point cannot take a value, as a sentence that names it; empty where it can.
std::string refusal_of(const Point& point, double value) {
  if (!std::isfinite(value)) {
    return point.name + " is not a finite number.";
  }
  if (value < point.low) {
    return fmt::format("{} must be at least {}; {} was given.", point.name, with_unit(point.low, point.unit),
                       number_text(value));
  }
  if (value > point.high) {
    return fmt::format("{} must be at most {}; {} was given.", point.name, with_unit(point.high, point.unit),
                       number_text(value));
  }
  return {};
}

}  // namespace

const std::vector<Header>& common_headers() {
  static const std::vector<Header> headers{
      {"Content-Security-Policy",
       "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cache-Control", "no-store"},
  };
  return headers;
}

Responder::Responder(PointDoor& door, const Subject& subject, Access access)
    : door_(door),
      program_(subject.name),
      access_(std::move(access)),
      history_(subject.history),
      history_points_(subject.history_points),
      description_(description_text(subject, door, access_.can_write(), access_.reading_needs_token())),
      metrics_(door.points()) {}

Answer Responder::answer(const Request& request) {
  if (Answer refused = refused_sender(request); refused.status != 200) {
    return refused;
  }
  if (request.method == "GET") {
    return read(request);
  }
  if (request.method == "POST") {
    return write(request);
  }
  return refusal(405, "Only GET and POST are answered.");
}

Answer Responder::upgrade(const Request& request) const {
  if (Answer refused = refused_sender(request); refused.status != 200) {
    return refused;
  }
  return request.target == stream_target ? Answer{} : refusal(404, "There is no such stream.");
}

/// Another page in the same browser may not ask in the user's name.
Answer Responder::refused_sender(const Request& request) const {
  if (access_.is_loopback && !is_loopback_host(request.host)) {
    return refusal(421, "The header Host names another machine; open the page by 127.0.0.1 or localhost.");
  }
  if (!is_own_origin(request.origin, request.host)) {
    return refusal(403, "The request comes from a page of another server.");
  }
  return {};
}

Answer Responder::read(const Request& request) {
  for (const Asset& asset : assets()) {
    if (request.target == asset.target) {
      return {.type = asset.type, .body = std::string(asset.text)};
    }
  }
  const bool description = request.target == "/api/description";
  const bool parameters = request.target == "/api/parameters.toml";
  const bool metrics = request.target == metrics_target;
  const bool history = request.target.starts_with(history_target);
  if (!description && !parameters && !metrics && !history && request.target != "/api/values") {
    return refusal(404, "There is nothing of this name.");
  }
  if (access_.reading_needs_token() && !may_read(access_, request.authorization)) {
    return refusal(401, "The token is missing or wrong.");
  }
  if (description) {
    return {.body = description_};
  }
  if (history) {
    return read_history(request.target.substr(history_target.size()));
  }
  door_.read_live(live_);
  if (parameters) {
    return {.type = "application/toml", .body = parameter_text(program_, door_.points(), live_.values)};
  }
  if (metrics) {
    return {.type = metrics_type, .body = metrics_.text(live_.values)};
  }
  return {.body = values_text(live_)};
}

Answer Responder::read_history(std::string_view query) const {
  if (history_.empty()) {
    return refusal(404, "The task keeps no history: its run file has no table [history].");
  }
  HistoryQuestion question{.file = history_, .hours = usual_hours};
  while (!query.empty()) {
    const auto end = std::min(query.find('&'), query.size());
    const std::string_view part = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    const auto equals = std::min(part.find('='), part.size());
    const std::string_view value = part.substr(std::min(equals + 1, part.size()));
    const auto hours = parse_number(value);
    if (part.substr(0, equals) == "point") {
      question.point = value;
    } else if (part.substr(0, equals) != "hours") {
      return refusal(400, "The history is asked by point=NAME and hours=NUMBER.");
    } else if (hours.status != NumberStatus::Finite || !(hours.value > 0.0 && hours.value <= most_hours)) {
      return refusal(400, fmt::format("hours must be a number above 0, and {} at most.", most_hours));
    } else {
      question.hours = hours.value;
    }
  }
  if (std::ranges::find(history_points_, question.point) == history_points_.end()) {
    return refusal(404, "There is no such point in the history; /api/description lists them.");
  }
  return {.later = std::move(question)};
}

Answer answer_of(const HistoryQuestion& question) {
  try {
    const auto span = static_cast<std::int64_t>(question.hours * 3.6e6);
    return {.body = trend_text(trend_of(question.file, question.point, span))};
  } catch (const InputError& refused) {
    return refusal(503, "The history cannot be read now: " + refused.diagnostics().all().front().cause);
  } catch (const std::exception& problem) {
    return refusal(503, fmt::format("The history cannot be read now: {}.", problem.what()));
  }
}

Answer Responder::write(const Request& request) {
  // By target: the command of the task. A set is staged from a body.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> targets{{{"/api/stage", ""},
                                                                                  {"/api/commit", "task.commit"},
                                                                                  {"/api/discard", "task.discard"},
                                                                                  {"/api/reset", "task.reset"}}};
  const auto* const target =
      std::ranges::find(targets, request.target, &std::pair<std::string_view, std::string_view>::first);
  if (target == targets.end()) {
    return refusal(404, "There is nothing of this name.");
  }
  if (!access_.can_write()) {
    return refusal(403, "The live page is read-only: it was started without --web-token-file.");
  }
  if (!is_authorized(access_, request.authorization)) {
    return may_read(access_, request.authorization)
               ? refusal(403, "This token is for reading; to change parameters takes the other one.")
               : refusal(401, "The token is missing or wrong.");
  }
  return target->second.empty() ? stage(request.body) : give(target->second);
}

Answer Responder::stage(std::string_view body) {
  nlohmann::json values;
  try {
    values = nlohmann::json::parse(body);
  } catch (const nlohmann::json::out_of_range&) {
    return refusal(400, "A number in the body is beyond what a double holds, 1.8e308.");
  } catch (const nlohmann::json::parse_error&) {
    // It stays empty.
  }
  if (!values.is_object() || values.empty()) {
    return refusal(400, "The body is no JSON object of parameters and their values.");
  }
  std::vector<PointWrite> writes;
  for (const auto& [name, value] : values.items()) {
    if (!value.is_number() && !value.is_boolean()) {
      return refusal(422, name + " is not given a number.");
    }
    const double number = value.is_boolean() ? (value.get<bool>() ? 1.0 : 0.0) : value.get<double>();
    if (const std::string why = collect(name, number, writes); !why.empty()) {
      return refusal(422, why);
    }
  }
  const std::string why = door_.write(writes);
  return why.empty() ? Answer{.body = "{}"} : refusal(422, why);
}

std::string Responder::collect(const std::string& name, double value, std::vector<PointWrite>& writes) const {
  const auto points = door_.points();
  const auto point = std::ranges::find(points, name, &Point::name);
  if (point == points.end()) {
    return "There is no parameter " + name + ".";
  }
  if (point->kind != PointKind::parameter || !point->writable) {
    return name + " is no parameter; the live page changes parameters alone.";
  }
  writes.push_back({.point = static_cast<std::size_t>(point - points.begin()), .value = value});
  return refusal_of(*point, value);
}

Answer Responder::give(std::string_view command) {
  const auto points = door_.points();
  const auto point = std::ranges::find(points, command, &Point::name);
  if (point == points.end()) {
    return refusal(404, "The program takes no such command.");
  }
  const std::vector<PointWrite> writes{{.point = static_cast<std::size_t>(point - points.begin()), .value = 1.0}};
  const std::string why = door_.write(writes);
  return why.empty() ? Answer{.body = "{}"} : refusal(422, why);
}

}  // namespace hysteron::runtime::web
