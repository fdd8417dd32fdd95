// What clients can do to TLS itself. Those who have a certificate are hostile as well.
#include <openssl/ssl.h>

#include <array>
#include <memory>
#include <thread>

#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"

namespace hysteron::test {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds patience{700};

/// What a client says first, as the library would.
Bytes client_hello(ssl_ctx_st* tls) {
  const std::unique_ptr<ssl_st, decltype(&SSL_free)> session(SSL_new(tls), SSL_free);
  SSL_set_bio(session.get(), BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
  SSL_set_connect_state(session.get());
  SSL_do_handshake(session.get());
  Bytes bytes(4096);
  const int size = BIO_read(SSL_get_wbio(session.get()), bytes.data(), static_cast<int>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max(size, 0)));
  return bytes;
}

void stall(std::uint16_t port, const std::stop_token& stop, const Hostile& how) {
  const Bytes hello = client_hello(how.tls);
  while (!stop.stop_requested()) {
    std::vector<std::unique_ptr<ClientSocket>> sockets;
    for (std::size_t i = 0; i < 20; ++i) {  // a third nothing, a third half a record, a third a whole one
      sockets.push_back(std::make_unique<ClientSocket>(port, patience));
      sockets.back()->send(std::span(hello).first(i % 3 * hello.size() / 2));
    }
    wait(stop, milliseconds(500));
  }
}

void drip(std::uint16_t port, const std::stop_token& stop, const Hostile& how) {
  const Bytes hello = client_hello(how.tls);
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, patience);
    for (std::size_t i = 0; i < hello.size() && !stop.stop_requested(); ++i) {
      if (!socket.send(std::span(hello).subspan(i, 1))) {
        break;
      }
      wait(stop, milliseconds(20));
    }
  }
}

void half_record(std::uint16_t port, const std::stop_token& stop, const Hostile& how) {
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, patience, how.tls);
    constexpr std::array<std::uint8_t, 9> half{23, 3, 3, 0, 64, 1, 2, 3, 4};
    (void)::send(socket.number(), half.data(), half.size(), MSG_NOSIGNAL);
    wait(stop, milliseconds(100));
  }
}

/// Records that carry nothing: in TLS 1.2 a new handshake, in 1.3 a new key, each asking for an answer.
void again_and_again(std::uint16_t port, const std::stop_token& stop, const Hostile& how, int version) {
  while (!stop.stop_requested()) {
    const std::unique_ptr<ssl_ctx_st, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
    SSL_CTX_set_max_proto_version(context.get(), version);
    SSL_CTX_use_certificate(context.get(), SSL_CTX_get0_certificate(how.tls));
    SSL_CTX_use_PrivateKey(context.get(), SSL_CTX_get0_privatekey(how.tls));
    const ClientSocket socket(port, patience, context.get());
    bool open = socket.connected();
    while (open && !stop.stop_requested()) {
      const bool asked = version == TLS1_2_VERSION ? SSL_renegotiate(socket.tls()) == 1
                                                   : SSL_key_update(socket.tls(), SSL_KEY_UPDATE_REQUESTED) == 1;
      open = asked && SSL_do_handshake(socket.tls()) == 1;
    }
  }
}

void shake_hands_and_go(std::uint16_t port, const std::stop_token& stop, ssl_ctx_st* tls) {
  while (!stop.stop_requested()) {
    ClientSocket socket(port, patience, tls);
    socket.reset();
  }
}

void without_certificate(std::uint16_t port, const std::stop_token& stop) {
  const std::unique_ptr<ssl_ctx_st, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, patience, context.get());
    socket.send(framed(1, {6, 0, 5, 0xDE, 0xAD}));
    (void)socket.receive_frame();
  }
}

void in_the_clear(std::uint16_t port, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, patience);
    socket.send(framed(1, {6, 0, 5, 0xDE, 0xAD}));
    (void)socket.sees_the_end();
  }
}

}  // namespace

const std::vector<Attack>& tls_attacks() {
  using Port = std::uint16_t;
  using Stop = const std::stop_token&;
  using How = const Hostile&;
  static const std::vector<Attack> list{
      {"stalls in the handshake", stall},
      {"drips a handshake", drip},
      {"half a record", half_record},
      {"renegotiates", [](Port port, Stop stop, How how) { again_and_again(port, stop, how, TLS1_2_VERSION); }},
      {"updates keys", [](Port port, Stop stop, How how) { again_and_again(port, stop, how, TLS1_3_VERSION); }},
      {"handshakes and goes", [](Port port, Stop stop, How how) { shake_hands_and_go(port, stop, how.tls); }},
      {"no certificate", [](Port port, Stop stop, How) { without_certificate(port, stop); }},
      {"Modbus in the clear", [](Port port, Stop stop, How) { in_the_clear(port, stop); }},
  };
  return list;
}

}  // namespace hysteron::test
