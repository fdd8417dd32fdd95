// One client's TLS, as a function of the bytes it sent and of a given now. No sockets.
//
// Bytes of the line come in by `received` and go out by `output`; those of Modbus come out by `read` and go in by
// `write`. A record that has begun must be whole within the frame deadline, and the handshake within its own, however
// slowly its bytes drip. Buffers are bounded: nothing is taken from the line while what came is not read, or while the
// client does not take what it is sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "runtime/modbus/connection.hpp"
#include "runtime/modbus/tls_context.hpp"

struct ssl_st;

namespace hysteron::runtime::modbus {

/// Where the records of TLS begin and end in a stream: a type, a version, a length of two bytes, and so many bytes.
class RecordScan {
 public:
  /// How many records ended within the bytes.
  std::size_t take(std::span<const std::uint8_t> bytes);
  [[nodiscard]] bool is_within() const { return header_ > 0 || left_ > 0; }

 private:
  std::size_t header_ = 0;  ///< bytes of a header that is not whole
  std::size_t length_ = 0;
  std::size_t left_ = 0;  ///< of a record whose header is
};

class TlsSession {
 public:
  /// The context must outlive the session.
  TlsSession(const TlsContext& context, const ConnectionLimits& limits, Instant now);

  /// How many bytes of the line may be given to `received` now.
  [[nodiscard]] std::size_t wants_input() const;
  void received(std::span<const std::uint8_t> bytes, Instant now);
  /// Bytes of Modbus that came; how many were put there.
  std::size_t read(std::span<std::uint8_t> into);
  /// Whether `read` may give more without another `received`.
  [[nodiscard]] bool has_buffered() const;

  /// Takes bytes of Modbus; how many it took: none while earlier output waits, or before the handshake is done.
  std::size_t write(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::span<const std::uint8_t> output() const;
  void sent(std::size_t count);

  [[nodiscard]] bool is_established() const { return established_; }
  /// The client said that nothing more comes.
  [[nodiscard]] bool is_closed() const { return closed_; }
  /// Nothing before the handshake is done.
  [[nodiscard]] const Rights& rights() const { return rights_; }
  /// Why it failed, in words for a log; empty where it did not.
  [[nodiscard]] const std::string& failure() const { return failure_; }

  [[nodiscard]] std::optional<Ending> due(Instant now) const;
  [[nodiscard]] std::optional<Instant> next_deadline() const;

 private:
  struct Free {
    void operator()(ssl_st* session) const;
  };
  void shake_hands();
  /// What a call of the library came to, where it gave nothing.
  void heed(int result);

  const TlsContext& context_;
  ConnectionLimits limits_;
  std::unique_ptr<ssl_st, Free> session_;
  RecordScan records_;
  std::optional<Instant> record_began_;
  Instant began_;
  Rights rights_ = no_rights;
  std::string failure_;
  bool established_ = false;
  bool closed_ = false;
};

}  // namespace hysteron::runtime::modbus
