#include "runtime/task/task_door.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hysteron::runtime {
namespace {

constexpr std::size_t command_count = 4;
constexpr std::uint64_t percentile_every = 1024;  ///< cycles: looking through the histogram takes some microseconds

struct Status {
  const char* name;
  PointType type;
  const char* unit;
  const char* meaning;
  bool counts = false;
  bool comes_last = false;
};

constexpr Status count_of(const char* name, const char* meaning) {
  return {name, PointType::uint64, "1", meaning, true};
}

constexpr const char* faults =
    "0 none, 1 hang, 2 crash, 3 not finite, 4 stale input, 5 lost link, 6 missed cycle, 7 stop, 8 lost client, "
    "9 not safe, 10 lost guard";

/// In the order in which publish() gives their values.
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
    count_of("task.trace_dropped", "steps that the trace had no room for"),
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
           "0 none, 1 cannot be reached, 2 refused, 3 TLS failed, 4 connection lost"},
    Status{"task.tls_fault", PointType::uint16, "1",
           "0 none, 1 the certificate ended, 2 it does not count yet, 3 nobody counts who signs those of clients"},
    Status{"task.version", PointType::uint64, "1",
           "the version of the diagram: 1, and one more with each online change"},
    Status{"task.online_change", PointType::uint16, "1", "0 none, 1 changed, 2 refused, 3 changed back"},
    Status{"task.shortages", PointType::uint16, "1",
           "what is tried again while the control goes on, by bits: 1 Modbus has no address yet, 2 nor has the page, "
           "4 the serial line of the server, 8 a device never answered, 16 TLS, 32 MQTT, 64 history, 128 trace",
           false, true},
};
constexpr std::size_t status_count = statuses.size();

constexpr auto names_of_statuses = [] {
  std::array<const char*, status_count> names{};
  std::ranges::transform(statuses, names.begin(), &Status::name);
  return names;
}();

std::size_t width_of(const ProgramShape& shape, std::size_t field_points) {
  return shape.inputs.size() + shape.outputs.size() + shape.parameters.size() + status_count + field_points +
         command_count + shape.inner.size();
}

TaskOrders first_orders(const StepProgram& program, const std::vector<InputSettings>& settings) {
  const std::vector<ProgramSignal>& inputs = program.shape().inputs;
  TaskOrders orders{
      .inputs = {}, .input_writes = std::vector<std::uint64_t>(inputs.size(), 0), .parameters = parameters_of(program)};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    orders.inputs.push_back(settings[i].start.value_or(inputs[i].preset));
  }
  return orders;
}

Point point_of(const ProgramSignal& signal, PointKind kind, bool writable) {
  return {.name = signal.name,
          .kind = kind,
          .type = signal.type,
          .unit = signal.unit.empty() ? "1" : signal.unit,
          .low = signal.low,
          .high = signal.high,
          .writable = writable,
          .meaning = signal.meaning,
          .right = kind == PointKind::input ? WriteRight::inputs : WriteRight::parameters};
}

}  // namespace

std::span<const char* const> status_names() {
  return names_of_statuses;
}

TaskDoor::TaskDoor(const StepProgram& program, const std::vector<InputSettings>& inputs,
                   const std::vector<OutputSafety>& safety, const std::vector<Point>& field_points)
    : snapshots_(width_of(program.shape(), field_points.size())),
      published_(width_of(program.shape(), field_points.size())),
      judged_by_({.parameters = program.shape().parameters, .relations = program.shape().relations}),
      gone_(program.shape().parameters.size(), false),
      parameters_(judged_by_, parameters_of(program)),
      wanted_(first_orders(program, inputs)),
      orders_(wanted_) {
  const ProgramShape& shape = program.shape();
  for (std::size_t i = 0; i < shape.inputs.size(); ++i) {
    Point point = point_of(shape.inputs[i], PointKind::input, !inputs[i].from_device);
    point.is_retained = inputs[i].is_retained;
    add(std::move(point));
  }
  for (std::size_t i = 0; i < shape.outputs.size(); ++i) {
    Point point = point_of(shape.outputs[i], PointKind::output, false);
    point.low = std::max(point.low, safety[i].low);
    point.high = std::min(point.high, safety[i].high);
    add(std::move(point));
  }
  first_parameter_ = points_.size();
  for (const ProgramSignal& parameter : shape.parameters) {
    add(point_of(parameter, PointKind::parameter, true));
  }
  for (const Status& status : statuses) {
    add({.name = status.name,
         .kind = PointKind::status,
         .type = status.type,
         .unit = status.unit,
         .meaning = status.meaning,
         .counts = status.counts,
         .comes_last = status.comes_last});
  }
  for (const Point& point : field_points) {
    add(point);
  }
  first_command_ = points_.size();
  add_command("task.commit", WriteRight::parameters,
              "any number but 0: the staged parameters count from the next step on");
  add_command("task.discard", WriteRight::parameters, "any number but 0: the staged parameters are forgotten");
  add_command("task.reset", WriteRight::reset,
              "any number but 0: every state as after a start, and a fault is forgotten");
  add_command("task.heartbeat", WriteRight::inputs, "any number: the client lives");
  for (const ProgramSignal& signal : shape.inner) {
    inner_.push_back(point_of(signal, PointKind::output, false));
  }
}

void TaskDoor::add_command(const char* name, WriteRight right, const char* meaning) {
  add({.name = name,
       .kind = PointKind::command,
       .type = PointType::uint16,
       .unit = "1",
       .low = 0.0,
       .high = 65535.0,
       .writable = true,
       .meaning = meaning,
       .right = right});
}

void TaskDoor::read(Snapshot& into) {
  into.values.resize(points_.size());
  const bool any = snapshots_.read(into.cycle, into.values);
  const std::lock_guard lock(servers_);
  if (!any) {
    std::ranges::fill(into.values, 0.0);
    std::ranges::copy(wanted_.inputs, into.values.begin());
  }
  if (!any || parameters_.any_staged()) {
    std::ranges::copy(parameters_.staged(), into.values.begin() + static_cast<std::ptrdiff_t>(first_parameter_));
  }
}

void TaskDoor::read_live(LiveValues& into) {
  into.values.resize(points_.size() + inner_.size());
  const bool any = snapshots_.read(into.cycle, into.values);
  into.inner.assign(into.values.begin() + static_cast<std::ptrdiff_t>(points_.size()), into.values.end());
  into.values.resize(points_.size());
  into.staged.clear();
  const std::lock_guard lock(servers_);
  if (!any) {
    std::ranges::fill(into.values, 0.0);
    std::ranges::fill(into.inner, 0.0);
    std::ranges::copy(wanted_.inputs, into.values.begin());
    std::ranges::copy(parameters_.committed(), into.values.begin() + static_cast<std::ptrdiff_t>(first_parameter_));
  }
  const std::vector<double>& staged = parameters_.staged();
  for (std::size_t i = 0; i < staged.size(); ++i) {
    if (parameters_.is_staged(i)) {
      into.staged.push_back({.point = first_parameter_ + i, .value = staged[i]});
    }
  }
}

std::string TaskDoor::write(std::span<const PointWrite> writes) {
  const std::lock_guard lock(servers_);
  // On copies, which take the place of the originals where nothing was refused.
  StagedParameters parameters = parameters_;
  TaskOrders wanted = wanted_;
  for (const PointWrite& one : writes) {
    const Point& point = points_[one.point];
    if (point.kind == PointKind::input) {
      if (!point.writable) {
        return point.name + " is given by a device.";
      }
      wanted.inputs[one.point] = one.value;
      ++wanted.input_writes[one.point];
    } else if (point.kind == PointKind::parameter) {
      if (gone_[one.point - first_parameter_]) {
        return point.name + " is not in the version of the diagram that runs since an online change.";
      }
      parameters.stage(one.point - first_parameter_, one.value);
    } else if (point.kind != PointKind::command) {
      return point.name + " can only be read.";
    }
  }
  // Commands after values, whatever their order in the request: a commit counts for what came with it.
  for (const PointWrite& one : writes) {
    if (points_[one.point].kind != PointKind::command) {
      continue;
    }
    const auto command = static_cast<Command>(one.point - first_command_);
    if (command == Command::heartbeat) {
      wanted.heartbeat = one.value;
    } else if (one.value == 0.0) {
      continue;
    } else if (command == Command::discard) {
      parameters.discard();
    } else if (command == Command::reset) {
      ++wanted.resets;
    } else if (commits_are_held_) {
      return "An online change is under way: commit again in a second.";
    } else {
      if (auto refusal = parameters.commit(); !refusal.empty()) {
        return refusal;
      }
      wanted.parameters = parameters.committed();
      ++wanted.commits;
    }
  }
  parameters_ = std::move(parameters);
  wanted_ = std::move(wanted);
  orders_.filling() = wanted_;
  orders_.publish();
  return {};
}

void TaskDoor::hold_commits(bool held) {
  const std::lock_guard lock(servers_);
  commits_are_held_ = held;
}

void TaskDoor::version_changed(const StepProgram& version, std::span<const std::optional<std::size_t>> places) {
  const ProgramShape& shape = version.shape();
  const std::lock_guard lock(servers_);
  std::vector<std::optional<std::size_t>> backwards(shape.parameters.size());
  std::vector<double> values = parameters_.committed();
  for (std::size_t i = 0; i < places.size(); ++i) {
    gone_[i] = !places[i];
    if (places[i]) {
      backwards[*places[i]] = i;
      judged_by_.parameters[i] = shape.parameters[*places[i]];
      values[i] = version.parameter(*places[i]);
    }
  }
  judged_by_.relations = shape.relations;
  const auto translate = [&](RelatedNumber& one) {
    if (one.parameter) {
      const std::size_t own = *one.parameter;
      one = backwards[own] ? RelatedNumber{.parameter = backwards[own]}
                           : RelatedNumber{.constant = version.parameter(own)};  // no server reaches it
    }
  };
  for (ProgramRelation& relation : judged_by_.relations) {
    std::ranges::for_each(relation.numbers, translate);
    if (relation.count) {
      translate(*relation.count);
    }
  }
  const StagedParameters before = parameters_;
  parameters_ = StagedParameters(judged_by_, values);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] && before.is_staged(i)) {
      parameters_.stage(i, before.staged()[i]);
    }
  }
}

void TaskDoor::shortage(Shortage what, bool is_there) noexcept {
  const auto bit = static_cast<std::uint16_t>(what);
  if (is_there) {
    shortages_.fetch_or(bit, std::memory_order_relaxed);
  } else {
    shortages_.fetch_and(static_cast<std::uint16_t>(~bit), std::memory_order_relaxed);
  }
}

/// Those that servers tell, and those that other status values say already.
std::uint16_t TaskDoor::shortages_of(const TaskStatus& status) const noexcept {
  unsigned bits = shortages_.load(std::memory_order_relaxed);
  const auto add = [&](Shortage what, bool is_there) { bits |= is_there ? static_cast<unsigned>(what) : 0U; };
  add(Shortage::device, status.absent > 0);
  add(Shortage::tls, status.tls_fault != 0);
  add(Shortage::mqtt, status.mqtt.fault != 0);
  add(Shortage::history, status.history.fault != 0);
  add(Shortage::trace, status.trace_is_cut);
  return static_cast<std::uint16_t>(bits);
}

void TaskDoor::publish(const StepProgram& program, std::span<const double> inputs, std::span<const double> outputs,
                       const TaskStatus& status, const LoopStatistics& statistics) noexcept {
  auto at = std::ranges::copy(inputs, published_.begin()).out;
  at = std::ranges::copy(outputs, at).out;
  const std::size_t parameters = program.shape().parameters.size();
  for (std::size_t i = 0; i < parameters; ++i) {
    *at++ = program.parameter(i);
  }
  if (statistics.run % percentile_every == 0) {
    high_lateness_ = statistics.lateness.percentile(0.9999);
  }
  const auto events = [&](Cause cause) { return statistics.events[static_cast<std::size_t>(cause)]; };
  const std::array<double, status_count> values{
      static_cast<double>(status.state),
      static_cast<double>(status.fault),
      static_cast<double>(statistics.run),
      static_cast<double>(statistics.skipped),
      static_cast<double>(statistics.elapsed),
      static_cast<double>(events(Cause::late_wake)),
      static_cast<double>(events(Cause::own_cpu)),
      static_cast<double>(events(Cause::preempted)),
      static_cast<double>(events(Cause::host_steal)),
      static_cast<double>(high_lateness_),
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
      static_cast<double>(shortages_of(status)),
  };
  at = std::ranges::copy(values, at).out;
  at = std::ranges::copy(status.field, at).out;
  at = std::fill_n(at, 3, 0.0);
  *at++ = status.heartbeat;
  program.inner_values(std::span(at, published_.end()));
  snapshots_.publish(statistics.run, published_);
  for (SampleTap* const tap : taps_) {
    tap->offer(statistics.run, statistics.elapsed, published_);
  }
}

}  // namespace hysteron::runtime
