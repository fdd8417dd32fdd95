#include "runtime/web/server.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "runtime/modbus/listener.hpp"
#include "runtime/web/responder.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using Text = std::shared_ptr<const std::string>;

constexpr milliseconds accept_pause{100};
constexpr std::size_t longest_message = 1024;  ///< a token, or a mistake
constexpr std::size_t most_questions = 4;      ///< about the history, at once
constexpr int socket_bytes = 64 * 1024;
constexpr int niceness = 10;  ///< whatever runs the machine goes before the page

/// Written by the server's thread alone.
struct Counters {
  using Count = std::atomic<std::uint64_t>;
  Count open{0}, streams{0}, accepted{0}, refused_full{0}, gave_way{0}, answers{0}, sent{0}, dropped{0}, unread{0};
};

void add(Counters::Count& count) {
  count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

std::string_view text_of(boost::beast::string_view text) {  // of 1.74 boost::string_view, of 1.83 another
  return {text.data(), text.size()};
}

/// What a connection needs of the server.
class Host {
 public:
  Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  virtual ~Host() = default;
  virtual Responder& responder() = 0;
  virtual Counters& counters() = 0;
  [[nodiscard]] virtual const Limits& limits() const = 0;
  [[nodiscard]] virtual bool has_room_for_a_stream() const = 0;
  /// Looks it up beside this thread, and calls back in it. False where too many wait already.
  virtual bool look_up(HistoryQuestion question, std::function<void(Answer)> done) = 0;
  /// The connection is over: forget it.
  virtual void ended(std::uint64_t number) = 0;
};

/// One connection: requests and their answers, until one of them makes it a stream.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Host& host, std::uint64_t number, tcp::socket socket)
      : host_(host), number_(number), stream_(std::in_place, std::move(socket)) {}

  void begin() {
    tcp::socket& socket = lowest().socket();
    socket.set_option(tcp::no_delay(true));
    // What the system keeps for a client that does not read, or sends too much, is bounded too.
    socket.set_option(tcp::socket::send_buffer_size(socket_bytes));
    socket.set_option(tcp::socket::receive_buffer_size(socket_bytes));
    read_request();
  }

  /// Whether a newer connection may take its place, and since when its request is awaited.
  [[nodiscard]] bool is_waiting() const { return is_waiting_; }
  [[nodiscard]] Clock::time_point since() const { return since_; }
  [[nodiscard]] bool is_stream() const { return is_stream_; }

  /// Ends it without a farewell.
  void close() {
    if (!is_closed_) {
      is_closed_ = true;
      is_waiting_ = false;
      is_stream_ = false;
      lowest().close();
      host_.responder().session_ends(session_);
      host_.ended(number_);
    }
  }

  /// A set of values: sent where the one before is gone, and dropped where not.
  void offer(const Text& values, Clock::time_point now) {
    if (!is_writing_) {
      write_values(values, now);
    } else if (now - write_began_ > host_.limits().unread) {
      add(host_.counters().unread);
      close();
    } else {
      add(host_.counters().dropped);
    }
  }

 private:
  beast::tcp_stream& lowest() { return websocket_ ? websocket_->next_layer() : *stream_; }

  // --- requests ---

  void read_request() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(host_.limits().header_bytes));
    parser_->body_limit(host_.limits().body_bytes);
    is_waiting_ = true;
    since_ = Clock::now();
    stream_->expires_after(host_.limits().request);
    http::async_read(*stream_, buffer_, *parser_,
                     [self = shared_from_this()](beast::error_code fault, std::size_t /*bytes*/) {
                       self->is_waiting_ = false;
                       self->was_read(fault);
                     });
  }

  void was_read(beast::error_code fault) {
    if (fault == http::error::body_limit || fault == http::error::header_limit) {
      return answer({.status = 413, .body = refusal_text("The request is too long.")}, false);
    }
    const bool is_malformed = fault.category() == http::make_error_code(http::error::bad_method).category();
    if (is_malformed && fault != http::error::end_of_stream && fault != http::error::partial_message) {
      return answer({.status = 400, .body = refusal_text("The request is no HTTP.")}, false);
    }
    if (fault) {
      return close();
    }
    const auto& message = parser_->get();
    const auto field = [&](http::field name) { return text_of(message[name]); };
    const Request request{.method = text_of(message.method_string()),
                          .target = text_of(message.target()),
                          .host = field(http::field::host),
                          .origin = field(http::field::origin),
                          .authorization = field(http::field::authorization),
                          .body = message.body()};
    if (!websocket::is_upgrade(message)) {
      Answer now = host_.responder().answer(request);
      return now.later ? look_up(std::move(*now.later), message.keep_alive())
                       : answer(std::move(now), message.keep_alive());
    }
    Answer refused = host_.responder().upgrade(request);
    if (refused.status == 200 && !host_.has_room_for_a_stream()) {
      refused = {.status = 503, .body = refusal_text("As many pages are open as may be; close one.")};
    }
    if (refused.status != 200) {
      return answer(std::move(refused), false);
    }
    become_stream(session_of(request.target));
  }

  void look_up(HistoryQuestion question, bool keep_alive) {
    stream_->expires_never();
    const auto done = [self = shared_from_this(), keep_alive](Answer found) {
      if (!self->is_closed_) {
        self->answer(std::move(found), keep_alive);
      }
    };
    if (!host_.look_up(std::move(question), done)) {
      answer({.status = 503, .body = refusal_text("The history is asked by too many at once; try again.")}, keep_alive);
    }
  }

  void answer(Answer answer, bool keep_alive) {
    add(host_.counters().answers);
    response_ = {};
    response_.version(11);
    response_.result(answer.status);
    for (const Header& header : common_headers()) {
      response_.set({header.name.data(), header.name.size()}, {header.value.data(), header.value.size()});
    }
    response_.set(http::field::content_type, {answer.type.data(), answer.type.size()});
    if (answer.status == 401) {
      response_.set(http::field::www_authenticate, "Bearer");
    } else if (answer.status == 405) {
      response_.set(http::field::allow, "GET, POST");
    }
    response_.body() = std::move(answer.body);
    response_.keep_alive(keep_alive);
    response_.prepare_payload();
    stream_->expires_after(host_.limits().answer);
    http::async_write(*stream_, response_, [self = shared_from_this()](beast::error_code fault, std::size_t /*bytes*/) {
      if (fault || !self->response_.keep_alive()) {
        self->close();
      } else {
        self->read_request();
      }
    });
  }

  // --- the stream ---

  void become_stream(std::string_view session) {
    session_ = session;
    host_.responder().session_begins(session_);
    websocket_.emplace(std::move(*stream_));
    lowest().expires_never();
    const Limits& limits = host_.limits();
    websocket_->set_option(websocket::stream_base::timeout{
        .handshake_timeout = limits.request, .idle_timeout = limits.silence, .keep_alive_pings = true});
    websocket_->set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      for (const Header& header : common_headers()) {
        response.set({header.name.data(), header.name.size()}, {header.value.data(), header.value.size()});
      }
    }));
    websocket_->read_message_max(longest_message);
    websocket_->async_accept(parser_->get(), [self = shared_from_this()](beast::error_code fault) {
      self->parser_.reset();
      if (fault) {
        return self->close();
      }
      add(self->host_.counters().answers);
      self->is_stream_ = !self->host_.responder().access().reading_needs_token();
      self->is_waiting_ = !self->is_stream_;
      self->since_ = Clock::now();
      self->read_message();
    });
  }

  /// A stream takes one message, the token where one is needed; all that comes besides is the end of it.
  void read_message() {
    message_.clear();
    websocket_->async_read(message_, [self = shared_from_this()](beast::error_code fault, std::size_t /*bytes*/) {
      if (fault) {
        return self->close();
      }
      const auto data = self->message_.data();
      const std::string_view text(static_cast<const char*>(data.data()), data.size());
      if (self->is_stream_ || !is_reading_token(self->host_.responder().access(), text)) {
        return self->refuse_message();
      }
      self->is_stream_ = true;
      self->is_waiting_ = false;
      self->read_message();
    });
  }

  void refuse_message() {
    is_stream_ = false;
    is_waiting_ = true;  // for the other side to agree; it may give way meanwhile
    websocket_->async_close({websocket::close_code::policy_error, "no message but the token is taken"},
                            [self = shared_from_this()](beast::error_code /*fault*/) { self->close(); });
  }

  void write_values(const Text& values, Clock::time_point now) {
    is_writing_ = true;
    write_began_ = now;
    websocket_->text(true);
    websocket_->async_write(asio::buffer(*values),
                            [self = shared_from_this(), values](beast::error_code fault, std::size_t /*bytes*/) {
                              self->is_writing_ = false;
                              if (fault) {
                                return self->close();
                              }
                              add(self->host_.counters().sent);
                            });
  }

  Host& host_;
  std::uint64_t number_;
  std::optional<beast::tcp_stream> stream_;  ///< moved into the WebSocket when it becomes one
  std::optional<websocket::stream<beast::tcp_stream>> websocket_;
  beast::flat_buffer buffer_{16'384};
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
  beast::flat_buffer message_{longest_message};
  Clock::time_point since_{};
  Clock::time_point write_began_{};
  std::string session_{};  ///< empty: it is none
  bool is_waiting_ = false;
  bool is_stream_ = false;
  bool is_writing_ = false;
  bool is_closed_ = false;
};

tcp protocol_of(const Endpoint& endpoint) {
  return endpoint.address.find(':') == std::string::npos ? tcp::v4() : tcp::v6();
}

}  // namespace

class Server::Loop final : public Host {
 public:
  Loop(PointDoor& door, const Subject& subject, const ServerOptions& options)
      : door_(door), options_(options), responder_(door, subject, options.access) {
    check_access(options.endpoint, options.access);
    listener_.emplace(options.endpoint.address, options.endpoint.port, Place{}, options.tell);
    listen();
    tick(Clock::now());
    thread_ = std::thread([this] { run(); });
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  Loop(Loop&&) = delete;
  Loop& operator=(Loop&&) = delete;
  ~Loop() override {
    context_.stop();
    thread_.join();
    reader_.stop();
    reader_.join();
  }

  [[nodiscard]] std::uint16_t port() const { return listener_->port(); }
  [[nodiscard]] const Counters& counted() const { return counters_; }

 private:
  using Connections = std::map<std::uint64_t, std::shared_ptr<Connection>>;

  void run() {
    (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), niceness);
    while (!context_.stopped()) {
      try {
        context_.run();
      } catch (const std::exception&) {
        // One connection's handler had no memory: what it was about is lost, the others go on.
      }
    }
  }

  Responder& responder() override { return responder_; }
  Counters& counters() override { return counters_; }
  [[nodiscard]] const Limits& limits() const override { return options_.limits; }
  [[nodiscard]] bool has_room_for_a_stream() const override {
    return counters_.streams.load(std::memory_order_relaxed) < options_.limits.streams;
  }
  bool look_up(HistoryQuestion question, std::function<void(Answer)> done) override {
    if (looked_up_ >= most_questions) {
      return false;
    }
    ++looked_up_;
    asio::post(reader_, [this, question = std::move(question), done = std::move(done)]() mutable {
      Answer found = answer_of(question);
      asio::post(context_, [this, found = std::move(found), done = std::move(done)]() mutable {
        --looked_up_;
        done(std::move(found));
      });
    });
    return true;
  }
  void ended(std::uint64_t number) override {
    connections_.erase(number);
    count();
  }

  void count() {
    std::uint64_t streams = 0;
    for (const auto& [number, connection] : connections_) {
      streams += connection->is_stream() ? 1 : 0;
    }
    counters_.open.store(connections_.size(), std::memory_order_relaxed);
    counters_.streams.store(streams, std::memory_order_relaxed);
  }

  /// At once, or as soon as the address is there.
  void listen() {
    door_.shortage(Shortage::page, !listener_->is_open());
    if (listener_->is_open()) {
      acceptor_.emplace(context_, protocol_of(options_.endpoint),
                        ::fcntl(listener_->socket().number(), F_DUPFD_CLOEXEC, 0));
      accept();
      return;
    }
    pause_.expires_at(*listener_->next_try());
    pause_.async_wait([this](beast::error_code /*fault*/) {
      (void)listener_->try_again(Clock::now());
      listen();
    });
  }

  void accept() {
    acceptor_->async_accept([this](beast::error_code fault, tcp::socket socket) {
      if (fault) {
        // No descriptor left, most often: it would spin on a connection that it cannot take.
        pause_.expires_after(accept_pause);
        pause_.async_wait([this](beast::error_code /*fault*/) { accept(); });
        return;
      }
      accept();
      take(std::move(socket));
    });
  }

  void take(tcp::socket socket) {
    if (connections_.size() >= options_.limits.connections && !make_room()) {
      add(counters_.refused_full);
      return;
    }
    const std::uint64_t number = next_number_++;
    const auto connection = std::make_shared<Connection>(*this, number, std::move(socket));
    connections_.emplace(number, connection);
    add(counters_.accepted);
    count();
    connection->begin();
  }

  /// The connection that has owed its request for longest is closed; false where none owes one.
  bool make_room() {
    std::shared_ptr<Connection> oldest;
    for (const auto& [number, connection] : connections_) {
      if (connection->is_waiting() && (!oldest || connection->since() < oldest->since())) {
        oldest = connection;
      }
    }
    if (oldest) {
      add(counters_.gave_way);
      oldest->close();
    }
    return oldest != nullptr;
  }

  void tick(Clock::time_point due) {
    const auto next = std::max(due + options_.limits.interval, Clock::now());
    timer_.expires_at(next);
    timer_.async_wait([this, next](beast::error_code /*fault*/) {
      tick(next);
      send_values();
    });
  }

  void send_values() {
    count();
    if (counters_.streams.load(std::memory_order_relaxed) == 0) {
      return;
    }
    door_.read_live(live_);
    const auto values = std::make_shared<const std::string>(values_text(live_));
    const auto now = Clock::now();
    // A stream that is closed leaves the list.
    for (auto next = connections_.begin(); next != connections_.end();) {
      const std::shared_ptr<Connection> connection = (next++)->second;
      if (connection->is_stream()) {
        connection->offer(values, now);
      }
    }
  }

  PointDoor& door_;
  const ServerOptions options_;
  Responder responder_;
  Counters counters_;
  LiveValues live_{};
  std::uint64_t next_number_ = 0;
  std::optional<modbus::Listener> listener_{};
  asio::io_context context_{1};
  asio::steady_timer timer_{context_};
  asio::steady_timer pause_{context_};
  std::optional<tcp::acceptor> acceptor_;
  Connections connections_;
  std::size_t looked_up_ = 0;    ///< questions that wait for the history, or are answered
  asio::thread_pool reader_{1};  ///< of the history
  std::thread thread_;
};

Server::Server(PointDoor& door, const Subject& subject, const ServerOptions& options)
    : loop_(std::make_unique<Loop>(door, subject, options)) {}

Server::~Server() = default;

std::uint16_t Server::port() const {
  return loop_->port();
}

ServerStatus Server::status() const {
  const Counters& now = loop_->counted();
  return {.open = now.open,
          .streams = now.streams,
          .accepted = now.accepted,
          .refused_full = now.refused_full,
          .gave_way = now.gave_way,
          .answers = now.answers,
          .sent = now.sent,
          .dropped = now.dropped,
          .unread = now.unread};
}

}  // namespace hysteron::runtime::web
