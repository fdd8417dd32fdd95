// A client on loopback for tests of servers, over TCP or TLS: sends what it likes, well-formed or not.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "support/descriptor.hpp"

namespace hysteron::test {

using Bytes = std::vector<std::uint8_t>;

class ClientSocket {
 public:
  /// Through TLS where a context is given; the handshake is done here. From another address of loopback where one is.
  explicit ClientSocket(std::uint16_t port, std::chrono::milliseconds patience = std::chrono::seconds(5),
                        ssl_ctx_st* tls = nullptr, in_addr_t from = INADDR_ANY)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), patience_(patience) {
    sockaddr_in peer{};
    peer.sin_family = AF_INET;
    peer.sin_port = htons(port);
    peer.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(from);
    (void)::bind(socket_.number(), reinterpret_cast<const sockaddr*>(&here), sizeof here);
    const int on = 1;
    ::setsockopt(socket_.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const auto seconds = std::chrono::floor<std::chrono::seconds>(patience);
    const timeval limit{seconds.count(), std::chrono::microseconds(patience - seconds).count()};
    ::setsockopt(socket_.number(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);  // of connect, too
    connected_ = ::connect(socket_.number(), reinterpret_cast<const sockaddr*>(&peer), sizeof peer) == 0;
    if (tls != nullptr && connected_) {
      ::setsockopt(socket_.number(), SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
      tls_.reset(SSL_new(tls));
      SSL_set_fd(tls_.get(), socket_.number());
      connected_ = SSL_connect(tls_.get()) == 1;
    }
  }

  [[nodiscard]] bool connected() const { return connected_; }

  /// False where the server has closed.
  bool send(std::span<const std::uint8_t> bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = send_some(bytes, 0);
      if (sent < 0 && errno != EINTR) {
        return false;
      }
      bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(sent, 0)));
    }
    return true;
  }

  /// What can be sent without waiting; false where the server has closed.
  bool send_without_waiting(std::span<const std::uint8_t> bytes) const {
    const ssize_t sent = send_some(bytes, MSG_DONTWAIT);
    return sent >= 0 || errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
  }

  /// Exactly so many bytes; fewer where the server closed or the patience is at an end.
  [[nodiscard]] Bytes receive(std::size_t count) const {
    Bytes bytes(count);
    std::size_t have = 0;
    const auto until = std::chrono::steady_clock::now() + patience_;
    while (have < count && readable(until)) {
      const ssize_t got = receive_some(std::span(bytes).subspan(have));
      if (got <= 0) {
        break;
      }
      have += static_cast<std::size_t>(got);
    }
    bytes.resize(have);
    return bytes;
  }

  /// An answer with its header; shorter where none came.
  [[nodiscard]] Bytes receive_frame() const {
    Bytes frame = receive(6);
    if (frame.size() == 6) {
      const Bytes rest = receive(frame[4] * 256U + frame[5]);
      frame.insert(frame.end(), rest.begin(), rest.end());
    }
    return frame;
  }

  /// Waits until the server closes; what it sends before is dropped. False where it does not.
  [[nodiscard]] bool sees_the_end() const {
    const auto until = std::chrono::steady_clock::now() + patience_;
    while (readable(until)) {
      Bytes bytes(4096);
      const ssize_t got = receive_some(bytes);
      if (got == 0 || (got < 0 && errno != EINTR)) {
        return true;
      }
    }
    return false;
  }

  /// So that answers that are not read soon fill what the system keeps for this client.
  void keep_little() const {
    const int bytes = 2048;
    ::setsockopt(socket_.number(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  }

  /// The socket below, past TLS.
  [[nodiscard]] int number() const { return socket_.number(); }
  [[nodiscard]] ssl_st* tls() const { return tls_.get(); }

  /// Closes with a reset instead of an end.
  void reset() {
    const linger now{1, 0};
    ::setsockopt(socket_.number(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
    socket_ = Descriptor();
  }

 private:
  struct Free {
    void operator()(ssl_st* session) const { SSL_free(session); }
  };

  /// As ::send. Through TLS, "would block" is told as there.
  [[nodiscard]] ssize_t send_some(std::span<const std::uint8_t> bytes, int flags) const {
    if (tls_ == nullptr) {
      return ::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL | flags);
    }
    if (!connected_) {
      errno = ENOTCONN;
      return -1;
    }
    if ((flags & MSG_DONTWAIT) != 0) {
      pollfd one{socket_.number(), POLLOUT, 0};
      if (::poll(&one, 1, 0) == 0) {
        errno = EAGAIN;
        return -1;
      }
    }
    errno = 0;
    const int sent = SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()));
    errno = sent <= 0 && errno == EINTR ? EPIPE : errno;
    return sent > 0 ? sent : -1;
  }

  /// As ::recv.
  [[nodiscard]] ssize_t receive_some(std::span<std::uint8_t> into) const {
    if (tls_ == nullptr) {
      return ::recv(socket_.number(), into.data(), into.size(), 0);
    }
    return connected_ ? std::max(SSL_read(tls_.get(), into.data(), static_cast<int>(into.size())), 0) : 0;
  }

  [[nodiscard]] bool readable(std::chrono::steady_clock::time_point until) const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()).count();
    pollfd one{socket_.number(), POLLIN, 0};
    if (tls_ != nullptr && SSL_pending(tls_.get()) > 0) {
      return true;
    }
    return left > 0 && ::poll(&one, 1, static_cast<int>(left)) > 0;
  }

  Descriptor socket_;
  std::chrono::milliseconds patience_;
  bool connected_ = false;
  std::unique_ptr<ssl_st, Free> tls_;
};

/// A request with its header.
inline Bytes framed(std::uint16_t transaction, std::initializer_list<int> pdu) {
  Bytes bytes{static_cast<std::uint8_t>(transaction >> 8U),
              static_cast<std::uint8_t>(transaction & 0xFFU),
              0,
              0,
              0,
              static_cast<std::uint8_t>(pdu.size() + 1),
              1};
  for (const int byte : pdu) {
    bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return bytes;
}

/// The answer to one request; empty where none came.
inline Bytes ask(const ClientSocket& client, const Bytes& request) {
  client.send(request);
  return client.receive_frame();
}

/// Reads holding register 0.
inline const Bytes read_one = framed(1, {3, 0, 0, 0, 1});

}  // namespace hysteron::test
