#include "runtime/host/host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "runtime/config/device_field.hpp"
#include "runtime/host/new_places.hpp"
#include "runtime/host/notices.hpp"
#include "runtime/host/output_turn.hpp"
#include "runtime/host/retained_state.hpp"
#include "runtime/host/running_history.hpp"
#include "runtime/host/running_mqtt.hpp"
#include "runtime/host/served_map.hpp"
#include "runtime/host/service_notice.hpp"
#include "runtime/host/working_folder.hpp"
#include "runtime/modbus/server.hpp"
#include "runtime/modbus/tls_renewal.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

/// What a slow name server may cost a start: devices whose host has no address by then are looked up as they are tried.
constexpr milliseconds longest_look_up{1000};

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set by a signal handler");

void ask_to_stop(int /*signal*/) {
  stop_asked.store(true, std::memory_order_relaxed);
}

/// `besides`: what else is to be said before the fault.
std::string status_line(const Task& task, const std::string& how, const std::string& besides) {
  const LoopStatistics& s = task.statistics();
  const auto events = [&](Cause cause) { return s.events[static_cast<std::size_t>(cause)]; };
  const Fault fault = task.fault() == Fault::stop ? Fault::none : task.fault();  // to end as asked is none
  return fmt::format(
      "{}; {} cycles, {} skipped; late: {} woken, {} own CPU, {} pre-empted, {} steal; start p99.99 {:.1f} us, worst "
      "{:.1f} us in cycle {}{}; fault: {}\n",
      how, s.run, s.skipped, events(Cause::late_wake), events(Cause::own_cpu), events(Cause::preempted),
      events(Cause::host_steal), static_cast<double>(s.lateness.percentile(0.9999)) * 1e-3,
      static_cast<double>(s.lateness.worst()) * 1e-3, s.lateness.worst_cycle(), besides, name_of(fault));
}

std::vector<std::size_t> retained_inputs(const TaskSettings& settings) {
  std::vector<std::size_t> inputs;
  for (std::size_t i = 0; i < settings.inputs.size(); ++i) {
    if (settings.inputs[i].is_retained) {
      inputs.push_back(i);
    }
  }
  return inputs;
}

/// What stands at the trace's name is put aside by number, and in the end deleted: it has to be a trace.
void refuse_foreign_trace(const TraceSettings& settings, const Place& place) {
  std::array<char, 16> begin{};
  std::error_code unknown;
  std::ifstream file;
  if (std::filesystem::is_regular_file(settings.file, unknown)) {
    file.open(settings.file, std::ios::binary);
    file.read(begin.data(), begin.size());
  }
  if (!is_begin_of_trace(std::string_view(begin.data(), static_cast<std::size_t>(file.gcount())))) {
    throw InputError(error::trace_not_writable, place,
                     fmt::format("{} is there already, and is no trace.", settings.file.string()),
                     "name another file: what stands at this name is put aside and, some runs later, deleted.");
  }
}

/// What waits in memory until the trigger fires.
std::string trigger_text(const TraceTrigger& trigger, const ProgramShape& shape) {
  const auto memory = static_cast<double>(memory_before(trigger, shape.inputs.size(), shape.outputs.size()));
  return fmt::format("; trace armed for {} capture{}, up to {:.3g} MB in memory", trigger.captures,
                     trigger.captures == 1 ? "" : "s", memory * 1e-6);
}

std::unique_ptr<Trace> open_trace(const TraceSettings& settings, const Place& place, const StepProgram& program) {
  try {
    return std::make_unique<Trace>(settings, program);
  } catch (const std::system_error& problem) {
    if (problem.code() == std::errc::resource_unavailable_try_again) {
      throw InputError(error::file_of_another_task, place,
                       fmt::format("Another task that runs writes its trace to {}.", settings.file.string()),
                       "end that task first, or name another file.");
    }
    throw InputError(error::trace_not_writable, place, fmt::format("The trace cannot be written: {}.", problem.what()),
                     "name an ordinary file, in a folder that is there and may be written to.");
  }
}

/// The cyclic thread, and what it ends with.
class CyclicThread {
 public:
  CyclicThread(Task& task, const RunConfig& config, bool virtual_time)
      : thread_([this, &task, &config, virtual_time] { run(task, config, virtual_time); }) {
    started_.wait(false);
  }
  CyclicThread(const CyclicThread&) = delete;
  CyclicThread& operator=(const CyclicThread&) = delete;
  CyclicThread(CyclicThread&&) = delete;
  CyclicThread& operator=(CyclicThread&&) = delete;
  ~CyclicThread() {
    stop_asked.store(true);
    thread_.join();
  }

  /// The clock and the scheduling that it obtained.
  [[nodiscard]] const std::string& obtained() const { return obtained_; }
  [[nodiscard]] bool is_done() const { return done_.load(std::memory_order_acquire); }
  [[nodiscard]] LoopEnd end() const { return end_; }

 private:
  void run(Task& task, const RunConfig& config, bool virtual_time) {
    default_floating_point();
    touch_stack();
    if (virtual_time) {
      VirtualClock clock;
      run(task, clock, "virtual clock");
    } else {
      MonotonicClock clock;
      SchedulingRequest request = config.scheduling;
      request.period = config.task.loop.period;
      request.runtime = request.period / 2;
      const auto got = obtain_scheduling(request);
      run(task, clock, description_of(got) + (got.refused.empty() ? "" : " (refused: " + got.refused + ")"));
    }
  }
  void run(Task& task, Clock& clock, std::string obtained) {
    obtained_ = std::move(obtained);
    started_.store(true);
    started_.notify_one();
    end_ = task.run(clock, stop_asked);
    done_.store(true, std::memory_order_release);
  }

  std::string obtained_;
  LoopEnd end_ = LoopEnd::stopped;
  std::atomic<bool> started_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

/// A guard that dies is noticed here: the task does not go on without it.
void watch_over(Guard& guard, Task& task) {
  const std::string death = guard.death();
  if (death.empty()) {
    return;
  }
  const bool was_idle = guard.may_write();
  tell("Guard",
       fmt::format("process {} is gone: {}. {}", guard.process(), death,
                   was_idle ? "The task takes its outputs to their safe values and ends, for nothing would if "
                              "it hung or died. Find out what ended the process, and start the task again."
                            : "It held the outputs on devices, and nobody writes them now: see to the devices, "
                              "end the task, and find out what ended the process."),
       Weight::error);
  task.guard_lost();
}

/// The certificate of the server in the course of years. Nothing to do where the server speaks in the clear.
class CertificateCare {
 public:
  CertificateCare(modbus::Server* server, Task& task, const modbus::TlsOptions* options,
                  const std::shared_ptr<const modbus::TlsContext>& serving)
      : server_(server), task_(&task) {
    if (serving != nullptr) {
      renewal_.emplace(*options, serving, modbus::TlsRenewal::Clock::now());
    }
  }

  /// To be called as time goes by, from a thread that is not the task's.
  void look() {
    if (!renewal_) {
      return;
    }
    const auto found = renewal_->look(modbus::TlsRenewal::Clock::now(), std::time(nullptr));
    if (found.renewed) {
      server_->renew(found.renewed);
    }
    if (found.fault) {
      task_->tls_fault(static_cast<std::uint8_t>(*found.fault));
      task_->tls_days(found.days);
    }
    for (const std::string& line : found.lines) {
      tell("TLS", line);
    }
  }

 private:
  modbus::Server* server_;
  Task* task_;
  std::optional<modbus::TlsRenewal> renewal_;
};

/// Until the cyclic thread is done; the service manager hears that this lives for as long as cycles go on.
void wait_for(const CyclicThread& cyclic, Task& task, Guard* guard, const OutputClaims& claims, RunNotices& notices,
              CertificateCare& certificate, ServedMap* registers, WorkingFolder& folder, nanoseconds period) {
  using Clock = std::chrono::steady_clock;
  const nanoseconds interval = service_watchdog() / 2;
  const nanoseconds longest = std::max<nanoseconds>(3 * period, milliseconds(500));
  std::uint64_t beats = 0;
  auto moved = Clock::now();
  auto told = moved;
  auto drained = moved;
  bool is_stopping = false;
  while (!cyclic.is_done()) {
    std::this_thread::sleep_for(milliseconds(5));
    if (guard != nullptr) {
      watch_over(*guard, task);
    }
    notices.look();
    certificate.look();
    if (registers != nullptr) {
      registers->look(Clock::now());
    }
    if (!is_stopping && stop_asked.load()) {
      tell_service_manager("STOPPING=1");
      is_stopping = true;
    }
    const auto now = Clock::now();
    if (now - drained > std::chrono::seconds(1)) {
      claims.drain();
      if (const std::string line = folder.look(); !line.empty()) {
        tell("Start", line);
      }
      drained = now;
    }
    if (interval.count() == 0 || now - told < interval) {
      continue;
    }
    if (const std::uint64_t newest = task.beats(); newest != beats) {
      beats = newest;
      moved = now;
    }
    if (now - moved <= std::max(longest, 2 * interval)) {
      tell_service_manager("WATCHDOG=1");
    }
    told = now;
  }
}

}  // namespace

void refuse_to_overwrite_inputs(const RunConfig& config, std::vector<InputFile> inputs) {
  if (config.modbus && config.modbus->tls) {
    const modbus::TlsOptions& tls = *config.modbus->tls;
    for (const std::string& file : {tls.certificate, tls.key, tls.clients}) {
      inputs.push_back({.file = file, .named_by = "[tls]"});
    }
  }
  if (config.mqtt) {
    for (const std::string& file :
         {config.mqtt->ca, config.mqtt->certificate, config.mqtt->key, config.mqtt->password_file}) {
      inputs.push_back({.file = file, .named_by = "[mqtt]"});
    }
  }
  if (config.web) {
    for (const std::string& file : {config.web->token_file, config.web->read_token_file}) {
      inputs.push_back({.file = file, .named_by = "[web]"});
    }
  }
  const std::string mend = "name another file in the run file.";
  if (config.online_change) {
    refuse_to_overwrite({.file = config.online_change->socket, .mend = mend, .place = config.online_change->place},
                        inputs);
  }
  // Each is read by the next start, so what is written after it must not take its place either.
  const auto claim = [&](const std::string& file, const std::string& way_out, const Place& place,
                         const char* named_by) {
    refuse_to_overwrite({.file = file, .mend = way_out, .place = place}, inputs);
    inputs.push_back({.file = file, .named_by = named_by});
  };
  if (config.modbus) {
    claim(config.modbus->lock_file, mend, config.modbus->lock_place, "[modbus] lock_file");
  }
  if (config.retain) {
    const RetainFolder folder(config.retain->folder);
    for (const std::size_t slot : {std::size_t{0}, std::size_t{1}}) {
      claim(folder.path_of(slot).string(), "name another folder in the run file.", config.retain->place,
            "[retain] folder");
    }
  }
  if (config.history) {
    for (const char* const ending : {"", "-wal", "-shm", ".lock"}) {
      claim(config.history->file + ending, mend, config.history->place, "[history] file");
    }
  }
  if (config.mqtt && !config.mqtt->file.empty()) {
    for (const char* const ending : {"", "-wal", "-shm"}) {
      claim(config.mqtt->file + ending, mend, config.mqtt->file_place, "[mqtt] file");
    }
  }
  if (config.trace) {
    // What stands there is moved to the next name.
    for (std::size_t number = 0; number < config.trace->files; ++number) {
      const auto file = number == 0 ? config.trace->file : previous_trace(config.trace->file, number);
      refuse_to_overwrite({.file = file.string(), .mend = mend, .place = config.trace_place}, inputs);
    }
  }
}

bool run_host(StepProgram& program, RunConfig config, const HostOptions& options,
              const std::function<void(std::string_view)>& print) {
  const ProgramShape& shape = program.shape();
  config.task.loop.cycles = options.cycles;
  if (config.trace) {
    config.trace->waits = options.virtual_time;
  }
  WorkingFolder folder(names_relative_paths(config));
  stop_asked.store(false);
  (void)std::signal(SIGTERM, ask_to_stop);
  (void)std::signal(SIGINT, ask_to_stop);
  if (std::signal(SIGHUP, ask_to_stop) == SIG_IGN) {
    (void)std::signal(SIGHUP, SIG_IGN);  // as nohup wants it
  }
  tell_of_unused_devices(config);
  if (const std::string anew = new_places(config); !anew.empty() && !options.virtual_time) {
    tell("Start", anew, Weight::notice);
  }
  if (config.trace) {
    refuse_foreign_trace(*config.trace, config.trace_place);
  }
  // What can refuse the start comes first: the outputs' claims, the guard, which writes nothing before the first cycle,
  // what was retained, and the servers. Only then files are begun and devices reached.
  look_up_hosts(config, longest_look_up);
  OutputClaims claims(config);
  if (!claim_outputs(claims, config, shape.name, stop_asked, print)) {
    print(fmt::format("{}: stopped before it began\n", shape.name));
    return true;
  }
  // The guard is forked before there is any thread. It has nothing to do where no output goes to a device.
  DeviceOutputs device_outputs(config, &claims);
  std::unique_ptr<Guard> guard;
  if (config.guard && !config.device_outputs.empty() && !options.virtual_time) {
    guard = std::make_unique<Guard>(
        GuardSettings{.watchdog = config.task.watchdog, .period = shape.period, .silence = config.silence},
        SafeOutputs(config.task.outputs, static_cast<double>(shape.period) * 1e-9), device_outputs);
  }
  std::string how = fmt::format("{}: {}", shape.name, options.how);
  const auto retained =
      config.retain ? std::make_unique<RetainedState>(*config.retain, program, retained_inputs(config.task)) : nullptr;
  how += retained ? retained->told() : "";
  if (retained) {
    for (std::size_t input = 0; input < config.task.inputs.size(); ++input) {
      config.task.inputs[input].start = retained->starts()[input];
    }
  }
  Task task(program, config.task);
  const auto history =
      config.history ? std::make_unique<RunningHistory>(*config.history, shape, task, options.virtual_time) : nullptr;
  const auto mqtt = config.mqtt ? std::make_unique<RunningMqtt>(config, shape, task) : nullptr;
  // On a clock of its own, a trial would tell others of values that no machine has.
  const bool publishes = mqtt && !options.virtual_time;
  how += publishes ? fmt::format("; MQTT to {}:{}", config.mqtt->broker, config.mqtt->port)
         : mqtt    ? "; nothing is published to MQTT"
                   : "";
  // Read after the guard was forked: the guard needs no key.
  const auto tls = config.modbus && config.modbus->tls
                       ? std::make_shared<const modbus::TlsContext>(*config.modbus->tls, modbus::OutOfDate::taken)
                       : nullptr;
  const auto registers = config.modbus ? std::make_unique<ServedMap>(config, shape.name, task, tls) : nullptr;
  modbus::Server* const server = registers ? &registers->server() : nullptr;
  how += server != nullptr && server->port() != 0
             ? fmt::format("; Modbus on {}:{}", config.modbus->listen, server->port())
             : "";
  how += tls ? fmt::format(" over TLS, certificate until {}", tls->valid_until()) : "";
  how += tls && tls->fault_at(std::time(nullptr)) != modbus::TlsFault::none ? " (no client comes in)" : "";
  how += server != nullptr && config.modbus->rtu
             ? fmt::format("; Modbus RTU on {}, unit {}", config.modbus->rtu->line.path, config.modbus->rtu->unit)
             : "";
  const auto companion = options.beside ? options.beside(task.door(), how) : nullptr;
  const auto change = online_change(config, options.changeable, task);
  auto changer = change ? options.take_changes(*change, how) : nullptr;

  const auto trace = config.trace ? open_trace(*config.trace, config.trace_place, program) : nullptr;
  how += config.trace && config.trace->trigger ? trigger_text(*config.trace->trigger, shape) : "";
  std::unique_ptr<Retainer> retainer;
  if (retained) {
    retained->put_aside();
    if (const std::string loss = retained->loss(); !loss.empty()) {
      tell("Retain", loss);
    }
    retainer = std::make_unique<Retainer>(retained->folder(), program, retained->recovery(), retained->after_reset(),
                                          retained->inputs());
    tell_of_what_is_left(retained->left());
  }
  std::unique_ptr<DeviceField> devices;
  if (!config.devices.empty() && options.field == nullptr) {
    devices = std::make_unique<DeviceField>(config, options.virtual_time,
                                            [&guard] { return guard == nullptr || guard->may_write(); });
  }
  const TaskAttachments attachments{.field = options.field != nullptr ? options.field : devices.get(),
                                    .guard = guard.get(),
                                    .retainer = retainer.get(),
                                    .trace = trace.get(),
                                    .history = history ? &history->counter() : nullptr,
                                    .mqtt = publishes ? &mqtt->counter() : nullptr,
                                    .changes = options.changeable};
  task.attach(attachments);
  std::vector<SampleTap*> taps;
  std::map<std::string, Remarks*> beside;
  if (history) {
    taps.push_back(&history->tap());
    history->start();
    beside.emplace("History", &history->remarks());
  }
  if (publishes) {
    taps.push_back(&mqtt->tap());
    mqtt->start();
    beside.emplace("MQTT", &mqtt->remarks());
  }
  task.door().attach(std::move(taps));
  RunNotices notices(config, shape, task, attachments, std::move(beside));
  CertificateCare certificate(server, task, tls ? &*config.modbus->tls : nullptr, tls);
  LoopEnd end = LoopEnd::stopped;
  {
    const CyclicThread cyclic(task, config, options.virtual_time);
    print(how + "; " + cyclic.obtained() + "\n");
    tell_service_manager("READY=1");
    if (change) {
      change->begin(retainer.get(), trace.get(), registers.get());
    }
    wait_for(cyclic, task, guard.get(), claims, notices, certificate, registers.get(), folder,
             nanoseconds(shape.period));
    end = cyclic.end();
    if (change) {
      change->end();
      changer.reset();  // it uses what is finished next
    }
  }
  if (retainer) {
    retainer->finish();
  }
  if (trace) {
    trace->finish();
  }
  if (history) {
    history->finish();
  }
  if (publishes) {
    mqtt->finish();
  }
  notices.last_look();
  print(status_line(task, shape.name + ": " + std::string(name_of(end)), notices.at_the_end()));
  return (end == LoopEnd::stopped || end == LoopEnd::done) && task.fault() == Fault::stop && notices.all_is_written();
}

}  // namespace hysteron::runtime
