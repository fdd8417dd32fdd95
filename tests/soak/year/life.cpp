#include "tests/soak/year/life.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/host/host.hpp"
#include "support/errors.hpp"
#include "tests/soak/year/disk_watch.hpp"
#include "tests/soak/year/operator.hpp"
#include "tests/soak/year/simulated_time.hpp"

namespace hysteron::soak {
namespace {

constexpr std::int64_t minute = 60 * second;
constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();
/// Parameters of a set: whole multiples of this beside their presets, so that a double holds them.
constexpr double unit_of_sets = 0x1p-20;

/// What the plan does to a life, in the cyclic thread, and what is looked at meanwhile.
class Script {
 public:
  Script(const Stage& stage, Ledger& ledger, TankField& field, Operator& changes, std::int64_t from)
      : stage_(&stage), ledger_(&ledger), field_(&field), operator_(&changes), looks_at_(from) {
    const auto& events = stage.plan.events;
    for (; next_event_ < events.size() && events[next_event_].at < from; ++next_event_) {
      const Event& event = events[next_event_];
      if (event.at + event.lasts > from) {
        begin_while(event);  // it goes on
      }
      if (event.what == Happening::NewCertificate) {
        certificate_ = event.number;
      }
    }
    write_certificate(certificate_);
    unchanged_since_ = from;
  }

  void see(runtime::PointDoor& door) {
    door_ = &door;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      places_[i] = static_cast<std::size_t>(
          std::ranges::find(door.points(), std::string_view(names[i]), &runtime::Point::name) - door.points().begin());
    }
  }

  /// At each wake of the cyclic thread.
  std::int64_t wake(std::int64_t due) {
    const std::int64_t now = std::max(due, SimulatedTime::now());
    if (is_ending_) {
      return now;
    }
    if (ledger_->first_due == 0) {
      ledger_->first_due = due - monotonic_begin;
      lates_ += now - due > stage_->plan.settings.period / 10 ? 1 : 0;  // the start took its time
    }
    std::int64_t late = 0;
    if (now - monotonic_begin >= next_) {
      late = act(now - monotonic_begin, due - monotonic_begin);
    }
    const std::int64_t period = stage_->plan.settings.period;
    const auto overload = static_cast<std::uint64_t>((now - due) / period);
    const auto all = static_cast<std::uint64_t>((now + late - due) / period);
    ledger_->skipped += all;
    ledger_->skipped_overload += overload;
    ledger_->skipped_late += all - overload;
    ledger_->now = now + late - monotonic_begin;
    return now + late;
  }

 private:
  enum Name : std::uint8_t {
    Cycles,
    Skipped,
    Elapsed,
    LateWake,
    LateCpu,
    LateSteal,
    Commits,
    Retained,
    Failures,
    Rows,
    HistoryFault,
    TlsFault,
    Fault,
    Uptime,
    Gain,
    Time,
    Commit,
    NameCount
  };
  static constexpr std::array<const char*, NameCount> names{"task.cycles",
                                                            "task.skipped",
                                                            "task.elapsed",
                                                            "task.late_wake",
                                                            "task.late_cpu",
                                                            "task.late_steal",
                                                            "task.commits",
                                                            "task.retained",
                                                            "task.write_failures",
                                                            "task.history_rows",
                                                            "task.history_fault",
                                                            "task.tls_fault",
                                                            "task.fault",
                                                            "UPTIME",
                                                            "PI.KP",
                                                            "PI.TR",
                                                            "task.commit"};

  [[nodiscard]] double value(Name name) const { return snapshot_.values[places_[name]]; }
  [[nodiscard]] std::uint64_t count(Name name) const { return static_cast<std::uint64_t>(value(name)); }

  /// What is due by now. Gives by how much the thread is woken late.
  std::int64_t act(std::int64_t now, std::int64_t due) {
    look(now, due);
    std::int64_t late = 0;
    if (!ledger_->has_begun) {
      return late;  // before the first cycle nothing can be asked of it
    }
    end_what_is_over(now);
    const auto& events = stage_->plan.events;
    for (; next_event_ < events.size() && events[next_event_].at <= now && !is_ending_; ++next_event_) {
      const Event& event = events[next_event_];
      const bool is_delay = event.what == Happening::LateWake || event.what == Happening::Overload;
      if (is_delay && (now > due || late > 0 || field_->overload > 0)) {
        continue;  // one delay at a time, or its cause could not be told
      }
      if (event.what == Happening::LateWake) {
        ++ledger_->happened[static_cast<std::size_t>(event.what)];
        late = number_of_periods(event) + stage_->plan.settings.period / 2;
        ++lates_;
      } else {
        happen(event, now);
      }
    }
    if (now >= stage_->plan.settings.span && !operator_->is_busy()) {
      DiskWatch::cut_at_byte(0);
      end_orderly(Happening::Restart);
    }
    next_ = std::min({looks_at_, lost_until_, broken_until_, full_until_, clock_until_, cut_until_,
                      next_event_ < events.size() ? events[next_event_].at : never, stage_->plan.settings.span});
    return late;
  }

  [[nodiscard]] std::int64_t number_of_periods(const Event& event) const {
    return static_cast<std::int64_t>(1 + event.number % 20) * stage_->plan.settings.period;
  }

  void happen(const Event& event, std::int64_t now) {
    const bool ends_otherwise = event.what == Happening::Kill || event.what == Happening::Restart;
    if (ends_otherwise && cut_until_ != never) {
      return;  // the power is about to go
    }
    if (event.what == Happening::Restart &&
        (field_->state.is_lost || field_->state.is_broken || full_until_ != never || operator_->is_busy())) {
      return;  // its end could not be told from a loss
    }
    ++ledger_->happened[static_cast<std::size_t>(event.what)];
    switch (event.what) {
      case Happening::CutWithCommit:
        commit();
        [[fallthrough]];
      case Happening::PowerCut:
        ledger_->end = event.what;
        DiskWatch::cut_at_byte(1 + event.number % (event.what == Happening::PowerCut ? 20'000 : 3'000));
        cut_until_ = std::min(cut_until_, now + 30 * minute);
        close_up(now);
        break;
      case Happening::Kill:
        ledger_->end = event.what;
        DiskWatch::cut();
      case Happening::Restart:
        ledger_->version = other_version(event.number);
        end_orderly(event.what);
        break;
      case Happening::OnlineChange:
        operator_->change_to(other_version(event.number));
        close_up(now);
        break;
      case Happening::RefusedChange:
        operator_->change_to(jumping_version);
        close_up(now);
        break;
      case Happening::Commit:
        commit();
        close_up(now);
        break;
      case Happening::Overload:
        field_->overload = number_of_periods(event) + stage_->plan.settings.period / 2;
        ++overloads_;
        break;
      case Happening::NewCertificate:
        certificate_ = event.number;
        write_certificate(certificate_);
        unchanged_since_ = now;
        break;
      case Happening::DeviceLost:
      case Happening::SensorBroken:
      case Happening::DiskFull:
      case Happening::ClockStep:
        begin_while(event);
        break;
      case Happening::LateWake:
        break;
    }
  }

  void begin_while(const Event& event) {
    const std::int64_t until = event.at + event.lasts;
    switch (event.what) {
      case Happening::DeviceLost:
        field_->state.is_lost = true;
        lost_until_ = until;
        break;
      case Happening::SensorBroken:
        field_->state.is_broken = true;
        broken_until_ = until;
        break;
      case Happening::DiskFull:
        DiskWatch::set_full(true);
        ledger_->was_full = true;
        full_until_ = until;
        asked_before_full_ = asked_;
        failures_before_full_ = door_ == nullptr ? 0 : count(Failures);
        break;
      case Happening::ClockStep: {
        // A third of them to 1970, as a machine without a battery; the others by up to 400 days.
        const std::int64_t by = static_cast<std::int64_t>(event.number % 800) - 400;
        SimulatedTime::set_utc_ahead(event.number % 3 == 0 ? minute - event.at : utc_ahead + by * 1440 * minute);
        clock_until_ = until;
        unchanged_since_ = event.at;
        break;
      }
      default:
        break;
    }
  }

  void end_what_is_over(std::int64_t now) {
    if (now >= lost_until_) {
      field_->state.is_lost = false;
      lost_until_ = never;
    }
    if (now >= broken_until_) {
      field_->state.is_broken = false;
      broken_until_ = never;
    }
    if (now >= full_until_) {
      DiskWatch::set_full(false);
      full_until_ = never;
      ledger_->full_noticed += count(Failures) > failures_before_full_ || count(HistoryFault) != 0 ? 1 : 0;
    }
    if (now >= clock_until_) {
      SimulatedTime::set_utc_ahead(utc_ahead);
      clock_until_ = never;
      unchanged_since_ = now;
    }
    if (now >= cut_until_) {
      DiskWatch::cut();  // nothing was written
    }
  }

  [[nodiscard]] std::uint64_t other_version(std::uint64_t number) const {
    return (ledger_->version + 1 + number % (sound_versions - 1)) % sound_versions;
  }

  void end_orderly(Happening what) {
    ledger_->end = what;
    ledger_->ends_orderly = true;
    is_ending_ = true;
    (void)std::raise(SIGTERM);  // in this thread, so that no cycle follows
    SimulatedTime::let_go();
  }

  /// Threads beside run at their times for a while.
  void close_up(std::int64_t now) {
    SimulatedTime::set_quantum(0);
    close_until_ = now + 5 * stage_->plan.settings.period + second / 5;
  }

  void commit() {
    const double by = static_cast<double>(ledger_->proposed + 1) * unit_of_sets;
    const std::array<runtime::PointWrite, 3> set{
        {{places_[Gain], 1.0 + by}, {places_[Time], 20.0 + by}, {places_[Commit], 1.0}}};
    if (door_->write(set).empty()) {  // refused while an online change is under way
      ++ledger_->proposed;
      ++asked_;
    }
  }

  void look(std::int64_t now, std::int64_t due) {
    door_->read(snapshot_);
    if (snapshot_.cycle == 0 && count(Cycles) == 0) {
      return;  // before the first cycle
    }
    if (!std::exchange(ledger_->has_begun, true)) {
      look_at_the_start();
    }
    look_at_counts(due);
    look_at_confirmations();
    look_at_certificate(now);
    look_at_uptime();
    ledger_->history_rows = count(Rows);
    if (count(Retained) != std::exchange(retained_, count(Retained)) && knows_uptime_) {
      const double since = static_cast<double>(2 * stage_->quantum + 5 * second) * 1e-9;
      ledger_->uptime_kept = std::max(ledger_->uptime_kept, ledger_->uptime - since);
    }
    const bool is_close = now < close_until_ || operator_->is_busy();
    SimulatedTime::set_quantum(is_close ? 0 : stage_->quantum);
    looks_at_ = is_close ? now : now + stage_->quantum;
  }

  void look_at_the_start() {
    was_orderly_ = std::exchange(ledger_->ends_orderly, false);
    was_known_ = std::exchange(ledger_->knows_uptime, false);
    const double set = (value(Gain) - 1.0) / unit_of_sets;
    const bool is_one = set >= 0.0 && set == std::floor(set) && value(Time) == 20.0 + set * unit_of_sets;
    ledger_->torn_sets += is_one ? 0 : 1;
    ledger_->begun_full += full_until_ != never ? 1 : 0;
    const auto number = static_cast<std::uint64_t>(std::max(0.0, set));
    ledger_->lost_sets += number < ledger_->confirmed || number > ledger_->proposed ? 1 : 0;
    ledger_->confirmed = std::max(ledger_->confirmed, number);  // it is on the disk
    asked_from_ = ledger_->proposed;
  }

  /// The time that cycles make up, which the diagram counts. In a fault the output holds; what is behind it goes on.
  void look_at_uptime() {
    const double sample_time = static_cast<double>(stage_->plan.settings.period) * 1e-9;
    if (count(Fault) == 0) {
      const double begun = value(Uptime) - sample_time * value(Cycles);
      if (!std::exchange(knows_uptime_, true)) {
        const double slack = static_cast<double>(2 * stage_->quantum + second) * 1e-9;
        const bool is_well = !was_known_    ? begun >= ledger_->uptime_kept
                             : was_orderly_ ? std::abs(begun - ledger_->uptime) < 0.5 * sample_time
                                            : begun >= ledger_->uptime_kept && begun <= ledger_->uptime + slack;
        if (!is_well) {
          (void)std::fprintf(stderr, "began with %.4f s after %.4f s, of which %.4f s were kept\n", begun,
                             ledger_->uptime, ledger_->uptime_kept);
          ++ledger_->lost_uptime;
        }
        begun_ = begun;
      }
      ledger_->wrong_account += std::abs(begun - begun_) < 0.5 * sample_time ? 0 : 1;
    }
    ledger_->uptime = knows_uptime_ ? begun_ + sample_time * value(Cycles) : ledger_->uptime;
    ledger_->knows_uptime = knows_uptime_;
  }

  void look_at_counts(std::int64_t due) {
    const auto elapsed = static_cast<std::uint64_t>((due - ledger_->first_due) / stage_->plan.settings.period);
    const bool is_well = count(Cycles) == ledger_->cycles && count(Skipped) == ledger_->skipped &&
                         count(Elapsed) == elapsed && elapsed == ledger_->cycles + ledger_->skipped &&
                         // What the host takes from this machine is told of besides; an overload still to come counts
                         // with its cycle.
                         count(LateWake) + count(LateSteal) == lates_ &&
                         count(LateCpu) == overloads_ - (field_->overload > 0 ? 1 : 0);
    if (!is_well) {
      (void)std::fprintf(
          stderr,
          "at %.4f s the task counts %.0f cycles, %.0f skipped, %.0f/%.0f/%.0f late; the plant %llu, %llu, %llu/%llu\n",
          1e-9 * static_cast<double>(due), value(Cycles), value(Skipped), value(LateWake), value(LateSteal),
          value(LateCpu), static_cast<unsigned long long>(ledger_->cycles),
          static_cast<unsigned long long>(ledger_->skipped), static_cast<unsigned long long>(lates_),
          static_cast<unsigned long long>(overloads_));
      ++ledger_->wrong_account;
    }
  }

  void look_at_confirmations() {
    const std::uint64_t newest = asked_from_ + count(Commits);
    if (count(Commits) > 0 && newest > ledger_->confirmed) {
      ledger_->confirmed = newest;
      ++ledger_->confirmations;
      ledger_->confirmed_in_vain += full_until_ != never && count(Commits) > asked_before_full_ ? 1 : 0;
    }
  }

  void look_at_certificate(std::int64_t now) {
    const Certificate& one = stage_->plan.certificates[certificate_];
    const std::int64_t today = SimulatedTime::utc() - utc_ahead - monotonic_begin;
    const std::int64_t near = 5 * minute + 2 * stage_->quantum;
    const bool is_near = std::abs(today - one.until) < near || std::abs(today - one.from) < near;
    if (is_near || now < unchanged_since_ + 5 * minute + 3 * stage_->quantum) {
      return;
    }
    const bool counts = today > one.from && today < one.until;
    ledger_->wrong_certificate += (count(TlsFault) == 0) == counts ? 0 : 1;
    if (today > one.until && clock_until_ == never && !std::exchange(has_ended_, true)) {
      ++ledger_->certificate_ends;
    }
    has_ended_ = has_ended_ && !counts;
  }

  void write_certificate(std::uint64_t number) const {
    const CertificateFiles& one = stage_->certificates[number];
    for (const auto& [name, text] : {std::pair{"server.key", &one.key}, std::pair{"server.pem", &one.certificate}}) {
      const std::filesystem::path file = stage_->files.certificates / name;
      std::ofstream(file, std::ios::binary) << *text;
      std::filesystem::permissions(file, std::filesystem::perms(0600));
    }
  }

  const Stage* stage_;
  Ledger* ledger_;
  TankField* field_;
  Operator* operator_;
  runtime::PointDoor* door_ = nullptr;
  std::array<std::size_t, NameCount> places_{};
  runtime::Snapshot snapshot_{};
  std::size_t next_event_ = 0;
  std::int64_t next_ = 0;
  std::int64_t looks_at_;
  std::int64_t close_until_ = 0;
  std::int64_t lost_until_ = never;
  std::int64_t broken_until_ = never;
  std::int64_t full_until_ = never;
  std::int64_t clock_until_ = never;
  std::int64_t cut_until_ = never;
  std::int64_t unchanged_since_ = 0;  ///< certificate and wall clock
  std::uint64_t certificate_ = 0;
  std::uint64_t asked_ = 0;       ///< sets, in this life
  std::uint64_t asked_from_ = 0;  ///< sets before it
  std::uint64_t asked_before_full_ = 0;
  std::uint64_t failures_before_full_ = 0;
  std::uint64_t lates_ = 0;
  std::uint64_t overloads_ = 0;
  std::uint64_t retained_ = 0;
  double begun_ = 0.0;  ///< the uptime at the start
  bool knows_uptime_ = false;
  bool was_orderly_ = false;
  bool was_known_ = false;
  bool has_ended_ = false;
  bool is_ending_ = false;
};

}  // namespace

bool live(const Stage& stage, Ledger& ledger, std::int64_t from) try {
  auto changeable = std::make_unique<runtime::ChangeableProgram>(stage.program(ledger.version));
  const runtime::RunConfig config = run_config(stage.files, changeable->shape());
  TankField field(ledger, stage.plan.settings.period, config.task.outputs[0]);
  Operator changes(ledger, stage.program);
  Script script(stage, ledger, field, changes, from);
  SimulatedTime::at_wake([&](std::int64_t due) { return script.wake(due); });
  SimulatedTime::set_quantum(stage.quantum);
  SimulatedTime::expect(6);  // the host itself, its clock, retained values, trace, history; the operator
  const auto beside = [&](runtime::PointDoor& door, std::string&) -> std::shared_ptr<void> {
    script.see(door);
    return nullptr;
  };
  return runtime::run_host(
      *changeable, config,
      {.how = stage.how,
       .beside = beside,
       .changeable = changeable.get(),
       .take_changes = [&](runtime::OnlineChange& change, std::string&) { return changes.begin(change); },
       .field = &field},
      [](std::string_view text) { (void)std::fputs(std::string(text).c_str(), stderr); });
} catch (const InputError& refused) {
  const Diagnostic& first = refused.diagnostics().all().front();
  (void)std::fprintf(stderr, "refused: HY%d %s\n", static_cast<int>(first.number), first.cause.c_str());
  return false;
} catch (const std::exception& problem) {
  (void)std::fprintf(stderr, "ended: %s\n", problem.what());
  return false;
}

}  // namespace hysteron::soak
