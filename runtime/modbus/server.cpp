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
#include "runtime/modbus/descriptor.hpp"
#include "runtime/modbus/listen.hpp"
#include "runtime/modbus/transport.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::uint64_t listening_mark = 0;
constexpr std::uint64_t stop_mark = 1;
constexpr std::uint64_t first_client = 2;
constexpr int accepted_a_turn = 16;  // so that a storm of connections leaves time for those that are served
constexpr milliseconds accept_pause{100};

/// Written by the server's thread alone.
struct Counters {
  using Count = std::atomic<std::uint64_t>;
  Count open{0}, accepted{0}, refused_full{0}, refused_share{0}, refused_address{0}, requests{0}, exceptions{0},
      writes{0}, closed_by_client{0}, client_lost{0};
  std::array<Count, endings> ended{};
};

void add(std::atomic<std::uint64_t>& count, std::uint64_t more = 1) {
  count.store(count.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

std::vector<Network> networks(const ServerOptions& options) {
  Diagnostics diagnostics;
  std::vector<Network> list;
  for (const std::string& text : options.allow) {
    if (const auto network = Network::parse(text)) {
      list.push_back(*network);
    } else {
      diagnostics.error(error::malformed_allow_list, options.place, fmt::format("{} is no network.", text),
                        "write an address and the bits that count, with zeros behind them: 192.168.10.0/24");
    }
  }
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  return list;
}

}  // namespace

class Server::Loop {
 public:
  Loop(RegisterMap map, PointDoor& door, ServerOptions options)
      : tls_(std::move(options.tls)),
        options_(std::move(options)),
        map_(std::move(map)),
        responder_(map_, door, options_.identity),
        allow_(networks(options_)),
        heartbeat_(options_.heartbeat),
        listening_(listen_on(options_.listen, options_.port, options_.place)),
        port_(port_of(listening_)),
        stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
    if (!stop_.is_open() || !epoll_.is_open() || !watch(listening_, listening_mark, EPOLLIN) ||
        !watch(stop_, stop_mark, EPOLLIN)) {
      throw std::system_error(errno, std::system_category(), "Modbus server");
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
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const RegisterMap& map() const { return map_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

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
      for (int i = 0; i < count; ++i) {
        const epoll_event& event = events.at(static_cast<std::size_t>(i));
        if (event.data.u64 == stop_mark) {
          return;
        }
        if (event.data.u64 == listening_mark) {
          accept_some(now);
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
      follow_heartbeat(now);
      if (listen_again_ && now >= *listen_again_) {
        listen_again_.reset();
        change_watch(listening_, listening_mark, EPOLLIN);
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
      Descriptor socket(
          ::accept4(listening_.number(), reinterpret_cast<sockaddr*>(&peer), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (!socket.is_open()) {
        if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
          change_watch(listening_, listening_mark, 0);  // or the loop would spin on a connection it cannot take
          listen_again_ = now + accept_pause;
        }
        return;
      }
      if (!is_allowed(allow_, peer)) {
        add(counters_.refused_address);
      } else if (clients_.size() >= options_.connections) {
        add(counters_.refused_full);
      } else if (has_its_share(peer)) {
        add(counters_.refused_share);
        tell_of_refusal(
            peer,
            fmt::format("a connection beyond the {} of connections_per_address.", options_.connections_per_address),
            now);
      } else {
        take(std::move(socket), peer, now);
      }
    }
  }

  [[nodiscard]] bool has_its_share(const sockaddr_storage& peer) const {
    const auto count =
        std::ranges::count(clients_, origin_of(peer), [](const auto& client) { return client.second.origin; });
    return options_.connections_per_address > 0 && static_cast<std::size_t>(count) >= options_.connections_per_address;
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
    if (const std::string why = responder_.take_refusal(); !why.empty()) {
      tell_of_refusal(client.peer, "by the program: " + why, now);
    }
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
    }
  }

  void forget(Clients::iterator place, Counters::Count& why) {
    add(why);
    heartbeat_.gone(place->first);
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
          tell_of_refusal(place->second.peer,
                          "by TLS: " + (failure.empty() ? "the handshake took too long." : failure + "."), now);
        }
        forget(place, counters_.ended.at(static_cast<std::size_t>(*ending)));
      }
    }
  }

  /// Once a second: whoever is refused cannot fill a log.
  void tell_of_refusal(const sockaddr_storage& peer, const std::string& why, Instant now) {
    if (!options_.client_refused || (told_ && now < *told_ + std::chrono::seconds(1))) {
      ++untold_;
      return;
    }
    options_.client_refused(fmt::format("{} is refused {}{}", address_text(peer), why,
                                        untold_ > 0 ? fmt::format(" {} others before.", untold_) : ""));
    told_ = now;
    untold_ = 0;
  }

  void follow_heartbeat(Instant now) {
    const bool lost = heartbeat_.is_lost(now);
    if (lost != (counters_.client_lost.load(std::memory_order_relaxed) != 0)) {
      counters_.client_lost.store(lost ? 1 : 0, std::memory_order_relaxed);
      if (options_.client_lost) {
        options_.client_lost(lost);
      }
    }
  }

  std::atomic<std::shared_ptr<const TlsContext>> tls_;
  const ServerOptions options_;  ///< but for TLS, which is renewed
  const RegisterMap map_;
  Responder responder_;
  const std::vector<Network> allow_;
  Heartbeat heartbeat_;
  Counters counters_;
  Descriptor listening_;
  std::uint16_t port_;
  Descriptor stop_;
  Descriptor epoll_;
  Clients clients_;
  std::uint64_t next_mark_ = first_client;
  std::optional<Instant> listen_again_;
  std::vector<std::uint64_t> shaking_;  ///< in a handshake, with bytes to read, in this turn
  std::uint64_t last_shaken_ = 0;
  std::optional<Instant> told_;  ///< when a refusal was told last
  std::uint64_t untold_ = 0;
  std::thread thread_;
};

Server::Server(RegisterMap map, PointDoor& door, const ServerOptions& options)
    : loop_(std::make_unique<Loop>(std::move(map), door, options)) {}

Server::~Server() = default;

void Server::renew(std::shared_ptr<const TlsContext> tls) {
  loop_->renew(std::move(tls));
}

std::uint16_t Server::port() const {
  return loop_->port();
}
const RegisterMap& Server::map() const {
  return loop_->map();
}

ServerStatus Server::status() const {
  const Counters& now = loop_->counters();
  const auto ended = [&](Ending why) { return now.ended.at(static_cast<std::size_t>(why)).load(); };
  return {.open = now.open,
          .accepted = now.accepted,
          .refused_full = now.refused_full,
          .refused_share = now.refused_share,
          .refused_address = now.refused_address,
          .requests = now.requests,
          .exceptions = now.exceptions,
          .writes = now.writes,
          .closed_by_client = now.closed_by_client,
          .frame_late = ended(Ending::frame_late),
          .idle = ended(Ending::idle),
          .unread = ended(Ending::unread),
          .wrong_protocol = ended(Ending::wrong_protocol),
          .wrong_length = ended(Ending::wrong_length),
          .handshake_late = ended(Ending::handshake_late),
          .tls_failed = ended(Ending::tls_failed),
          .client_lost = now.client_lost != 0};
}

}  // namespace hysteron::runtime::modbus
