// One connection to an MQTT broker, over libmosquitto. Only its source sees the library.
//
// Nothing here waits for the network but turn(), and that for as long as it is told. Looking up a name and connecting
// may take minutes in the system's calls: they run in a thread of their own, which has nothing of ours but the
// connection, and may outlive the client.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/mqtt/dialect.hpp"

namespace hysteron::runtime {

/// As point task.mqtt_fault says it.
enum class MqttFault : std::uint16_t { None, Unreachable, Refused, Tls, Lost, File };

class MqttError : public std::runtime_error {
 public:
  MqttError(MqttFault fault, const std::string& text) : std::runtime_error(text), fault_(fault) {}
  [[nodiscard]] MqttFault fault() const { return fault_; }

 private:
  MqttFault fault_;
};

struct MqttLink {
  std::string broker{};  ///< name or address
  std::uint16_t port = 1883;
  std::string authority{};    ///< a file in PEM with those who sign the broker's certificate; empty: no TLS
  std::string certificate{};  ///< of the client, with its key; both empty where it shows none
  std::string key{};
  std::string client_id{};
  std::string user{};  ///< empty: none is said
  std::string password{};
  std::chrono::milliseconds patience{10'000};  ///< for an answer of the broker
};

/// Of the calling thread: a broker that closes must not end the process.
void ignore_broken_pipes();

class MqttClient {
 public:
  /// Begins to connect.
  MqttClient(const MqttLink& link, const MqttMessage& will);
  MqttClient(const MqttClient&) = delete;
  MqttClient& operator=(const MqttClient&) = delete;
  ~MqttClient();

  /// Lets what has come in, and what is to go out, do so. Waits up to `wait` for it, and no longer than until `wake`, a
  /// descriptor, can be read; -1: none. Throws MqttError where the connection failed, is refused, or broke.
  void turn(std::chrono::milliseconds wait, int wake);
  /// The broker has answered, and takes messages.
  [[nodiscard]] bool is_connected() const;
  /// The system has taken longer to connect than a broker may take to answer, and goes on.
  [[nodiscard]] bool is_late() const;

  // Once connected. Each gives a number, which confirmed() tells when the broker has answered. Throw MqttError.
  int publish(const MqttMessage& message);
  int subscribe(const std::string& topic);
  /// A question to the broker that asks for nothing. Brokers take what comes by one connection in order, so its answer
  /// confirms what went before, also where that has quality of service 0.
  int fence();
  /// Says farewell; what waits to go out goes with the next turns.
  void disconnect();

  /// Numbers, each once.
  [[nodiscard]] std::vector<int> confirmed();
  /// What came in on topics that it subscribed to, each once.
  [[nodiscard]] std::vector<std::string> received();
  /// Nothing waits to go out.
  [[nodiscard]] bool is_empty() const;

 private:
  struct Connection;

  void wait_for_begin(std::chrono::milliseconds wait, int wake);
  void check(int result, MqttFault fault) const;

  std::shared_ptr<Connection> connection_;
  std::chrono::steady_clock::time_point asked_;
  bool has_begun_ = false;
};

}  // namespace hysteron::runtime
