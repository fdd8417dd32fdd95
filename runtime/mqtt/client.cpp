#include "runtime/mqtt/client.hpp"

#include <fmt/format.h>
#include <mosquitto.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "support/descriptor.hpp"

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int keep_alive = 10;             ///< seconds without a word, after which the library asks for one
constexpr std::size_t most_received = 16;  ///< that wait to be looked at
constexpr std::size_t longest_received = std::size_t{64} * 1024;

void begin_library() {
  static std::once_flag once;
  std::call_once(once, [] { (void)::mosquitto_lib_init(); });
}

/// Nobody is there to type the password of a key.
int no_password(char* /*buffer*/, int /*size*/, int /*writes*/, void* /*user*/) {
  return 0;
}

/// The library ends its texts with a full stop.
std::string without_stop(std::string text) {
  while (text.ends_with('.')) {
    text.pop_back();
  }
  return text;
}

MqttFault mqtt_fault(int result, MqttFault otherwise) {
  return result == MOSQ_ERR_TLS || result == MOSQ_ERR_TLS_HANDSHAKE ? MqttFault::Tls : otherwise;
}

}  // namespace

void ignore_broken_pipes() {
  sigset_t signals;
  (void)::sigemptyset(&signals);
  (void)::sigaddset(&signals, SIGPIPE);
  (void)::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

/// What the library's callbacks write. It is used by one thread at a time: that which connects, then that of the
/// client.
struct MqttClient::Connection {
  Connection(const MqttLink& its_link, const MqttMessage& will);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { ::mosquitto_destroy(handle); }

  void connect();
  [[nodiscard]] std::string reason(int code, int cause) const;

  MqttLink link;
  mosquitto* handle;
  Descriptor begun;
  std::atomic<bool> has_begun{false};
  int result = 0;  ///< of connecting
  int system = 0;  ///< errno of connecting
  bool is_connected = false;
  int refusal = 0;
  std::string last_error{};
  std::vector<int> confirmed{};
  std::vector<std::string> received{};
};

MqttClient::Connection::Connection(const MqttLink& its_link, const MqttMessage& will)
    : link(its_link),
      handle((begin_library(), ::mosquitto_new(its_link.client_id.c_str(), true, this))),
      begun(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (handle == nullptr || !begun.is_open()) {
    const int cause = errno;
    ::mosquitto_destroy(handle);
    throw MqttError(MqttFault::Unreachable, std::generic_category().message(cause));
  }
  (void)::mosquitto_int_option(handle, MOSQ_OPT_SEND_MAXIMUM, 65535);  // what is on its way is bounded by the caller
  ::mosquitto_connect_callback_set(handle, [](mosquitto*, void* self, int code) {
    auto& connection = *static_cast<Connection*>(self);
    connection.is_connected = code == 0;
    connection.refusal = code;
  });
  ::mosquitto_publish_callback_set(
      handle, [](mosquitto*, void* self, int number) { static_cast<Connection*>(self)->confirmed.push_back(number); });
  ::mosquitto_unsubscribe_callback_set(
      handle, [](mosquitto*, void* self, int number) { static_cast<Connection*>(self)->confirmed.push_back(number); });
  ::mosquitto_message_callback_set(handle, [](mosquitto*, void* self, const mosquitto_message* message) {
    auto& list = static_cast<Connection*>(self)->received;
    const auto size = static_cast<std::size_t>(std::max(message->payloadlen, 0));
    if (list.size() < most_received && size <= longest_received) {
      list.emplace_back(static_cast<const char*>(message->payload), size);
    }
  });
  // Of what the library logs, its errors alone: they name the reasons of TLS, and no password.
  ::mosquitto_log_callback_set(handle, [](mosquitto*, void* self, int level, const char* text) {
    if (level == MOSQ_LOG_ERR) {
      static_cast<Connection*>(self)->last_error = text;
    }
  });
  (void)::mosquitto_will_set(handle, will.topic.c_str(), static_cast<int>(will.payload.size()), will.payload.data(),
                             will.qos, will.retain);
  if (!link.user.empty()) {
    (void)::mosquitto_username_pw_set(handle, link.user.c_str(),
                                      link.password.empty() ? nullptr : link.password.c_str());
  }
  link.password.clear();
}

/// In a thread of its own.
void MqttClient::Connection::connect() {
  ignore_broken_pipes();
  result = link.authority.empty() ? MOSQ_ERR_SUCCESS
                                  : ::mosquitto_tls_set(handle, link.authority.c_str(), nullptr,
                                                        link.certificate.empty() ? nullptr : link.certificate.c_str(),
                                                        link.key.empty() ? nullptr : link.key.c_str(), no_password);
  if (result == MOSQ_ERR_INVAL) {
    result = MOSQ_ERR_TLS;  // a file that cannot be read
    last_error = "a file of certificates or keys cannot be read";
  }
  if (result == MOSQ_ERR_SUCCESS) {
    errno = 0;
    result = ::mosquitto_connect(handle, link.broker.c_str(), link.port, keep_alive);
  }
  system = errno;
  has_begun.store(true, std::memory_order_release);
  (void)::eventfd_write(begun.number(), 1);
}

std::string MqttClient::Connection::reason(int code, int cause) const {
  if (code == MOSQ_ERR_ERRNO && cause != 0) {
    return std::generic_category().message(cause);
  }
  if (code == MOSQ_ERR_EAI || code == MOSQ_ERR_LOOKUP) {
    return "its name is not known";
  }
  if (code == MOSQ_ERR_KEEPALIVE) {
    return "it has not said a word for long";  // the library has no text for that
  }
  return without_stop(last_error.empty() ? ::mosquitto_strerror(code) : last_error);
}

MqttClient::MqttClient(const MqttLink& link, const MqttMessage& will)
    : connection_(std::make_shared<Connection>(link, will)), asked_(steady_clock::now()) {
  try {
    std::thread([connection = connection_] { connection->connect(); }).detach();
  } catch (const std::system_error& problem) {
    throw MqttError(MqttFault::Unreachable, problem.what());
  }
}

MqttClient::~MqttClient() = default;

void MqttClient::check(int result, MqttFault fault) const {
  if (result > MOSQ_ERR_SUCCESS) {
    const int cause = errno;
    throw MqttError(mqtt_fault(result, fault), connection_->reason(result, cause));
  }
}

bool MqttClient::is_connected() const {
  return has_begun_ && connection_->is_connected;
}

bool MqttClient::is_late() const {
  return !has_begun_ && steady_clock::now() - asked_ > connection_->link.patience;
}

void MqttClient::wait_for_begin(milliseconds wait, int wake) {
  Connection& c = *connection_;
  if (!c.has_begun.load(std::memory_order_acquire)) {
    std::array<pollfd, 2> ends{{{c.begun.number(), POLLIN, 0}, {wake, POLLIN, 0}}};
    (void)::poll(ends.data(), ends.size(), static_cast<int>(wait.count()));
    if (!c.has_begun.load(std::memory_order_acquire)) {
      return;
    }
  }
  has_begun_ = true;
  asked_ = steady_clock::now();
  if (c.result > MOSQ_ERR_SUCCESS) {
    throw MqttError(mqtt_fault(c.result, MqttFault::Unreachable), c.reason(c.result, c.system));
  }
}

void MqttClient::turn(milliseconds wait, int wake) {
  if (!has_begun_) {
    return wait_for_begin(wait, wake);
  }
  Connection& c = *connection_;
  const MqttFault fault = c.is_connected ? MqttFault::Lost : MqttFault::Unreachable;
  if (!c.is_connected && steady_clock::now() - asked_ > c.link.patience) {
    throw MqttError(fault, fmt::format("no answer to the greeting within {} s", c.link.patience.count() / 1000));
  }
  c.last_error.clear();
  const int socket = ::mosquitto_socket(c.handle);
  check(socket < 0 ? MOSQ_ERR_CONN_LOST : MOSQ_ERR_SUCCESS, fault);
  const short events = ::mosquitto_want_write(c.handle) ? POLLIN | POLLOUT : POLLIN;
  std::array<pollfd, 2> ends{{{socket, events, 0}, {wake, POLLIN, 0}}};
  (void)::poll(ends.data(), ends.size(), static_cast<int>(wait.count()));
  if ((ends[0].revents & (POLLIN | POLLERR | POLLHUP)) != 0) {
    const int result = ::mosquitto_loop_read(c.handle, 100);
    if (c.refusal != 0) {
      throw MqttError(MqttFault::Refused, without_stop(::mosquitto_connack_string(c.refusal)));
    }
    check(result, fault);
  }
  if ((ends[0].revents & POLLOUT) != 0) {
    check(::mosquitto_loop_write(c.handle, 1), fault);
  }
  check(::mosquitto_loop_misc(c.handle), fault);
}

int MqttClient::publish(const MqttMessage& message) {
  int number = 0;
  check(
      ::mosquitto_publish(connection_->handle, &number, message.topic.c_str(), static_cast<int>(message.payload.size()),
                          message.payload.data(), message.qos, message.retain),
      MqttFault::Lost);
  return number;
}

int MqttClient::subscribe(const std::string& topic) {
  int number = 0;
  check(::mosquitto_subscribe(connection_->handle, &number, topic.c_str(), 1), MqttFault::Lost);
  return number;
}

int MqttClient::fence() {
  int number = 0;
  check(::mosquitto_unsubscribe(connection_->handle, &number, "hysteron/fence"), MqttFault::Lost);
  return number;
}

void MqttClient::disconnect() {
  (void)::mosquitto_disconnect(connection_->handle);
}

std::vector<int> MqttClient::confirmed() {
  return std::exchange(connection_->confirmed, {});
}

std::vector<std::string> MqttClient::received() {
  return std::exchange(connection_->received, {});
}

bool MqttClient::is_empty() const {
  return !::mosquitto_want_write(connection_->handle);
}

}  // namespace hysteron::runtime
