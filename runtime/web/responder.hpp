// The answer to an HTTP request, as a function of the request, the access and the values behind the door. No sockets,
// no time.
//
//   GET  /, /page.js, /history.js, /xy.js, /page.css, /dygraph.js, /dygraph.css    the page
//   GET  /api/description    what there is to be seen
//   GET  /api/values         the values of the newest cycle
//   GET  /api/parameters.toml    the parameters that count, as a parameter file
//   GET  /metrics            the same for a Prometheus server
//   GET  /api/history?point=Y&hours=8    the last hours of a point, thinned for a picture
//   GET  /api/stream         the values again and again, over a WebSocket
//   POST /api/stage          {"HYST.C1": 1.5, …}: these wait for a commit
//   POST /api/commit         all that wait count from the next step on, or none
//   POST /api/discard        none of them waits any longer
//   POST /api/reset          every state as after a start, and a fault is forgotten
//
// Whoever posts, and beyond the loopback whoever reads values, sends Authorization: Bearer TOKEN. There may be a token
// of its own for who only reads.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/point.hpp"
#include "runtime/web/access.hpp"
#include "runtime/web/live_text.hpp"
#include "runtime/web/metrics.hpp"

namespace hysteron::runtime::web {

struct Request {
  std::string_view method{};
  std::string_view target{};
  std::string_view host{};
  std::string_view origin{};
  std::string_view authorization{};
  std::string_view body{};
};

/// What is looked up in the history, which may take a while: by another thread than the one that answers.
struct HistoryQuestion {
  std::filesystem::path file{};
  std::string point{};
  double hours = 0.0;
};

struct Answer {
  unsigned status = 200;
  std::string_view type = "application/json";
  std::string body{};
  std::optional<HistoryQuestion> later{};  ///< the body is the answer to this
};

/// From any thread, and in bounded time.
[[nodiscard]] Answer answer_of(const HistoryQuestion& question);

/// On every answer: nothing is loaded from another host, nothing is framed, nothing is kept.
struct Header {
  std::string_view name;
  std::string_view value;
};
[[nodiscard]] const std::vector<Header>& common_headers();

inline constexpr std::string_view stream_target = "/api/stream";

class Responder {
 public:
  /// The door must outlive the responder.
  Responder(PointDoor& door, const Subject& subject, Access access);

  [[nodiscard]] Answer answer(const Request& request);
  /// The same for a request to be upgraded to a WebSocket: status 200 where it may be. The token, where one is needed,
  /// comes as its first message, since no browser can send the header.
  [[nodiscard]] Answer upgrade(const Request& request) const;

  [[nodiscard]] const Access& access() const { return access_; }

 private:
  [[nodiscard]] Answer refused_sender(const Request& request) const;
  [[nodiscard]] Answer read(const Request& request);
  [[nodiscard]] Answer read_history(std::string_view query) const;
  [[nodiscard]] Answer write(const Request& request);
  [[nodiscard]] Answer stage(std::string_view body);
  [[nodiscard]] Answer give(std::string_view command);
  [[nodiscard]] std::string collect(const std::string& name, double value, std::vector<PointWrite>& writes) const;

  PointDoor& door_;
  std::string program_;
  Access access_;
  std::filesystem::path history_;
  std::vector<std::string> history_points_;
  std::string description_;
  Metrics metrics_;
  LiveValues live_{};
};

}  // namespace hysteron::runtime::web
