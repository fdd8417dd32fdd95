#include "runtime/task/task_status.hpp"

#include <algorithm>
#include <cmath>

namespace hysteron::runtime {
namespace {

struct Status {
  const char* name = "";
  PointType type = PointType::real64;
  const char* unit = "";
  const char* meaning = "";
  bool counts = false;
  bool comes_last = false;
};

constexpr Status count_of(const char* name, const char* meaning) {
  return {name, PointType::uint64, "1", meaning, true};
}

constexpr const char* faults =
    "0 none, 1 hang, 2 crash, 3 not finite, 4 stale input, 5 lost link, 6 missed cycle, 7 stop, 8 lost client, "
    "9 not safe, 10 lost guard, 11 overload";

/// In the order in which status_values() gives their values.
constexpr std::array statuses{
    Status{"task.state", PointType::uint16, "1", "0 starting, 1 running, 2 faulted, 3 stopped"},
    Status{"task.fault", PointType::uint16, "1", faults},
    count_of("task.cycles", "cycles that were run"),
    count_of("task.skipped", "periods that passed without a cycle"),
    count_of("task.elapsed", "periods by the clock: cycles + skipped"),
    count_of("task.late_wake", "late cycles: the thread was woken late"),
    count_of("task.late_cpu", "late cycles: the cycle computed for too long"),
    count_of("task.late_preempted", "late cycles: the thread was not run"),
    count_of("task.late_steal", "late cycles: the hypervisor had the processor"),
    Status{"task.lateness_p9999", PointType::int64, "ns", "99.99 % of the cycles started no later"},
    Status{"task.lateness_worst", PointType::int64, "ns", "the latest start"},
    Status{"task.worst_cycle", PointType::uint64, "1", "the cycle of the latest start"},
    count_of("task.commits", "sets of parameters applied, and on the disk where they are retained"),
    Status{"task.retained", PointType::uint64, "1", "sequence number of the newest retained state"},
    count_of("task.trace_dropped", "steps that are in no trace: it had no room, or was deleted"),
    count_of("task.write_failures", "writes of the trace or of retained values that failed"),
    count_of("task.not_taken", "values of devices beyond the limits of their input, or none"),
    count_of("task.faults", "faults that began"),
    Status{"task.last_fault", PointType::uint16, "1", faults},
    count_of("task.history_rows", "rows of the history that are on the disk"),
    count_of("task.history_lost", "rows of the history that are lost"),
    Status{"task.history_fault", PointType::uint16, "1",
           "0 none, 1 disk full, 2 cannot be reached, 3 damaged, 4 held by another program"},
    Status{"task.mqtt_connected", PointType::uint16, "1", "0 no, 1 the MQTT broker takes rows"},
    count_of("task.mqtt_rows", "rows that the MQTT broker has confirmed"),
    Status{"task.mqtt_queued", PointType::uint64, "1", "rows that the MQTT broker has not confirmed"},
    count_of("task.mqtt_lost", "rows for MQTT that are lost"),
    Status{"task.mqtt_fault", PointType::uint16, "1",
           "0 none, 1 cannot be reached, 2 refused, 3 TLS failed, 4 connection lost, 5 the file of waiting rows"},
    Status{"task.tls_fault", PointType::uint16, "1",
           "0 none, 1 the certificate ended, 2 it does not count yet, 3 nobody counts who signs those of clients"},
    Status{"task.version", PointType::uint64, "1",
           "the version of the diagram: 1, and one more with each online change"},
    Status{"task.online_change", PointType::uint16, "1", "0 none, 1 changed, 2 refused, 3 changed back"},
    Status{"task.shortages", PointType::uint16, "1",
           "what is tried again while the control goes on, by bits: 1 Modbus has no address yet, 2 nor has the page, "
           "4 the serial line of the server, 8 a device never answered, 16 TLS, 32 MQTT, 64 history, 128 trace, 256 "
           "retained values, 512 the lock file of the registers, 1024 no socket for online changes",
           false, true},
    Status{"task.forced", PointType::uint16, "1", "inputs that the live page forces", false, true},
    Status{"task.load", PointType::uint16, "%",
           "of the last second, what the cyclic thread computed; of ten periods where those take longer", false, true},
    Status{"task.held_back", PointType::uint64, "1",
           "times that low, high or slew kept an output from what the diagram gives, each output once a cycle", true,
           true},
    Status{"task.tls_days", PointType::uint16, "1",
           "whole days until the certificate of the server ends, 0 where it has; 65535 without TLS", false, true},
};
static_assert(statuses.size() == status_count);

constexpr auto names_of_statuses = [] {
  std::array<const char*, status_count> names{};
  std::ranges::transform(statuses, names.begin(), &Status::name);
  return names;
}();

/// Those that servers tell, and those that other status values say already.
std::uint16_t shortages_of(const TaskStatus& status, std::uint16_t told) noexcept {
  unsigned bits = told;
  const auto add = [&](Shortage what, bool is_there) { bits |= is_there ? static_cast<unsigned>(what) : 0U; };
  add(Shortage::device, status.absent > 0);
  add(Shortage::tls, status.tls_fault != 0);
  add(Shortage::mqtt, status.mqtt.fault != 0);
  add(Shortage::history, status.history.fault != 0);
  add(Shortage::trace, status.trace_is_cut);
  add(Shortage::retain, status.retain_fails);
  return static_cast<std::uint16_t>(bits);
}

}  // namespace

std::span<const char* const> status_names() {
  return names_of_statuses;
}

std::vector<Point> status_points() {
  std::vector<Point> points;
  points.reserve(std::size(statuses));
  for (const Status& status : statuses) {
    points.push_back({.name = status.name,
                      .kind = PointKind::status,
                      .type = status.type,
                      .unit = status.unit,
                      .meaning = status.meaning,
                      .counts = status.counts,
                      .comes_last = status.comes_last});
  }
  return points;
}

std::array<double, status_count> status_values(const TaskStatus& status, const LoopStatistics& statistics,
                                               std::int64_t high_lateness, std::uint16_t shortages) noexcept {
  const auto events = [&](Cause cause) { return statistics.events[static_cast<std::size_t>(cause)]; };
  return {
      static_cast<double>(status.state),
      static_cast<double>(status.fault),
      static_cast<double>(statistics.run),
      static_cast<double>(statistics.skipped),
      static_cast<double>(statistics.elapsed),
      static_cast<double>(events(Cause::late_wake)),
      static_cast<double>(events(Cause::own_cpu)),
      static_cast<double>(events(Cause::preempted)),
      static_cast<double>(events(Cause::host_steal)),
      static_cast<double>(high_lateness),
      static_cast<double>(statistics.lateness.worst()),
      static_cast<double>(statistics.lateness.worst_cycle()),
      static_cast<double>(status.commits),
      static_cast<double>(status.retained),
      static_cast<double>(status.dropped),
      static_cast<double>(status.write_failures),
      static_cast<double>(status.not_taken),
      static_cast<double>(status.faults),
      static_cast<double>(status.last_fault),
      static_cast<double>(status.history.done),
      static_cast<double>(status.history.lost),
      static_cast<double>(status.history.fault),
      status.mqtt.is_connected ? 1.0 : 0.0,
      static_cast<double>(status.mqtt.done),
      static_cast<double>(status.mqtt.waiting),
      static_cast<double>(status.mqtt.lost),
      static_cast<double>(status.mqtt.fault),
      static_cast<double>(status.tls_fault),
      static_cast<double>(status.version),
      static_cast<double>(status.last_change),
      static_cast<double>(shortages_of(status, shortages)),
      static_cast<double>(status.forced),
      std::round(100.0 * status.load),
      static_cast<double>(status.held_back),
      static_cast<double>(status.tls_days),
  };
}

}  // namespace hysteron::runtime
