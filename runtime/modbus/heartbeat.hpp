// Whether the client that the machine depends on is still there, and which client owns the writes. Pure functions of
// telegrams and a given now.
//
// The heartbeat is that of fieldbus couplers: after the first telegram that counts, the next must follow within the
// time; if not, the client is lost, until a telegram that counts comes again. What counts is any telegram, or only one
// that writes. Where writes are owned, the first client that writes owns them until it goes or is lost, and the
// telegrams that count are its own.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "runtime/modbus/connection.hpp"

namespace hysteron::runtime::modbus {

enum class HeartbeatMode : std::uint8_t { off, any_telegram, write_telegram };

struct HeartbeatOptions {
  HeartbeatMode mode = HeartbeatMode::off;
  milliseconds time{1000};
  bool own_writes = false;  ///< other clients than the owner may not write
};

class Heartbeat {
 public:
  explicit Heartbeat(const HeartbeatOptions& options) : options_(options) {}

  /// A client's requests were answered; `wrote` if one of them was a write that was taken.
  void telegram(std::uint64_t client, bool wrote, Instant now) {
    if (wrote && options_.own_writes && !owner_) {
      owner_ = client;
    }
    const bool counts =
        options_.mode == HeartbeatMode::any_telegram || (options_.mode == HeartbeatMode::write_telegram && wrote);
    if (counts && (!owner_ || *owner_ == client)) {
      last_ = now;
      lost_ = false;
    }
  }

  void gone(std::uint64_t client) {
    if (owner_ == client) {
      owner_.reset();
    }
  }

  /// To be asked as time goes by. A lost owner owns nothing any more.
  bool is_lost(Instant now) {
    if (last_ && now >= *last_ + options_.time) {
      lost_ = true;
      last_.reset();
      owner_.reset();
    }
    return lost_;
  }

  [[nodiscard]] bool writes_are_owned() const { return owner_.has_value(); }
  [[nodiscard]] bool owns_writes(std::uint64_t client) const { return owner_ == client; }
  [[nodiscard]] bool other_owns_writes(std::uint64_t client) const { return owner_.value_or(client) != client; }
  [[nodiscard]] std::optional<Instant> next_deadline() const {
    return last_ ? std::optional(*last_ + options_.time) : std::nullopt;
  }

 private:
  HeartbeatOptions options_;
  std::optional<std::uint64_t> owner_;
  std::optional<Instant> last_;  ///< the last telegram that counts; none before the first and while lost
  bool lost_ = false;
};

}  // namespace hysteron::runtime::modbus
