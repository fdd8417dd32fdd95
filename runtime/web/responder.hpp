// The answer to an HTTP request, as a function of the request, the access and the values behind the door. No sockets,
// no time.
//
//   GET  /, /page.js, /history.js, /xy.js, /page.css, /dygraph.js, /dygraph.css    the page
//   GET  /api/description    what there is to be seen
//   GET  /api/values         the values of the newest cycle
//   GET  /api/parameters.toml    the parameters that count, as a parameter file
//   GET  /metrics            the same for a Prometheus server
//   GET  /api/history?point=Y&hours=8    the last hours of a point, thinned for a picture
//   GET  /api/stream         the values again and again, over a WebSocket; ?session=NAME, of 16 to 64 letters and
//                            digits that nobody else has, begins a session for as long as it is open
//   POST /api/stage          {"HYST.C1": 1.5, …}: these wait for a commit of this page, beside what Modbus has staged
//   POST /api/commit         all that wait count from the next step on, or none
//   POST /api/discard        none of them waits any longer
//   POST /api/reset          every state as after a start, and a fault is forgotten; nothing is forced any more
//   POST /api/force          {"session": NAME, "inputs": {"X": 1.5, "B": null, …}}: inputs have these values, and null
//                            ends it, for as long as the session is open
//   POST /api/release        no input is forced any more
//
// Whoever posts, and beyond the loopback whoever reads values, sends Authorization: Bearer TOKEN. There may be a token
// of its own for who only reads. What who has the token may do is said by the run file.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
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
/// Of the target of a stream; empty where it names none.
[[nodiscard]] std::string_view session_of(std::string_view target);

/// The sessions of open pages, and which of them forces an input: the one that forced it last.
class Sessions {
 public:
  [[nodiscard]] bool is_open(std::string_view name) const { return open_.contains(std::string(name)); }
  void begin(std::string_view name) {
    if (!name.empty()) {
      open_.emplace(name);
    }
  }
  void force(std::string_view name, std::span<const Force> inputs);
  /// It is over; gives the inputs that it forces, to be freed.
  [[nodiscard]] std::vector<Force> end(std::string_view name);
  /// No input is forced any more.
  void release() { forced_by_.clear(); }

 private:
  std::set<std::string> open_{};
  std::map<std::size_t, std::string> forced_by_{};
};

class Responder {
 public:
  /// The door must outlive the responder.
  Responder(PointDoor& door, const Subject& subject, Access access);

  [[nodiscard]] Answer answer(const Request& request);
  /// The same for a request to be upgraded to a WebSocket: status 200 where it may be. The token, where one is needed,
  /// comes as its first message, since no browser can send the header.
  [[nodiscard]] Answer upgrade(const Request& request) const;

  [[nodiscard]] const Access& access() const { return access_; }

  /// A stream of that session is open; nothing where the name is empty, as of a stream that began none.
  void session_begins(std::string_view session) { sessions_.begin(session); }
  /// It is closed; what it forced is free.
  void session_ends(std::string_view session);

 private:
  [[nodiscard]] Answer refused_sender(const Request& request) const;
  [[nodiscard]] Answer read(const Request& request);
  [[nodiscard]] Answer read_history(std::string_view query) const;
  [[nodiscard]] Answer write(const Request& request);
  [[nodiscard]] Answer stage(std::string_view body);
  [[nodiscard]] Answer force(std::string_view body);
  [[nodiscard]] Answer release();
  [[nodiscard]] Answer give(std::string_view command);
  [[nodiscard]] std::string collect(const std::string& name, double value, std::vector<PointWrite>& writes) const;
  /// Where an online change came since, all that is shown is of the version that runs now.
  void follow_version();
  /// The newest cycle, of the version that is shown.
  void read_live();

  PointDoor& door_;
  Subject subject_;
  Access access_;
  std::shared_ptr<const LiveView> view_;
  std::string description_;
  Metrics metrics_;
  LiveValues live_{};
  Sessions sessions_{};
};

}  // namespace hysteron::runtime::web
