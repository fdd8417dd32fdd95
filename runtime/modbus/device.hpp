// A remote Modbus device whose values the task reads and writes: a thread of its own, so that a device that is slow or
// dead delays nobody but itself. read() and write() take no lock and call nothing of the system but the clock.
//
//   connecting → running → (anything but the exact answer) → waiting → connecting …
//
// The wait before the next attempt doubles up to a limit and is short again after an exchange that went well. On a new
// link writes go first, and what failed before goes last, so that a value that can be written arrives whatever else
// fails. Every value has an age and a quality; the last good value stays readable, and it is for the task to say what
// it does without.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "runtime/modbus/client_link.hpp"
#include "runtime/modbus/register_map.hpp"

namespace hysteron::runtime::modbus {

struct RemoteValue {
  Stretch at{};  ///< the count follows from the format
  PointFormat format{.type = PointType::uint16};
  PointType of = PointType::real64;         ///< of the input or output: a value that is none of it is not taken
  bool written = false;                     ///< sent to the device every period, once it has a value; else read from it
  std::chrono::nanoseconds longest_age{0};  ///< beyond that it is old; 0: ten periods, or the response time
  double low = -std::numeric_limits<double>::infinity();  ///< of what is read: what is outside is not taken
  double high = std::numeric_limits<double>::infinity();
  friend bool operator==(const RemoteValue&, const RemoteValue&) = default;
};

struct DeviceOptions {
  std::string name{};
  std::variant<TcpLink, SerialLink> link{};
  std::uint8_t unit = 1;
  bool may_be_absent = false;      ///< while it has never answered, the task goes on without it
  bool shares_connection = false;  ///< over TCP, with the other devices at this host and port that share it
  std::vector<RemoteValue> values{};
  std::chrono::nanoseconds period = std::chrono::milliseconds(5);
  std::chrono::milliseconds response{200};   ///< for a whole answer, and for a connection
  std::chrono::milliseconds first_wait{50};  ///< before the second attempt; doubled for each further one
  std::chrono::milliseconds longest_wait{2000};
  friend bool operator==(const DeviceOptions&, const DeviceOptions&) = default;
};

/// Who works for a device, and whether it may write.
struct DeviceWork {
  bool own_thread = true;              ///< else the owner calls round()
  std::function<bool()> may_write{};   ///< asked before every write, in the thread that writes; none: it may
  std::shared_ptr<ClientLink> link{};  ///< that it shares with others; none: one of its own
};

enum class Quality : std::uint8_t {
  never,    ///< not good since the start
  good,     ///< read, or taken by the device, and not old
  old,      ///< the link is up, but the value did not come for its longest age
  refused,  ///< the device answered the last request with an exception, or with a value that is not taken
  lost,     ///< no link
};

struct RemoteReading {
  double value = 0.0;
  Quality quality = Quality::never;
  std::chrono::nanoseconds age{0};  ///< since it was good; since the start where it never was
};

enum class LinkState : std::uint8_t { connecting, running, waiting };

struct DeviceStatus {
  LinkState state = LinkState::connecting;
  std::uint64_t connections = 0;
  std::uint64_t answers = 0;
  std::uint64_t exceptions = 0;
  std::uint64_t no_link = 0;
  std::uint64_t timeouts = 0;
  std::uint64_t closed = 0;
  std::uint64_t wrong_answers = 0;
  std::uint64_t bad_checksums = 0;
};

/// By device, the link that it shares with others; null where it has its own.
[[nodiscard]] std::vector<std::shared_ptr<ClientLink>> shared_links(std::span<const DeviceOptions> devices);

class Device {
 public:
  /// Begins at once. A register of which bits are written is written whole, its other bits as 0. Throws
  /// std::invalid_argument where a value is written to an area that can only be read, or is no boolean among bits.
  explicit Device(const DeviceOptions& options, DeviceWork work = {});
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  Device(Device&&) = delete;
  Device& operator=(Device&&) = delete;
  /// What was written last is sent once more where there is a link. Ends within twice the response time.
  ~Device();

  [[nodiscard]] RemoteReading read(std::size_t value) const;
  void write(std::size_t value, double number);
  /// Whether the device took this number within the longest age of the value, even where the link was lost since.
  [[nodiscard]] bool has_taken(std::size_t value, double number) const;
  /// From any thread; nobody is waited for.
  [[nodiscard]] DeviceStatus status() const noexcept;
  /// Values that were read and not taken: beyond their limits, not finite, none of their format or of their input.
  [[nodiscard]] std::uint64_t not_taken() const noexcept;
  /// The age beyond which a value is old.
  [[nodiscard]] std::chrono::nanoseconds longest_age(std::size_t value) const;
  /// Without a thread: connects where there is no link, and exchanges every value once; waits for the answers. False
  /// where the link is lost.
  bool round();

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace hysteron::runtime::modbus
