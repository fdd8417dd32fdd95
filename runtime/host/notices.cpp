#include "runtime/host/notices.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "runtime/host/service_notice.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::size_t longest_line = 500;  // less than a pipe takes at once
constexpr std::chrono::seconds time_to_answer{1};
/// At what is forced: it takes the lock of the servers.
constexpr std::chrono::milliseconds between_looks{100};

/// What to look for.
std::string_view meaning_of(Fault fault) {
  switch (fault) {
    case Fault::hang:
      return "a cycle took longer than the watchdog allows, or none began in time";
    case Fault::not_finite:
      return "the diagram gives infinity or no number";
    case Fault::stale_input:
      return "nothing that could be taken came for as long as it may be old";
    case Fault::lost_link:
      return "the device has not answered for as long as the value may be old";
    case Fault::missed_cycle:
      return "a period passed without a cycle, and missed = \"stop\"";
    case Fault::lost_client:
      return "no telegram of the client came for heartbeat_time";
    case Fault::not_safe:
      return "the next step to the safe value is lost in rounding";
    case Fault::lost_guard:
      return "its process is gone, and nothing would make the outputs safe if the task hung or died";
    case Fault::overload:
      return "the cyclic thread computes for more of the time than load in [task] allows";
    case Fault::none:
    case Fault::crash:
    case Fault::stop:
      break;
  }
  return "the task ended";
}

}  // namespace

std::string weighted(std::string_view lines, Weight weight) {
  if (!is_journal(STDERR_FILENO)) {
    return std::string(lines);
  }
  std::string text;
  while (!lines.empty()) {
    const std::size_t end = std::min(lines.find('\n'), lines.size() - 1) + 1;
    text += fmt::format("<{}>{}", static_cast<unsigned>(weight), lines.substr(0, end));
    lines.remove_prefix(end);
  }
  return text;
}

void tell(std::string_view from, const std::string& line, Weight weight) {
  pollfd error{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&error, 1, 0) == 1 && (error.revents & POLLOUT) != 0) {
    const std::string whole = weighted(fmt::format("{}: {}\n", from, line.substr(0, longest_line)), weight);
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, whole.data(), whole.size());
  }
}

void WriteNotices::tell_remarks() {
  for (const std::string& line : retainer_ == nullptr ? std::vector<std::string>{} : retainer_->remarks().lines()) {
    tell("Retain", line);
  }
  for (const std::string& line : trace_ == nullptr ? std::vector<std::string>{} : trace_->remarks().lines()) {
    tell("Trace", line);
  }
}

void WriteNotices::look() {
  tell_remarks();
  if (const std::string problem = retainer_ == nullptr ? "" : retainer_->problem(); problem.empty() == told_retain_) {
    told_retain_ = !told_retain_;
    tell("Retain",
         told_retain_ ? fmt::format("the newest state on the disk stays {}: {}. {}; each further state is tried again.",
                                    retainer_->written(), problem, retainer_->mend())
                      : fmt::format("written again, state {}.", retainer_->written()),
         told_retain_ ? Weight::warning : Weight::notice);
  }
  if (trace_ != nullptr && trace_->is_cut() != told_trace_) {
    told_trace_ = !told_trace_;
    tell("Trace",
         told_trace_
             ? fmt::format("ends here: {}. {}; another file is tried every 10 s.", trace_->problem(), trace_->mend())
             : fmt::format("written again, into another file; {} steps are in none.", trace_->dropped()),
         told_trace_ ? Weight::warning : Weight::notice);
  }
}

std::string WriteNotices::at_the_end() const {
  std::string text;
  if (const std::string problem = retainer_ == nullptr ? "" : retainer_->problem(); !problem.empty()) {
    text += fmt::format("; the last state is not retained: {}", problem);
  }
  if (trace_ != nullptr && trace_->is_cut()) {
    text += fmt::format("; the trace was cut short, {} steps are not in it: {}", trace_->dropped(), trace_->problem());
  }
  return text;
}

FaultNotices::FaultNotices(const RunConfig& config, const ProgramShape& shape) {
  for (const auto* const signals : {&shape.inputs, &shape.outputs}) {
    for (const ProgramSignal& signal : *signals) {
      ports_.push_back(signal.name);
    }
  }
  const auto on_device = [&](std::size_t port, const DeviceLink& link) {
    const modbus::DeviceOptions& device = config.devices[link.device];
    ports_[port] += fmt::format(" on {} ({})", device.name, text_of(device.link));
  };
  for (const DeviceInput& input : config.device_inputs) {
    if (input.tells == Tells::value) {
      on_device(input.port, input.link);
    }
  }
  for (const DeviceOutput& output : config.device_outputs) {
    on_device(shape.inputs.size() + output.port, output.link);
  }
}

std::string FaultNotices::last_of(const FaultReport& report) const {
  return std::string(name_of(report.last)) + (report.port < ports_.size() ? ", " + ports_[report.port] : "");
}

std::string FaultNotices::line(const FaultReport& report, Clock::time_point now) {
  if (!news_.take(report, now)) {
    return {};
  }
  return report.fault == Fault::none
             ? fmt::format("none any more; {} since the start, the last: {}.", report.count, last_of(report))
             : fmt::format("{}: {}; {} since the start.", last_of(report), meaning_of(report.fault), report.count);
}

void tell_of_what_is_left(const std::vector<std::string>& left) {
  if (!left.empty()) {
    tell("Retain", fmt::format("not taken over: {}.", fmt::join(left, ", ")));
  }
}

void tell_of_unused_devices(const RunConfig& config) {
  for (const modbus::DeviceOptions& device : config.devices) {
    if (device.values.empty()) {
      tell("Run file", fmt::format("no input and no output is on the device {0}. Write device = \"{0}\" below one, or "
                                   "remove [devices.{0}].",
                                   device.name));
    }
  }
}

RunNotices::RunNotices(const RunConfig& config, const ProgramShape& shape, Task& task,
                       const TaskAttachments& attachments, std::map<std::string, Remarks*> beside)
    : task_(&task),
      may_force_(config.web && config.web->rights.force),
      guard_(attachments.guard),
      field_(attachments.field),
      beside_(std::move(beside)),
      writes_(attachments.retainer, attachments.trace),
      faults_(config, shape),
      load_(config.task.most_load) {}

std::vector<std::string> AbsenceNotices::lines(const std::vector<std::string>& absent, Clock::time_point now) {
  std::vector<std::string> lines;
  if (now - start_ < time_to_answer) {
    return lines;
  }
  for (const std::string& device : absent) {
    if (std::ranges::find(told_, device) == told_.end()) {
      lines.push_back(
          fmt::format("{} has not answered since the start: the task goes on without it, and its outputs go "
                      "nowhere. It is tried on; see that it is on and reached as [devices.{}] says.",
                      device, device));
    }
  }
  for (const std::string& device : told_) {
    if (std::ranges::find(absent, device) == absent.end()) {
      lines.push_back(fmt::format("{} answers, and counts from now on.", device));
    }
  }
  told_ = absent;
  return lines;
}

std::string LoadNotices::line(const LoadReport& report) {
  if (report.stretch == seen_) {
    return {};
  }
  seen_ = report.stretch;
  constexpr std::uint64_t well_for = 10;
  const bool is_overload = report.load > most_;
  const bool loses_periods = 10 * report.skipped > report.periods;
  well_ = is_overload || loses_periods ? 0 : well_ + 1;
  const std::string load = fmt::format("{:.0f} % of the time", 100.0 * report.load);
  if (told_ && well_ == well_for) {
    told_ = false;
    return fmt::format("well again: the cyclic thread computes for {}.", load);
  }
  if (told_ || well_ > 0) {
    return {};
  }
  told_ = true;
  return is_overload
             ? fmt::format(
                   "the cyclic thread computes for {}, and {:.3g} % is the most that it should (load in [task]); "
                   "{} of the last {} periods passed without a cycle. Leave out what costs most, state a longer "
                   "sample time, or take a faster processor.",
                   load, 100.0 * most_, report.skipped, report.periods)
             : fmt::format(
                   "{} of the last {} periods passed without a cycle, though the cyclic thread computes for {} "
                   "alone: others have the processor. `hysteron doctor --rt` says what to change.",
                   report.skipped, report.periods, load);
}

std::string ForceNotices::line(const std::vector<std::string>& forced, Clock::time_point now) {
  if (!news_.take(forced, now)) {
    return {};
  }
  return forced.empty()
             ? "no input is forced any more."
             : fmt::format("{} from the live page, until that page is closed or ends it.", fmt::join(forced, ", "));
}

void RunNotices::look() {
  writes_.look();
  look_at_forces(ForceNotices::Clock::now());
  if (field_ != nullptr) {
    for (const std::string& line : absences_.lines(field_->absent_devices(), AbsenceNotices::Clock::now())) {
      tell("Device", line);
    }
  }
  look_beside();
  if (const std::string line = load_.line(task_->load()); !line.empty()) {
    tell("Load", line, load_.is_told() ? Weight::warning : Weight::notice);
  }
  FaultReport report = task_->faults();
  if (guard_ != nullptr && !guard_->may_write() && report.fault == Fault::none) {
    // A task that hangs cannot say so.
    report = {.fault = guard_->fault(), .last = guard_->fault(), .count = report.count + 1};
  }
  if (const std::string line = faults_.line(report, FaultNotices::Clock::now()); !line.empty()) {
    tell("Fault", line, report.fault == Fault::none ? Weight::notice : Weight::error);
  }
}

void RunNotices::last_look() {
  look_at_forces(ForceNotices::Clock::now() + pace_of_lines);
  look_beside();
  writes_.tell_remarks();
}

void RunNotices::look_at_forces(ForceNotices::Clock::time_point now) {
  if (!may_force_ || now < next_look_at_forces_) {
    return;
  }
  next_look_at_forces_ = now + between_looks;
  if (const std::string line = forces_.line(task_->door().forced(), now); !line.empty()) {
    tell("Forced", line, Weight::notice);
  }
}

void RunNotices::look_beside() {
  for (const auto& [name, remarks] : beside_) {
    for (const std::string& line : remarks->lines()) {
      tell(name, line);
    }
  }
}

std::string RunNotices::at_the_end() const {
  const FaultReport report = task_->faults();
  const std::string faults = report.count == 0 ? ""
                                               : fmt::format("; {} fault{}, the last: {}", report.count,
                                                             report.count == 1 ? "" : "s", faults_.last_of(report));
  const std::string left =
      guard_ == nullptr || !guard_->holds_on()
          ? ""
          : fmt::format("; its guard, process {}, goes on until the devices have their safe values", guard_->process());
  // A run that ends before its notice was due says it here.
  const auto absent = field_ == nullptr ? std::vector<std::string>{} : field_->absent_devices();
  const std::string never =
      absent.empty() ? "" : fmt::format("; never answered since the start: {}", fmt::join(absent, ", "));
  // What no broker took is said, and makes no failure of the run: the network is not the task's.
  const auto mqtt = beside_.find("MQTT");
  const std::string problem = mqtt == beside_.end() ? "" : mqtt->second->problem();
  return faults + never + left + not_written() +
         (problem.empty() ? "" : fmt::format("; rows for MQTT are lost: {}", problem));
}

std::string RunNotices::not_written() const {
  const auto history = beside_.find("History");
  const std::string problem = history == beside_.end() ? "" : history->second->problem();
  return writes_.at_the_end() +
         (problem.empty() ? "" : fmt::format("; the last rows of the history are lost: {}", problem));
}

}  // namespace hysteron::runtime
