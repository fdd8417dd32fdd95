// Clients that do a server harm, by intent or by a fault, and a victim that wants to be served beside them.
//
// The server under attack has 32 holding registers of 16 bits that may be written. The first 16 hold a pattern that
// nobody may change: what attackers send as writes are requests that a server must not carry out. The victim writes to
// register 20 alone.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "runtime/point.hpp"

struct ssl_ctx_st;

namespace hysteron::test {

inline constexpr std::size_t served_registers = 32;
inline constexpr std::size_t pattern_registers = 16;

/// What register i of the pattern holds.
constexpr std::uint16_t pattern_of(std::size_t i) {
  return static_cast<std::uint16_t>(0x1000 + 257 * i);
}

/// The registers as points.
[[nodiscard]] std::vector<runtime::Point> registers_to_serve();

struct Hostile {
  std::size_t connections = 1100;  ///< of the client that opens as many as it can
  ssl_ctx_st* tls = nullptr;       ///< what clients bring along, where the server wants TLS
};

struct Attack {
  std::string name;
  std::function<void(std::uint16_t port, const std::stop_token& stop, const Hostile& how)> run;
};

/// The attacks, as the table of results lists them; the first is none. Each through TLS where `how` has it.
[[nodiscard]] const std::vector<Attack>& attacks();
/// What can be done to TLS besides.
[[nodiscard]] const std::vector<Attack>& tls_attacks();
[[nodiscard]] std::vector<std::string> names_of(const std::vector<Attack>& attacks);

/// Waits for so long, or until it is asked to stop.
void wait(const std::stop_token& stop, std::chrono::milliseconds time);

struct VictimResult {
  std::uint64_t requests = 0;
  std::uint64_t errors = 0;         ///< no answer in time, closed, refused
  std::uint64_t wrong = 0;          ///< answers with a value that nobody may have written, or not to the request
  std::vector<double> latencies{};  ///< seconds, of the answers that came
};

/// The victim polls 200 times a second while the attack goes on. The patience is for one answer.
[[nodiscard]] VictimResult victim_beside(const std::string& attack, std::uint16_t port, std::chrono::milliseconds time,
                                         std::chrono::milliseconds patience, const Hostile& hostile);

}  // namespace hysteron::test
