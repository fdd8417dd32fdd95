#include "runtime/modbus/client_link.hpp"

#include <modbus/modbus.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <thread>

#include "runtime/modbus/frame.hpp"
#include "runtime/modbus/rtu_frame.hpp"

namespace hysteron::runtime::modbus {
namespace {

template <class Pointer>
modbus_t* of(const Pointer& context) {
  return static_cast<modbus_t*>(context.get());
}

/// How long it waits is the caller's; the response time is for the whole answer, however it drips.
void set_patience(modbus_t* context, std::chrono::milliseconds response) {
  if (context != nullptr) {
    const auto microseconds = static_cast<std::uint32_t>(std::chrono::microseconds(response).count());
    ::modbus_set_response_timeout(context, microseconds / 1'000'000, microseconds % 1'000'000);
    ::modbus_set_byte_timeout(context, 0, 0);
  }
}

constexpr std::size_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::size_t>(bytes[at]) << 8U | bytes[at + 1];
}

/// The turn on a serial line. One who was stopped in the middle would keep it for ever, and the guard has to write
/// then: after the time that two exchanges may take, the line is used all the same.
class Turn {
 public:
  Turn(int line, std::chrono::milliseconds response) : line_(line) {
    using Clock = std::chrono::steady_clock;
    const auto longest = Clock::now() + 2 * response;
    while (::flock(line_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK && Clock::now() < longest) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  Turn(Turn&&) = delete;
  Turn& operator=(Turn&&) = delete;
  ~Turn() { ::flock(line_, LOCK_UN); }

 private:
  int line_;
};

}  // namespace

std::string text_of(const std::variant<TcpLink, SerialLink>& link) {
  const auto* const tcp = std::get_if<TcpLink>(&link);
  return tcp == nullptr ? std::get<SerialLink>(link).path : tcp->host + ":" + std::to_string(tcp->port);
}

void ClientLink::Free::operator()(void* context) const {
  ::modbus_free(static_cast<modbus_t*>(context));
}

ClientLink::ClientLink(const std::variant<TcpLink, SerialLink>& to, std::chrono::milliseconds response)
    : serial_(std::holds_alternative<SerialLink>(to)),
      has_echo_(serial_ && std::get<SerialLink>(to).has_echo),
      response_(response) {
  if (const auto* const tcp = std::get_if<TcpLink>(&to)) {
    name_.emplace(tcp->host, tcp->known);
    port_ = std::to_string(tcp->port);
    return;
  }
  const auto& line = std::get<SerialLink>(to);
  context_.reset(::modbus_new_rtu(line.path.c_str(), line.baud, line.parity, line.data_bits, line.stop_bits));
  set_patience(of(context_), response_);
}

ClientLink::~ClientLink() {
  close();
}

bool ClientLink::open() {
  const std::scoped_lock turn(turns_);
  return open_ || connect();
}

bool ClientLink::aim_at(const std::string& address) {
  if (address.empty()) {
    return false;
  }
  if (address != aimed_at_) {
    const std::scoped_lock lock(socket_lock_);
    context_.reset(::modbus_new_tcp_pi(address.c_str(), port_.c_str()));
    set_patience(of(context_), response_);
    aimed_at_ = address;
  }
  return true;
}

bool ClientLink::connect() {
  // libmodbus would ask the name server itself, and wait for it as long as the system does.
  if (name_ && !aim_at(name_->next_address(response_))) {
    return false;
  }
  if (context_ == nullptr || ::modbus_connect(of(context_)) != 0) {
    return false;
  }
  const std::scoped_lock lock(socket_lock_);
  // libmodbus waits by select, which has room for descriptors below FD_SETSIZE alone.
  open_ = !interrupted_ && ::modbus_get_socket(of(context_)) < FD_SETSIZE;
  if (!open_) {
    ::modbus_close(of(context_));
  } else if (name_) {
    name_->was_reached();
  }
  return open_;
}

void ClientLink::close() {
  const std::scoped_lock lock(socket_lock_);
  if (open_) {
    ::modbus_close(of(context_));
    open_ = false;
  }
}

void ClientLink::interrupt() {
  const std::scoped_lock lock(socket_lock_);
  interrupted_ = true;
  if (open_ && !serial_) {
    ::shutdown(::modbus_get_socket(of(context_)), SHUT_RDWR);
  }
}

Exchange ClientLink::exchange(std::uint8_t unit, std::span<const std::uint8_t> request,
                              std::vector<std::uint8_t>& answer) {
  const std::scoped_lock lock(turns_);
  if (!open_ && !connect()) {
    return Exchange::no_link;
  }
  std::optional<Turn> turn;
  if (serial_) {
    turn.emplace(::modbus_get_socket(of(context_)), response_);
  }
  const Exchange outcome = transfer(unit, request, answer);
  turn.reset();
  if (outcome != Exchange::answered && outcome != Exchange::exception) {
    close();
  }
  return outcome;
}

/// What an adapter of RS-485 gives back. Other bytes: two spoke at once.
Exchange ClientLink::take_echo(std::span<const std::uint8_t> sent) {
  using Clock = std::chrono::steady_clock;
  const int line = ::modbus_get_socket(of(context_));
  const auto longest = Clock::now() + response_;
  std::array<std::uint8_t, longest_rtu_frame> bytes{};
  for (std::size_t got = 0; got < sent.size();) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(longest - Clock::now()).count();
    pollfd one{line, POLLIN, 0};
    if (left <= 0 || ::poll(&one, 1, static_cast<int>(left)) <= 0) {
      return Exchange::timeout;
    }
    const ssize_t count = ::read(line, bytes.data(), sent.size() - got);
    if (count <= 0) {
      return Exchange::closed;
    }
    const auto part = std::span(bytes).first(static_cast<std::size_t>(count));
    if (!std::equal(part.begin(), part.end(), sent.begin() + static_cast<std::ptrdiff_t>(got))) {
      return Exchange::wrong_answer;
    }
    got += part.size();
  }
  return Exchange::answered;
}

Exchange ClientLink::send(std::uint8_t unit, std::span<const std::uint8_t> request) {
  if (serial_) {
    ::modbus_set_slave(of(context_), unit);  // or libmodbus passes its answer over
    ::modbus_flush(of(context_));            // noise between two transactions
    const std::vector<std::uint8_t> frame = rtu_frame(unit, request);
    const auto without_checksum = static_cast<int>(frame.size() - 2);
    if (::modbus_send_raw_request(of(context_), frame.data(), without_checksum) <= 0) {
      return Exchange::closed;
    }
    return has_echo_ ? take_echo(frame) : Exchange::answered;
  }
  const int socket = ::modbus_get_socket(of(context_));
  char unasked = 0;
  const ssize_t pending = ::recv(socket, &unasked, 1, MSG_PEEK | MSG_DONTWAIT);
  if (pending >= 0) {
    return pending == 0 ? Exchange::closed : Exchange::wrong_answer;
  }
  const auto header = header_of({.transaction = ++transaction_, .unit = unit}, request.size());
  std::vector<std::uint8_t> frame(header.begin(), header.end());
  frame.insert(frame.end(), request.begin(), request.end());
  const ssize_t sent = ::send(socket, frame.data(), frame.size(), MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(frame.size()) ? Exchange::answered : Exchange::closed;
}

Exchange ClientLink::transfer(std::uint8_t unit, std::span<const std::uint8_t> request,
                              std::vector<std::uint8_t>& answer) {
  if (const Exchange flaw = send(unit, request); flaw != Exchange::answered) {
    return flaw;
  }
  const auto sent = std::chrono::steady_clock::now();
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> bytes{};
  const int size = ::modbus_receive_confirmation(of(context_), bytes.data());
  if (size < 0) {
    return errno == ETIMEDOUT                                      ? Exchange::timeout
           : errno == EMBBADCRC                                    ? Exchange::bad_checksum
           : errno == ECONNRESET || errno == EBADF || errno == EIO ? Exchange::closed
                                                                   : Exchange::wrong_answer;
  }
  // Where this thread was not run meanwhile, an answer that came too late is there all the same: its age is not known.
  if (std::chrono::steady_clock::now() - sent > response_) {
    return Exchange::timeout;
  }
  const std::span<const std::uint8_t> got(bytes.data(), static_cast<std::size_t>(size));
  if (serial_) {
    if (got.size() < 5 || got[0] != unit) {
      return Exchange::wrong_answer;
    }
    answer.assign(got.begin() + 1, got.end() - 2);
  } else {
    const FrameScan scan = scan_frame(got);
    if (scan.status != FrameStatus::complete || scan.size != got.size() || scan.frame.transaction != transaction_ ||
        scan.frame.unit != unit) {
      return Exchange::wrong_answer;
    }
    answer.assign(scan.frame.pdu.begin(), scan.frame.pdu.end());
  }
  if (answer.size() == 2 && answer[0] == (request[0] | 0x80U)) {
    return Exchange::exception;
  }
  return answers_request(request, answer) ? Exchange::answered : Exchange::wrong_answer;
}

bool answers_request(std::span<const std::uint8_t> request, std::span<const std::uint8_t> answer) {
  if (answer.size() < 2 || answer[0] != request[0]) {
    return false;
  }
  if (request[0] <= 4) {
    const std::size_t count = word_at(request, 3);
    const std::size_t bytes = request[0] <= 2 ? (count + 7) / 8 : 2 * count;
    return answer[1] == bytes && answer.size() == 2 + bytes;
  }
  return answer.size() == 5 && std::equal(answer.begin(), answer.end(), request.begin());
}

}  // namespace hysteron::runtime::modbus
