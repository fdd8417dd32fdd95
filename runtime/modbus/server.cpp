#include "runtime/modbus/server.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "runtime/modbus/allow_list.hpp"
#include "runtime/modbus/listen.hpp"
#include "runtime/modbus/listener.hpp"
#include "runtime/modbus/server_counters.hpp"
#include "runtime/modbus/transport.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::uint64_t listening_mark = 0;
constexpr std::uint64_t stop_mark = 1;
constexpr std::uint64_t line_mark = 2;
constexpr std::uint64_t first_client = 3;
constexpr int accepted_a_turn = 16;  // so that a storm of connections leaves time for those that are served
constexpr milliseconds accept_pause{100};

}  // namespace

class Server::Loop {
 public:
  Loop(RegisterMap map, PointDoor& door, ServerOptions options)
      : tls_(std::move(options.tls)),
        options_(std::move(options)),
        map_(std::make_shared<const RegisterMap>(std::move(map))),
        served_(map_.load()),
        door_(door),
        responder_(*served_, door, options_.identity),
        allow_(networks_of(options_.allow, options_.place)),
        heartbeat_(options_.heartbeat),
        stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
    if (!stop_.is_open() || !epoll_.is_open() || !watch(stop_, stop_mark, EPOLLIN)) {
      throw std::system_error(errno, std::system_category(), "Modbus server");
    }
    if (!options_.listen.empty()) {
      listener_.emplace(options_.listen, options_.port, options_.place, options_.tell);
      watch_listener();
    }
    if (options_.rtu) {
      line_.emplace(*options_.rtu, options_.tell);
    }
    thread_ = std::thread([this] { run(); });
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  Loop(Loop&&) = delete;
  Loop& operator=(Loop&&) = delete;
  ~Loop() {
    ::eventfd_write(stop_.number(), 1);
    thread_.join();
  }

  void renew(std::shared_ptr<const TlsContext> tls) { tls_.store(std::move(tls)); }
  void show(RegisterMap map) {
    map_.store(std::make_shared<const RegisterMap>(std::move(map)));
    has_other_map_.store(true);
  }
  [[nodiscard]] std::uint16_t port() const { return listener_ ? listener_->port() : std::uint16_t{0}; }
  [[nodiscard]] std::shared_ptr<const RegisterMap> map() const { return map_.load(); }
  [[nodiscard]] const ServerCounters& counters() const { return counters_; }

 private:
  struct Client {
    Descriptor socket;
    sockaddr_storage peer{};
    std::optional<AddressBytes> origin{};
    std::unique_ptr<Transport> transport;
    Connection connection;
    std::uint32_t watched = EPOLLIN;

    [[nodiscard]] bool has_more() const { return transport->has_buffered() && connection.wants_input() > 0; }
  };
  using Clients = std::map<std::uint64_t, Client>;

  [[nodiscard]] bool watch(const Descriptor& what, std::uint64_t mark, std::uint32_t events) const {
    epoll_event event{};
    event.events = events;
    event.data.u64 = mark;
    return ::epoll_ctl(epoll_.number(), EPOLL_CTL_ADD, what.number(), &event) == 0;
  }
  void change_watch(const Descriptor& what, std::uint64_t mark, std::uint32_t events) const {
    epoll_event event{};
    event.events = events;
    event.data.u64 = mark;
    ::epoll_ctl(epoll_.number(), EPOLL_CTL_MOD, what.number(), &event);
  }

  void run() {
    std::array<epoll_event, 64> events{};
    while (true) {
      const int count = ::epoll_wait(epoll_.number(), events.data(), static_cast<int>(events.size()), wait_time());
      const Instant now = std::chrono::steady_clock::now();
      if (has_other_map_.load(std::memory_order_relaxed) && has_other_map_.exchange(false)) {
        const auto before = std::exchange(served_, map_.load());
        responder_.show(*served_);
      }
      for (int i = 0; i < count; ++i) {
        const epoll_event& event = events.at(static_cast<std::size_t>(i));
        if (event.data.u64 == stop_mark) {
          return;
        }
        if (event.data.u64 == listening_mark) {
          accept_some(now);
        } else if (event.data.u64 == line_mark) {
          serve_line((event.events & ~std::uint32_t{EPOLLOUT}) != 0, now);
        } else if (const auto client = clients_.find(event.data.u64); client == clients_.end()) {
          continue;
        } else if (client->second.transport->is_in_handshake()) {
          shaking_.push_back(client->first);
        } else {
          serve(client, now);
        }
      }
      serve_one_handshake(now);
      serve_what_is_buffered(now);
      end_what_is_due(now);
      follow_line(now);
      follow_heartbeat(now);
      if (listen_again_ && now >= *listen_again_) {
        listen_again_.reset();
        change_watch(listener_->socket(), listening_mark, EPOLLIN);
      }
      if (listener_ && listener_->try_again(now)) {
        watch_listener();
      }
    }
  }

  /// Milliseconds to the next deadline, rounded up; -1 where there is none.
  [[nodiscard]] int wait_time() const {
    std::optional<Instant> next = heartbeat_.next_deadline();
    const auto earlier = [&](Instant other) { next = next ? std::min(*next, other) : other; };
    for (const auto& [mark, client] : clients_) {
      if (client.has_more()) {
        return 0;
      }
      earlier(client.connection.next_deadline());
      if (const auto deadline = client.transport->next_deadline()) {
        earlier(*deadline);
      }
    }
    if (listen_again_) {
      earlier(*listen_again_);
    }
    if (const auto again = listener_ ? listener_->next_try() : std::nullopt) {
      earlier(*again);
    }
    if (const auto deadline = line_ ? line_->next_deadline() : std::nullopt) {
      earlier(*deadline);
    }
    if (!next) {
      return -1;
    }
    const auto left = std::chrono::ceil<milliseconds>(*next - std::chrono::steady_clock::now()).count();
    return static_cast<int>(std::clamp<std::int64_t>(left, 0, 60'000));
  }

  void accept_some(Instant now) {
    for (int i = 0; i < accepted_a_turn; ++i) {
      sockaddr_storage peer{};
      socklen_t size = sizeof peer;
      Descriptor socket(::accept4(listener_->socket().number(), reinterpret_cast<sockaddr*>(&peer), &size,
                                  SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (!socket.is_open()) {
        if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
          // Or the loop would spin on a connection it cannot take.
          change_watch(listener_->socket(), listening_mark, 0);
          listen_again_ = now + accept_pause;
        }
        return;
      }
      if (!is_allowed(allow_, peer)) {
        add(counters_.refused_address);
        tell_of_refusal(address_text(peer), "is refused by allow: no network there has this address.", now);
        continue;
      }
      const bool is_full = clients_.size() >= options_.connections;
      const bool has_share = has_its_share(peer);
      if (!(is_full || has_share) || make_room(peer, has_share, now)) {
        take(std::move(socket), peer, now);
      } else if (is_full) {
        add(counters_.refused_full);
        tell_of_refusal(
            address_text(peer),
            fmt::format("is refused a connection: the {} of connections are taken, each by a client that asks.",
                        clients_.size()),
            now);
      } else {
        add(counters_.refused_share);
        tell_of_refusal(address_text(peer),
                        fmt::format("is refused a connection beyond the {} of connections_per_address.",
                                    options_.connections_per_address),
                        now);
      }
    }
  }

  [[nodiscard]] bool has_its_share(const sockaddr_storage& peer) const {
    const auto count =
        std::ranges::count(clients_, origin_of(peer), [](const auto& client) { return client.second.origin; });
    return options_.connections_per_address > 0 && static_cast<std::size_t>(count) >= options_.connections_per_address;
  }

  /// A place for a client: of one at its own address, where that has its share, else of anyone. Who owns the writes
  /// keeps it.
  bool make_room(const sockaddr_storage& peer, bool of_its_own, Instant now) {
    const auto origin = origin_of(peer);
    auto longest = clients_.end();
    for (auto place = clients_.begin(); place != clients_.end(); ++place) {
      const Client& client = place->second;
      const bool may_go = now - client.connection.silent_since() >= options_.evict &&
                          !heartbeat_.owns_writes(place->first) && (!of_its_own || client.origin == origin);
      if (may_go &&
          (longest == clients_.end() || client.connection.silent_since() < longest->second.connection.silent_since())) {
        longest = place;
      }
    }
    if (longest == clients_.end()) {
      return false;
    }
    forget(longest, counters_.evicted);
    return true;
  }

  void watch_listener() {
    const bool listens = listener_->is_open() && watch(listener_->socket(), listening_mark, EPOLLIN);
    door_.shortage(Shortage::address, !listens);
  }

  /// The serial line: opened where that is due, and served where a silence on it has lasted.
  void follow_line(Instant now) {
    if (!line_) {
      return;
    }
    if (line_->open_when_due(now)) {
      line_watched_ = EPOLLIN;
      (void)watch(line_->descriptor(), line_mark, line_watched_);
    }
    door_.shortage(Shortage::line, !line_->is_open());
    if (const auto deadline = line_->next_deadline(); line_->is_open() && deadline && now >= *deadline) {
      serve_line(false, now);
    }
  }

  void serve_line(bool is_readable, Instant now) {
    if (!line_ || !line_->is_open()) {
      return;
    }
    const Rights all{};
    const Caller caller{.rights = options_.read_only || line_->read_only() ? all.without_writes() : all,
                        .other_owns_writes = heartbeat_.other_owns_writes(line_mark)};
    count(line_mark, line_->serve(is_readable, now, responder_, caller), now);
    tell_what_was_met([&] { return "the serial line " + options_.rtu->line.path; }, now);
    const RtuCounts& counts = line_->counts();
    counters_.line_frames.store(counts.frames, std::memory_order_relaxed);
    counters_.line_broken.store(counts.broken, std::memory_order_relaxed);
    counters_.line_broadcasts.store(counts.broadcasts, std::memory_order_relaxed);
    counters_.line_echo_lost.store(counts.echo_lost, std::memory_order_relaxed);
    if (!line_->is_open()) {
      heartbeat_.gone(line_mark);
      return;
    }
    const std::uint32_t events = std::uint32_t{EPOLLIN} | (line_->is_blocked() ? std::uint32_t{EPOLLOUT} : 0U);
    if (std::exchange(line_watched_, events) != events) {
      change_watch(line_->descriptor(), line_mark, events);
    }
  }

  void take(Descriptor socket, const sockaddr_storage& peer, Instant now) {
    const int on = 1;
    ::setsockopt(socket.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const std::uint64_t mark = next_mark_++;
    if (watch(socket, mark, EPOLLIN)) {
      clients_.emplace(mark, Client{.socket = std::move(socket),
                                    .peer = peer,
                                    .origin = origin_of(peer),
                                    .transport = make_transport(tls_.load(), options_.limits, now),
                                    .connection = Connection(now, options_.limits)});
      add(counters_.accepted);
      counters_.open.store(clients_.size(), std::memory_order_relaxed);
    }
  }

  /// One of those that are in a handshake and have sent something; the others keep until the next turns, in turn.
  void serve_one_handshake(Instant now) {
    if (shaking_.empty()) {
      return;
    }
    std::ranges::sort(shaking_);
    const auto next = std::ranges::upper_bound(shaking_, last_shaken_);
    last_shaken_ = next == shaking_.end() ? shaking_.front() : *next;
    shaking_.clear();
    serve(clients_.find(last_shaken_), now);
  }

  /// What one record brought may be more than one turn takes.
  void serve_what_is_buffered(Instant now) {
    for (auto next = clients_.begin(); next != clients_.end();) {
      const auto place = next++;
      if (place->second.has_more()) {
        serve(place, now);
      }
    }
  }

  void serve(Clients::iterator place, Instant now) {
    auto& [mark, client] = *place;
    std::array<std::uint8_t, 4 * longest_frame> buffer{};
    const std::size_t wanted = client.connection.wants_input();
    const auto input = std::span(buffer).first(wanted);
    const Moved got = wanted > 0 ? client.transport->receive(client.socket, input, now) : Moved{};
    if (got.gone) {
      return forget(place, counters_.closed_by_client);
    }
    const Rights rights = client.transport->rights();
    const Caller caller{.rights = options_.read_only ? rights.without_writes() : rights,
                        .other_owns_writes = heartbeat_.other_owns_writes(mark)};
    count(mark, client.connection.received(input.first(got.count), now, responder_, caller), now);
    while (!client.connection.output().empty() || client.transport->has_output()) {
      const Moved sent = client.transport->send(client.socket, client.connection.output());
      if (sent.gone) {
        return forget(place, counters_.closed_by_client);
      }
      client.connection.sent(sent.count, now);
      count(mark, client.connection.resume(now, responder_, caller), now);
      if (sent.blocked) {
        break;
      }
    }
    tell_what_was_met([&] { return address_text(client.peer); }, now);
    const bool has_output = !client.connection.output().empty() || client.transport->has_output();
    const bool wants_input = client.connection.wants_input() > 0 && client.transport->wants_input();
    const std::uint32_t events =
        (wants_input ? std::uint32_t{EPOLLIN} : 0U) | (has_output ? std::uint32_t{EPOLLOUT} : 0U);
    if (events != client.watched) {
      client.watched = events;
      change_watch(client.socket, mark, events);
    }
  }

  void count(std::uint64_t mark, const Served& served, Instant now) {
    if (served.requests > 0) {
      add(counters_.requests, served.requests);
      add(counters_.exceptions, served.exceptions);
      add(counters_.writes, served.writes);
      heartbeat_.telegram(mark, served.writes > 0, now);
      tell_of_owner();
    }
  }

  /// Who writes by another way has to know, and before the client has the answer to the write that made it the owner.
  void tell_of_owner() {
    if (std::exchange(told_owned_, heartbeat_.writes_are_owned()) != heartbeat_.writes_are_owned()) {
      door_.writes_are_owned(told_owned_);
    }
  }

  void forget(Clients::iterator place, ServerCounters::Count& why) {
    add(why);
    heartbeat_.gone(place->first);
    std::erase(shaking_, place->first);
    clients_.erase(place);
    counters_.open.store(clients_.size(), std::memory_order_relaxed);
  }

  void end_what_is_due(Instant now) {
    for (auto next = clients_.begin(); next != clients_.end();) {
      const auto place = next++;
      const auto below = place->second.transport->due(now);
      if (const auto ending = below ? below : place->second.connection.due(now)) {
        if (*ending == Ending::tls_failed || *ending == Ending::handshake_late) {
          const std::string failure = place->second.transport->failure();
          tell_of_refusal(address_text(place->second.peer),
                          "is refused by TLS: " + (failure.empty() ? "the handshake took too long." : failure + "."),
                          now);
        }
        forget(place, counters_.ended.at(static_cast<std::size_t>(*ending)));
      }
    }
  }

  /// What the answers to a client met. `name` gives the client's, for it is seldom wanted.
  template <class Name>
  void tell_what_was_met(const Name& name, Instant now) {
    if (const std::string why = responder_.take_refusal(); !why.empty()) {
      tell_of_refusal(name(), "is refused by the program: " + why, now);
    }
    const std::uint64_t saturated = responder_.saturated();
    if (saturated != counters_.saturated.load(std::memory_order_relaxed) && options_.tell &&
        (!told_saturated_ || now >= *told_saturated_ + std::chrono::minutes(1))) {
      options_.tell(fmt::format(
          "{} is beyond what its registers hold, and clients read the nearest value that they do. Give it another type "
          "or scale under [registers].",
          served_->points()[responder_.saturated_point()].name));
      told_saturated_ = now;
    }
    counters_.saturated.store(saturated, std::memory_order_relaxed);
  }

  /// Once a second: whoever is refused cannot fill a log.
  void tell_of_refusal(const std::string& client, const std::string& how, Instant now) {
    if (!options_.tell || (told_ && now < *told_ + std::chrono::seconds(1))) {
      ++untold_;
      return;
    }
    options_.tell(fmt::format("{} {}{}", client, how, untold_ > 0 ? fmt::format(" {} others before.", untold_) : ""));
    told_ = now;
    untold_ = 0;
  }

  void follow_heartbeat(Instant now) {
    const bool lost = heartbeat_.is_lost(now);
    tell_of_owner();
    if (lost != (counters_.client_lost.load(std::memory_order_relaxed) != 0)) {
      counters_.client_lost.store(lost ? 1 : 0, std::memory_order_relaxed);
      if (options_.client_lost) {
        options_.client_lost(lost);
      }
    }
  }

  std::atomic<std::shared_ptr<const TlsContext>> tls_;
  const ServerOptions options_;  ///< but for TLS, which is renewed
  std::atomic<std::shared_ptr<const RegisterMap>> map_;
  std::shared_ptr<const RegisterMap> served_;  ///< in this thread
  std::atomic<bool> has_other_map_{false};
  PointDoor& door_;
  Responder responder_;
  const std::vector<Network> allow_;
  Heartbeat heartbeat_;
  bool told_owned_ = false;
  ServerCounters counters_;
  std::optional<Listener> listener_{};
  Descriptor stop_;
  Descriptor epoll_;
  Clients clients_;
  std::optional<RtuLine> line_;
  std::uint32_t line_watched_ = EPOLLIN;
  std::uint64_t next_mark_ = first_client;
  std::optional<Instant> listen_again_;
  std::vector<std::uint64_t> shaking_;  ///< in a handshake, with bytes to read, in this turn
  std::uint64_t last_shaken_ = 0;
  std::optional<Instant> told_;  ///< when a refusal was told last
  std::uint64_t untold_ = 0;
  std::optional<Instant> told_saturated_;
  std::thread thread_;
};

Server::Server(RegisterMap map, PointDoor& door, const ServerOptions& options)
    : loop_(std::make_unique<Loop>(std::move(map), door, options)) {}

Server::~Server() = default;

void Server::renew(std::shared_ptr<const TlsContext> tls) {
  loop_->renew(std::move(tls));
}

void Server::show(RegisterMap map) {
  loop_->show(std::move(map));
}

std::uint16_t Server::port() const {
  return loop_->port();
}
std::shared_ptr<const RegisterMap> Server::map() const {
  return loop_->map();
}

ServerStatus Server::status() const {
  return status_of(loop_->counters());
}

}  // namespace hysteron::runtime::modbus
