#include "runtime/modbus/transport.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <utility>

#include "runtime/modbus/tls_session.hpp"

namespace hysteron::runtime::modbus {
namespace {

Moved moved(ssize_t result, bool end_is_gone) {
  if (result > 0) {
    return {.count = static_cast<std::size_t>(result)};
  }
  const bool later = result < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
  return {.blocked = true, .gone = result == 0 ? end_is_gone : !later};
}

Moved receive_bytes(const Descriptor& socket, std::span<std::uint8_t> into) {
  return into.empty() ? Moved{} : moved(::recv(socket.number(), into.data(), into.size(), 0), true);
}

Moved send_bytes(const Descriptor& socket, std::span<const std::uint8_t> bytes) {
  return bytes.empty() ? Moved{} : moved(::send(socket.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL), false);
}

class PlainTransport final : public Transport {
 public:
  Moved receive(const Descriptor& socket, std::span<std::uint8_t> into, Instant /*now*/) override {
    return receive_bytes(socket, into);
  }
  Moved send(const Descriptor& socket, std::span<const std::uint8_t> bytes) override {
    return send_bytes(socket, bytes);
  }
};

class TlsTransport final : public Transport {
 public:
  TlsTransport(std::shared_ptr<const TlsContext> context, const ConnectionLimits& limits, Instant now)
      : context_(std::move(context)), session_(*context_, limits, now) {}

  Moved receive(const Descriptor& socket, std::span<std::uint8_t> into, Instant now) override {
    std::array<std::uint8_t, 4096> buffer{};
    const auto line = std::span(buffer).first(std::min(buffer.size(), session_.wants_input()));
    const Moved got = receive_bytes(socket, line);
    if (got.count > 0) {
      session_.received(line.first(got.count), now);
    }
    const std::size_t count = session_.read(into);
    return {.count = count, .gone = count == 0 && (got.gone || session_.is_closed())};
  }

  Moved send(const Descriptor& socket, std::span<const std::uint8_t> bytes) override {
    Moved flushed = flush(socket);
    if (flushed.blocked || bytes.empty()) {
      return flushed;
    }
    const std::size_t taken = session_.write(bytes);
    flushed = flush(socket);
    // Taken bytes are on their way, even where they wait for the socket.
    return {.count = taken, .blocked = taken == 0 || flushed.blocked, .gone = flushed.gone};
  }

  [[nodiscard]] bool is_in_handshake() const override { return !session_.is_established(); }
  [[nodiscard]] bool wants_input() const override { return session_.wants_input() > 0; }
  [[nodiscard]] bool has_buffered() const override { return session_.has_buffered() || session_.is_closed(); }
  [[nodiscard]] bool has_output() const override { return !session_.output().empty(); }
  [[nodiscard]] Rights rights() const override { return session_.rights(); }
  [[nodiscard]] std::string failure() const override { return session_.failure(); }
  [[nodiscard]] std::optional<Ending> due(Instant now) const override { return session_.due(now); }
  [[nodiscard]] std::optional<Instant> next_deadline() const override { return session_.next_deadline(); }

 private:
  Moved flush(const Descriptor& socket) {
    while (!session_.output().empty()) {
      const Moved sent = send_bytes(socket, session_.output());
      if (sent.count == 0) {
        return sent;
      }
      session_.sent(sent.count);
    }
    return {};
  }

  std::shared_ptr<const TlsContext> context_;  ///< as long as the session: the server may have another by then
  TlsSession session_;
};

}  // namespace

std::unique_ptr<Transport> make_transport(std::shared_ptr<const TlsContext> tls, const ConnectionLimits& limits,
                                          Instant now) {
  if (tls != nullptr) {
    return std::make_unique<TlsTransport>(std::move(tls), limits, now);
  }
  return std::make_unique<PlainTransport>();
}

}  // namespace hysteron::runtime::modbus
