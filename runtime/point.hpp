// A point: one value of the running program that the outside may read or write, and the door through which servers
// reach all of them. What a point is called, measured in and limited to is said here once; register maps, the live page
// and refusals are derived.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hysteron::runtime {

enum class PointKind {
  input,      ///< a VAR_INPUT of the diagram
  output,     ///< a VAR_OUTPUT, after limits and fail-safe
  parameter,  ///< staged, then committed as a set
  status,     ///< what the task says of itself: cycles, lateness, state
  command,    ///< what a client asks of the task: commit, discard, reset, heartbeat
};

/// What a task cannot have now, and tries again while it controls: bits of task.shortages. None of them is a fault.
enum class Shortage : std::uint16_t {
  address = 1,   ///< the Modbus server listens on no address yet
  page = 2,      ///< nor does the live page
  line = 4,      ///< the serial line of the Modbus server cannot be used
  device = 8,    ///< a device with on_absence = "go_on" has not answered since the start
  tls = 16,      ///< task.tls_fault is not 0
  mqtt = 32,     ///< task.mqtt_fault is not 0
  history = 64,  ///< task.history_fault is not 0
  trace = 128,   ///< the trace is written to no file
  retain = 256,  ///< the newest state is not on the disk
  lock = 512,    ///< nor is the lock file of the register map
  change = 1024  ///< there is no socket yet for online changes
};

enum class PointType { boolean, int16, uint16, int32, uint32, int64, uint64, real32, real64 };

/// Any number within its precision; else whole numbers, or two values.
constexpr bool is_real(PointType type) {
  return type == PointType::real32 || type == PointType::real64;
}

/// The lowest and the highest number of a type, as far as a double has every whole number up to it.
constexpr std::pair<double, double> type_limits(PointType type) {
  constexpr double exact = 0x1p53;
  switch (type) {
    case PointType::boolean:
      return {0.0, 1.0};
    case PointType::int16:
      return {-0x1p15, 0x1p15 - 1.0};
    case PointType::uint16:
      return {0.0, 0x1p16 - 1.0};
    case PointType::int32:
      return {-0x1p31, 0x1p31 - 1.0};
    case PointType::uint32:
      return {0.0, 0x1p32 - 1.0};
    case PointType::int64:
      return {-exact, exact};
    case PointType::uint64:
      return {0.0, exact};
    case PointType::real32:
      return {-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    case PointType::real64:
      return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  return {0.0, 0.0};
}

/// What a client must be allowed before it may write a point.
enum class WriteRight {
  inputs,      ///< inputs of the diagram, and to say that the client lives
  parameters,  ///< parameters, and to commit or discard them
  reset,       ///< to bring every state to its start, and to forget a fault
};

struct Point {
  std::string name{};  ///< as in the diagram: U, HYST.C1; status and commands as task.cycles
  PointKind kind = PointKind::status;
  PointType type = PointType::real64;
  std::string unit{};  ///< "1" where it has none
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool writable = false;
  std::string meaning{};
  WriteRight right = WriteRight::parameters;  ///< where it is writable
  bool counts = false;       ///< begins at zero with the task and only grows: of use as a rate, not as a level
  bool is_retained = false;  ///< kept through a restart
  bool comes_last = false;   ///< on a register map behind all others, whose addresses do not move where it is there
};

struct PointWrite {
  std::size_t point = 0;  ///< index into points(), or the place of a parameter that came with an online change
  double value = 0.0;
};

/// An input that has a value of the live page's, whatever gives it else.
struct Force {
  std::size_t point = 0;          ///< index into points()
  std::optional<double> value{};  ///< none: no longer
};

/// What the live page may do for who has its token.
struct PageRights {
  bool parameters = true;  ///< to stage, commit and discard them
  bool reset = true;
  bool force = false;  ///< inputs
};

/// All values of one cycle. A value is a double whatever its type; integers are exact to 2^53.
struct Snapshot {
  std::uint64_t cycle = 0;
  /// As points(); behind them, those of parameters that came with an online change, by their places.
  std::vector<double> values;
};

/// What the live page sees: the version of the diagram that runs. An online change begins another.
struct LiveView {
  std::uint64_t version = 1;  ///< of the diagram, as task.version counts
  std::vector<Point> points{};
  /// By point: where it is written. First as points() of the door; parameters that came with a change follow. A place
  /// is never another point's.
  std::vector<std::size_t> places{};
  std::vector<Point> inner{};  ///< signals within the diagram, to be looked at
  std::string picture{};       ///< SVG of the diagram, with places for the values; empty where there is none
};

/// What can be seen of one cycle beyond a snapshot: the values within the diagram, and parameters twice.
struct LiveValues {
  std::uint64_t version = 1;  ///< of the view that the values are of
  std::uint64_t cycle = 0;
  std::vector<double> values{};       ///< as its points; parameters as they count in the program
  std::vector<double> inner{};        ///< as its inner signals
  std::vector<PointWrite> staged{};   ///< parameters that wait for a commit of the live page; indices into its points
  std::vector<std::size_t> forced{};  ///< inputs that are forced in this cycle; indices into its points
};

/// What a server may do with the running task. Every function may be called from a server's thread and returns at once;
/// none of them waits for the cyclic thread, and none makes it wait.
class PointDoor {
 public:
  PointDoor() = default;
  PointDoor(const PointDoor&) = delete;
  PointDoor& operator=(const PointDoor&) = delete;
  virtual ~PointDoor() = default;

  /// The same for the life of the door.
  [[nodiscard]] virtual std::span<const Point> points() const = 0;
  /// The values of the newest whole cycle; of one cycle, never of two. Parameters read as staged by write() while any
  /// are.
  virtual void read(Snapshot& into) = 0;
  /// All of the writes or none. Empty where taken; otherwise the reason, as a sentence that names the point.
  /// The caller has checked that each is writable, finite, of its type and within its limits.
  virtual std::string write(std::span<const PointWrite> writes) = 0;
  /// Whether one of those who use write() owns the writes: who uses the door otherwise changes nothing meanwhile, and
  /// nothing is forced.
  virtual void writes_are_owned(bool /*are_owned*/) {}

  // For the live page, which stages a set of its own:
  /// What it sees now; what is returned stays as it is.
  [[nodiscard]] virtual std::shared_ptr<const LiveView> view() const;
  /// The newest whole cycle, and what is staged by write_from_page().
  virtual void read_live(LiveValues& into) = 0;
  /// As write(), with a staged set of its own, and places of the view.
  virtual std::string write_from_page(std::span<const PointWrite> writes) { return write(writes); }
  /// All of them or none; inputs that are not named stay as they are. Empty where taken, else the reason.
  virtual std::string force(std::span<const Force> /*inputs*/) { return "No input can be forced here."; }
  /// No input is forced any more.
  virtual void end_forces() {}

  /// What the server cannot have now, or has again.
  virtual void shortage(Shortage /*what*/, bool /*is_there*/) noexcept {}
};

inline std::shared_ptr<const LiveView> PointDoor::view() const {
  LiveView all;
  all.points.assign(points().begin(), points().end());
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    all.places.push_back(i);
  }
  return std::make_shared<const LiveView>(std::move(all));
}

}  // namespace hysteron::runtime
