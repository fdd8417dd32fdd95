#include "runtime/modbus/tls_session.hpp"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace hysteron::runtime::modbus {
namespace {

constexpr std::size_t record_header = 5;
constexpr std::size_t input_bytes = 4096;  // of the line that are taken at once
constexpr std::size_t most_output =
    32'768;                        // beyond which nothing more is taken: it answers no client that does not read
constexpr int records_a_read = 8;  // so that a turn is short even where each of them is a new key

int as_int(std::size_t size) {
  return static_cast<int>(std::min<std::size_t>(size, std::numeric_limits<int>::max()));
}

}  // namespace

std::size_t RecordScan::take(std::span<const std::uint8_t> bytes) {
  std::size_t ended = 0;
  while (!bytes.empty()) {
    if (left_ > 0) {
      const std::size_t count = std::min(left_, bytes.size());
      left_ -= count;
      bytes = bytes.subspan(count);
      ended += left_ == 0 ? 1 : 0;
      continue;
    }
    length_ = header_ + 2 < record_header ? 0 : length_ << 8U | bytes.front();
    ++header_;
    bytes = bytes.subspan(1);
    if (header_ == record_header) {
      header_ = 0;
      left_ = length_;
      ended += left_ == 0 ? 1 : 0;
    }
  }
  return ended;
}

void TlsSession::Free::operator()(ssl_st* session) const {
  SSL_free(session);
}

TlsSession::TlsSession(const TlsContext& context, const ConnectionLimits& limits, Instant now)
    : context_(context), limits_(limits), session_(SSL_new(context.context())), began_(now) {
  BIO* const input = BIO_new(BIO_s_mem());
  BIO* const output = BIO_new(BIO_s_mem());
  if (session_ == nullptr || input == nullptr || output == nullptr) {
    BIO_free(input);
    BIO_free(output);
    throw std::bad_alloc();
  }
  BIO_set_mem_eof_return(input, -1);  // an empty buffer is no end
  BIO_set_mem_eof_return(output, -1);
  SSL_set_bio(session_.get(), input, output);
  SSL_set_accept_state(session_.get());
}

std::size_t TlsSession::wants_input() const {
  const bool is_open = failure_.empty() && !closed_;
  return is_open && !has_buffered() && output().size() < most_output ? input_bytes : 0;
}

void TlsSession::received(std::span<const std::uint8_t> bytes, Instant now) {
  if (records_.take(bytes) > 0 || !records_.is_within()) {
    record_began_.reset();
  }
  if (records_.is_within() && !record_began_) {
    record_began_ = now;
  }
  BIO_write(SSL_get_rbio(session_.get()), bytes.data(), as_int(bytes.size()));
  if (!established_) {
    shake_hands();
  }
}

void TlsSession::shake_hands() {
  ERR_clear_error();
  const int result = SSL_do_handshake(session_.get());
  if (result != 1) {
    heed(result);
    return;
  }
  established_ = true;
  if (const X509* const certificate = SSL_get0_peer_certificate(session_.get())) {
    rights_ = context_.rights_of(*certificate);
  }
}

void TlsSession::heed(int result) {
  switch (SSL_get_error(session_.get(), result)) {
    case SSL_ERROR_WANT_READ:
    case SSL_ERROR_WANT_WRITE:
      return;
    case SSL_ERROR_ZERO_RETURN:
      closed_ = true;
      return;
    default:
      break;
  }
  const unsigned long code = ERR_peek_error();
  const long verified = SSL_get_verify_result(session_.get());
  const char* const text =
      !established_ && verified != X509_V_OK ? X509_verify_cert_error_string(verified) : ERR_reason_error_string(code);
  failure_ = text != nullptr ? text : "the line failed";
  ERR_clear_error();
}

std::size_t TlsSession::read(std::span<std::uint8_t> into) {
  std::size_t count = 0;
  for (int record = 0; record < records_a_read && established_ && failure_.empty() && !closed_ && count < into.size();
       ++record) {
    ERR_clear_error();
    const int got = SSL_read(session_.get(), into.data() + count, as_int(into.size() - count));
    if (got > 0) {
      count += static_cast<std::size_t>(got);
    } else {
      heed(got);
      if (BIO_ctrl_pending(SSL_get_rbio(session_.get())) == 0) {
        break;
      }
    }
  }
  return count;
}

bool TlsSession::has_buffered() const {
  return established_ && failure_.empty() && !closed_ &&
         (SSL_pending(session_.get()) > 0 || BIO_ctrl_pending(SSL_get_rbio(session_.get())) > 0);
}

std::size_t TlsSession::write(std::span<const std::uint8_t> bytes) {
  if (!established_ || !failure_.empty() || bytes.empty() || !output().empty()) {
    return 0;
  }
  ERR_clear_error();
  const int taken = SSL_write(session_.get(), bytes.data(), as_int(bytes.size()));
  if (taken <= 0) {
    heed(taken);
    return 0;
  }
  return static_cast<std::size_t>(taken);
}

std::span<const std::uint8_t> TlsSession::output() const {
  char* bytes = nullptr;
  const long count = BIO_get_mem_data(SSL_get_wbio(session_.get()), &bytes);
  return {reinterpret_cast<const std::uint8_t*>(bytes), static_cast<std::size_t>(std::max<long>(count, 0))};
}

void TlsSession::sent(std::size_t count) {
  std::array<char, 4096> gone{};
  while (count > 0) {
    const int read = BIO_read(SSL_get_wbio(session_.get()), gone.data(), as_int(std::min(count, gone.size())));
    if (read <= 0) {
      return;
    }
    count -= static_cast<std::size_t>(read);
  }
}

std::optional<Ending> TlsSession::due(Instant now) const {
  if (!failure_.empty()) {
    return Ending::tls_failed;
  }
  if (record_began_ && now >= *record_began_ + limits_.frame_deadline) {
    return Ending::frame_late;
  }
  if (!established_ && now >= began_ + limits_.handshake) {
    return Ending::handshake_late;
  }
  return std::nullopt;
}

std::optional<Instant> TlsSession::next_deadline() const {
  std::optional<Instant> next;
  if (!established_) {
    next = began_ + limits_.handshake;
  }
  if (record_began_) {
    const Instant late = *record_began_ + limits_.frame_deadline;
    next = next ? std::min(*next, late) : late;
  }
  return next;
}

}  // namespace hysteron::runtime::modbus
