#include "runtime/web/responder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "runtime/history/history_trend.hpp"
#include "runtime/task/staged_parameters.hpp"
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
  if (auto refusal = refusal_by_type(point.name, point.type, value); !refusal.empty()) {
    return refusal;
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

/// Names and numbers; null where a name is given none on purpose.
struct Numbers {
  std::vector<std::pair<std::string, std::optional<double>>> numbers{};
  unsigned status = 200;
  std::string refused{};
};

/// Of a text that is a JSON object; `form` is said where it is none.
Numbers numbers_in(std::string_view body, const char* form) {
  nlohmann::json values;
  try {
    values = nlohmann::json::parse(body);
  } catch (const nlohmann::json::out_of_range&) {
    return {.status = 400, .refused = "A number in the body is beyond what a double holds, 1.8e308."};
  } catch (const nlohmann::json::parse_error&) {
    // It stays empty.
  }
  if (!values.is_object() || values.empty()) {
    return {.status = 400, .refused = form};
  }
  Numbers found;
  for (const auto& [name, value] : values.items()) {
    if (!value.is_number() && !value.is_boolean() && !value.is_null()) {
      return {.status = 422, .refused = name + " is not given a number."};
    }
    found.numbers.emplace_back(name, value.is_null()      ? std::nullopt
                                     : value.is_boolean() ? std::optional(value.get<bool>() ? 1.0 : 0.0)
                                                          : std::optional(value.get<double>()));
  }
  return found;
}

std::string_view name_of(bool PageRights::*right) {
  return right == &PageRights::parameters ? "parameters" : right == &PageRights::reset ? "reset" : "force";
}

}  // namespace

std::string_view session_of(std::string_view target) {
  constexpr std::string_view key = "?session=";
  const std::string_view begin = target.substr(0, std::min(target.size(), stream_target.size() + key.size()));
  const std::string_view name = target.substr(begin.size());
  const auto is_sign = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  const bool is_well = begin.starts_with(stream_target) && begin.ends_with(key) && name.size() >= 16 &&
                       name.size() <= 64 && std::ranges::all_of(name, is_sign);
  return is_well ? name : std::string_view{};
}

void Sessions::force(std::string_view name, std::span<const Force> inputs) {
  for (const Force& one : inputs) {
    if (one.value) {
      forced_by_.insert_or_assign(one.point, std::string(name));
    } else {
      forced_by_.erase(one.point);
    }
  }
}

std::vector<Force> Sessions::end(std::string_view name) {
  open_.erase(std::string(name));
  std::vector<Force> freed;
  std::erase_if(forced_by_, [&](const auto& one) {
    if (one.second == name) {
      freed.push_back({.point = one.first});
    }
    return one.second == name;
  });
  return freed;
}

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
      subject_(subject),
      access_(std::move(access)),
      view_(door.view()),
      description_(description_text(subject_, *view_, access_)),
      metrics_(view_->points) {}

void Responder::follow_version() {
  if (auto view = door_.view(); view->version != view_->version) {
    view_ = std::move(view);
    description_ = description_text(subject_, *view_, access_);
    metrics_ = Metrics(view_->points);
  }
}

void Responder::read_live() {
  do {
    door_.read_live(live_);
    follow_version();
  } while (live_.version != view_->version);
}

void Responder::session_ends(std::string_view session) {
  if (const auto freed = sessions_.end(session); !freed.empty()) {
    (void)door_.force(freed);  // refused alone where nothing is forced any more
  }
}

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
  if (request.target == stream_target) {
    return {};
  }
  const std::string_view session = session_of(request.target);
  if (session.empty()) {
    return refusal(404, "There is no such stream.");
  }
  return sessions_.is_open(session) ? refusal(409, "Another page has a session of this name.") : Answer{};
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
    follow_version();
    return {.body = description_};
  }
  if (history) {
    return read_history(request.target.substr(history_target.size()));
  }
  read_live();
  if (parameters) {
    return {.type = "application/toml", .body = parameter_text(subject_.name, view_->points, live_.values)};
  }
  if (metrics) {
    return {.type = metrics_type, .body = metrics_.text(live_.values)};
  }
  return {.body = values_text(live_)};
}

Answer Responder::read_history(std::string_view query) const {
  if (subject_.history.empty()) {
    return refusal(404, "The task keeps no history: its run file has no table [history].");
  }
  HistoryQuestion question{.file = subject_.history, .hours = usual_hours};
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
  if (std::ranges::find(subject_.history_points, question.point) == subject_.history_points.end()) {
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
  struct Order {
    std::string_view target;
    bool PageRights::*right;
    std::string_view command{};  ///< of the task
  };
  constexpr std::array<Order, 6> orders{{{"/api/stage", &PageRights::parameters},
                                         {"/api/commit", &PageRights::parameters, "task.commit"},
                                         {"/api/discard", &PageRights::parameters, "task.discard"},
                                         {"/api/reset", &PageRights::reset, "task.reset"},
                                         {"/api/force", &PageRights::force},
                                         {"/api/release", &PageRights::force}}};
  const auto* const order = std::ranges::find(orders, request.target, &Order::target);
  if (order == orders.end()) {
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
  if (!(access_.rights.*order->right)) {
    return refusal(403, fmt::format("The live page may not do this: \"{}\" is not among the rights of [web] in the "
                                    "run file.",
                                    name_of(order->right)));
  }
  follow_version();
  return order->target == "/api/stage"     ? stage(request.body)
         : order->target == "/api/force"   ? force(request.body)
         : order->target == "/api/release" ? release()
                                           : give(order->command);
}

Answer Responder::stage(std::string_view body) {
  const Numbers given = numbers_in(body, "The body is no JSON object of parameters and their values.");
  if (!given.refused.empty()) {
    return refusal(given.status, given.refused);
  }
  std::vector<PointWrite> writes;
  for (const auto& [name, value] : given.numbers) {
    const std::string why = value ? collect(name, *value, writes) : name + " is not given a number.";
    if (!why.empty()) {
      return refusal(422, why);
    }
  }
  const std::string why = door_.write_from_page(writes);
  return why.empty() ? Answer{.body = "{}"} : refusal(422, why);
}

std::string Responder::collect(const std::string& name, double value, std::vector<PointWrite>& writes) const {
  const auto point = std::ranges::find(view_->points, name, &Point::name);
  if (point == view_->points.end()) {
    return "There is no parameter " + name + ".";
  }
  if (point->kind != PointKind::parameter || !point->writable) {
    return name + " is no parameter; parameters alone are staged.";
  }
  writes.push_back({.point = view_->places[static_cast<std::size_t>(point - view_->points.begin())], .value = value});
  return refusal_of(*point, value);
}

Answer Responder::force(std::string_view body) {
  constexpr const char* form = "The body is no JSON object with a session, and inputs with their values.";
  nlohmann::json asked;
  try {
    asked = nlohmann::json::parse(body);
  } catch (const nlohmann::json::exception&) {
    return refusal(400, form);
  }
  if (!asked.is_object() || !asked.contains("session") || !asked["session"].is_string() || !asked.contains("inputs")) {
    return refusal(400, form);
  }
  const std::string session = asked["session"];
  if (!sessions_.is_open(session)) {
    return refusal(409, "The session is not open: what is forced ends with it, so it needs an open stream.");
  }
  const Numbers given = numbers_in(asked["inputs"].dump(), form);
  if (!given.refused.empty()) {
    return refusal(given.status, given.refused);
  }
  std::vector<Force> forces;
  for (const auto& [name, value] : given.numbers) {
    const auto point = std::ranges::find(view_->points, name, &Point::name);
    if (point == view_->points.end() || point->kind != PointKind::input) {
      return refusal(422, "There is no input " + name + "; inputs alone can be forced.");
    }
    if (const std::string why = value ? refusal_of(*point, *value) : ""; !why.empty()) {
      return refusal(422, why);
    }
    forces.push_back({.point = view_->places[static_cast<std::size_t>(point - view_->points.begin())], .value = value});
  }
  if (const std::string why = door_.force(forces); !why.empty()) {
    return refusal(422, why);
  }
  sessions_.force(session, forces);
  return {.body = "{}"};
}

Answer Responder::release() {
  door_.end_forces();
  sessions_.release();
  return {.body = "{}"};
}

Answer Responder::give(std::string_view command) {
  const auto points = door_.points();
  const auto point = std::ranges::find(points, command, &Point::name);
  if (point == points.end()) {
    return refusal(404, "The program takes no such command.");
  }
  const std::vector<PointWrite> writes{{.point = static_cast<std::size_t>(point - points.begin()), .value = 1.0}};
  const std::string why = door_.write_from_page(writes);
  return why.empty() ? Answer{.body = "{}"} : refusal(422, why);
}

}  // namespace hysteron::runtime::web
