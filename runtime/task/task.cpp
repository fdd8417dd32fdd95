#include "runtime/task/task.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hysteron::runtime {
namespace {

const TaskSettings& fitting(const TaskSettings& settings, const ProgramShape& shape) {
  if (settings.inputs.size() != shape.inputs.size() || settings.outputs.size() != shape.outputs.size()) {
    throw std::invalid_argument("the settings of a task name other inputs and outputs than its program has");
  }
  return settings;
}

}  // namespace

Task::Task(StepProgram& program, const TaskSettings& settings, TaskAttachments attachments)
    : program_(&program),
      settings_(fitting(settings, program.shape())),
      attachments_(attachments),
      door_(program, settings.inputs, settings.outputs, settings.field_points),
      safe_(settings.outputs, static_cast<double>(program.shape().period) * 1e-9),
      first_sound_(program),
      watchdog_(settings.watchdog),
      load_(program.shape().period, settings.most_load),
      field_counts_(settings.field_points.size()),
      forces_(program.shape().inputs.size()),
      computed_(program.shape().outputs.size()),
      writes_seen_(program.shape().inputs.size(), 0),
      ages_(program.shape().inputs.size(), 0) {
  settings_.loop.period = program.shape().period;
  status_.field = field_counts_;
  for (std::size_t i = 0; i < program.shape().inputs.size(); ++i) {
    const double start = settings_.inputs[i].start.value_or(program.shape().inputs[i].preset);
    given_.push_back(start);
    inputs_.push_back(start);
    last_good_.push_back(start);
  }
}

void Task::client_lost(bool lost) noexcept {
  if (lost && settings_.reset_after_lost_client) {
    client_was_lost_.store(true, std::memory_order_relaxed);
  }
  client_is_lost_.store(lost, std::memory_order_relaxed);
}

void Task::guard_lost() noexcept {
  guard_is_lost_.store(true, std::memory_order_relaxed);
}

LoopEnd Task::run(Clock& clock, const std::atomic<bool>& stop) {
  status_.state = TaskState::running;
  const LoopEnd end = run_loop(settings_.loop, clock, *this, stop, statistics_);
  if (!guard_took_over_) {
    settle(clock, end == LoopEnd::missed ? Fault::missed_cycle
                  : tripped_             ? Fault::hang
                  : guard_is_lost_       ? Fault::lost_guard
                                         : Fault::stop);
  }
  return end;
}

bool Task::cycle(const CycleMoment& moment) noexcept {
  beat();
  if (attachments_.guard != nullptr) {
    attachments_.guard->cycle_begins(moment.start);
  }
  take_orders();
  Fault fault = read_inputs();
  if (tripped_) {
    fault = Fault::hang;
    faulty_port_ = no_port;
    is_awaited_ = false;
  } else {
    if (attachments_.trace != nullptr) {
      attachments_.trace->before_step(moment.number, running());
    }
    program_->step(inputs_, computed_);
    follow_change(moment.number);
  }
  safe_.step(computed_, fault);
  status_.held_back += safe_.held_back();
  status_.fault = is_awaited_ ? Fault::none : safe_.worst();
  status_.state = is_awaited_                    ? TaskState::starting
                  : status_.fault == Fault::none ? TaskState::running
                                                 : TaskState::faulted;
  faults_.note(status_.fault, status_.fault == fault ? faulty_port_ : inputs_.size() + safe_.worst_output());
  const bool written = write_outputs();
  if (attachments_.trace != nullptr && !tripped_) {
    attachments_.trace->step(moment.number, moment.period, status_.fault, inputs_, computed_, safe_.values());
  }
  if (!tripped_) {
    keep_sound();
  }
  return written;
}

/// The version may have changed with the step just made: what is kept and traced is of the new one from that step on.
void Task::follow_change(std::uint64_t cycle) noexcept {
  ProposedChange* const change = attachments_.changes == nullptr ? nullptr : attachments_.changes->taken();
  if (change == nullptr) {
    return;
  }
  if (attachments_.trace != nullptr) {
    attachments_.trace->program_changed(cycle, running(), change->into, *change->to->traced);
  }
  if (attachments_.retainer != nullptr) {
    attachments_.retainer->change(*change->to->retained);
  }
  sound_ = change->to->sound == nullptr ? &first_sound_ : change->to->sound.get();
  sound_->begin_with(change->into);
  has_changed_ = true;
  attachments_.changes->conclude();
}

void Task::keep_sound() noexcept {
  const bool are_numbers = std::ranges::all_of(computed_, [](double value) { return std::isfinite(value); });
  if (sound_->follow(*program_, are_numbers) && attachments_.trace != nullptr) {
    attachments_.trace->was_restored();
  }
}

void Task::take_orders() noexcept {
  for (std::uint64_t& age : ages_) {
    ++age;
  }
  const TaskOrders* const orders = door_.take_orders();
  if (orders == nullptr) {
    return;
  }
  for (std::size_t i = 0; i < given_.size(); ++i) {
    if (orders->input_writes[i] != writes_seen_[i]) {
      writes_seen_[i] = orders->input_writes[i];
      given_[i] = orders->inputs[i];
      ages_[i] = 0;
    }
  }
  if (orders->forcing != forcing_seen_) {
    forcing_seen_ = orders->forcing;
    std::ranges::copy(orders->forces, forces_.begin());
  }
  if (orders->commits != applied_commits_) {
    applied_commits_ = orders->commits;
    set_parameters(*program_, orders->parameters);
    if (attachments_.trace != nullptr) {
      attachments_.trace->parameters_changed(running());
    }
  }
  if (orders->resets != resets_seen_) {
    resets_seen_ = orders->resets;
    tripped_ = false;
    client_was_lost_.store(false, std::memory_order_relaxed);
    watchdog_ = Watchdog(settings_.watchdog);
    end_forces();
    program_->reset();
    sound_->begin_with(running());
    if (attachments_.trace != nullptr) {
      attachments_.trace->was_reset();
    }
  }
  if (tripped_) {
    end_forces();
  }
  status_.heartbeat = orders->heartbeat;
}

void Task::end_forces() noexcept {
  std::ranges::fill(forces_, std::nullopt);
  door_.forces_ended(forcing_seen_);
}

Fault Task::read_inputs() noexcept {
  Fault fault = attachments_.field == nullptr ? Fault::none : attachments_.field->read(given_);
  faulty_port_ = fault == Fault::none ? no_port : attachments_.field->faulty_port();
  is_awaited_ = fault != Fault::none && attachments_.field->is_awaited();
  const auto is_free = [&] { return fault == Fault::none || is_awaited_; };
  const auto found = [&](Fault one, std::size_t port) {
    fault = one;
    faulty_port_ = port;
    is_awaited_ = false;
  };
  if (is_free() &&
      (client_is_lost_.load(std::memory_order_relaxed) || client_was_lost_.load(std::memory_order_relaxed))) {
    found(Fault::lost_client, no_port);
  }
  if (is_free() && settings_.overload_is_a_fault && load_.is_too_much()) {
    found(Fault::overload, no_port);
  }
  status_.forced = 0;
  for (std::size_t i = 0; i < given_.size(); ++i) {
    const bool stale = settings_.inputs[i].longest_age > 0 && ages_[i] > settings_.inputs[i].longest_age;
    const bool is_number = std::isfinite(given_[i]);
    if ((stale || !is_number) && is_free()) {
      found(Fault::stale_input, i);
    }
    // A number that is none would stay in the program's state for ever.
    given_[i] = is_number ? given_[i] : last_good_[i];
    last_good_[i] = given_[i];
    // A forced value hides no fault of what gives the input.
    inputs_[i] = forces_[i].value_or(given_[i]);
    status_.forced += forces_[i] ? 1 : 0;
  }
  return fault;
}

bool Task::write_outputs() noexcept {
  if (attachments_.guard != nullptr) {
    attachments_.guard->cycle_ends(safe_.values());
    if (!attachments_.guard->may_write()) {
      guard_took_over_ = true;
      status_.fault = attachments_.guard->fault();
      status_.state = TaskState::faulted;
      faults_.note(status_.fault);
      return false;
    }
  }
  if (attachments_.field != nullptr) {
    attachments_.field->write(safe_.values());
  }
  return true;
}

bool Task::finished(const LoopStatistics& statistics, std::int64_t duration, Verdict /*verdict*/) noexcept {
  load_.finished(statistics);
  status_.load = load_.load();
  if (!tripped_ && watchdog_.finished(duration)) {
    tripped_ = true;
    end_forces();
    status_.forced = 0;
    status_.state = TaskState::faulted;
    status_.fault = Fault::hang;
    faults_.note(Fault::hang);
  }
  if (attachments_.retainer != nullptr) {
    const bool is_due = settings_.retain_every > 0 && statistics.run % settings_.retain_every == 0;
    if ((is_due || applied_commits_ != offered_commits_ || has_changed_) && !tripped_) {
      attachments_.retainer->offer(running(), applied_commits_, given_);
      offered_commits_ = applied_commits_;
      has_changed_ = false;
    }
  }
  publish(statistics);
  return !guard_is_lost_.load(std::memory_order_relaxed);
}

void Task::publish(const LoopStatistics& statistics) noexcept {
  count_writes();
  status_.not_taken = attachments_.field == nullptr ? 0 : attachments_.field->not_taken();
  status_.faults = faults_.newest().count;
  status_.last_fault = faults_.newest().last;
  if (attachments_.field != nullptr) {
    attachments_.field->count(field_counts_);
    status_.absent = attachments_.field->absent();
  }
  const ChangeableProgram* const changes = attachments_.changes;
  door_.publish(*program_, inputs_, safe_.values(), status_, statistics, forces_,
                changes == nullptr ? LiveVersion{} : changes->live());
}

void Task::count_writes() noexcept {
  status_.write_failures = 0;
  status_.commits = applied_commits_;
  if (attachments_.retainer != nullptr) {
    status_.commits = attachments_.retainer->saved_commits();
    status_.retained = attachments_.retainer->written();
    status_.write_failures += attachments_.retainer->failures();
    status_.retain_fails = attachments_.retainer->is_failing();
  }
  if (attachments_.trace != nullptr) {
    status_.dropped = attachments_.trace->dropped();
    status_.trace_is_cut = attachments_.trace->is_cut();
    status_.write_failures += status_.trace_is_cut ? 1 : 0;
  }
  status_.history = attachments_.history == nullptr ? KeptCount{} : attachments_.history->read();
  status_.mqtt = attachments_.mqtt == nullptr ? KeptCount{} : attachments_.mqtt->read();
  status_.tls_fault = tls_fault_.load(std::memory_order_relaxed);
  status_.tls_days = tls_days_.load(std::memory_order_relaxed);
  if (attachments_.changes != nullptr) {
    status_.version = attachments_.changes->version_number();
    status_.last_change = static_cast<std::uint8_t>(attachments_.changes->outcome());
  }
}

void Task::settle(Clock& clock, Fault fault) {
  // To end as asked is no fault; what was wrong just before still is.
  const Fault held = status_.fault == Fault::none || fault != Fault::stop ? fault : status_.fault;
  if (fault != Fault::stop) {
    faults_.note(fault);
  }
  std::int64_t waited = 0;
  Delivery delivery = Delivery::pending;
  for (std::int64_t due = clock.now() + settings_.loop.period;; due += settings_.loop.period) {
    beat();
    if (attachments_.guard != nullptr) {
      attachments_.guard->cycle_begins(clock.now());
    }
    safe_.step(computed_, fault);
    if (!write_outputs() || safe_.stuck()) {
      break;
    }
    if (safe_.settled()) {
      delivery = attachments_.field == nullptr ? Delivery::done : attachments_.field->delivery();
      waited += settings_.loop.period;
    }
    if (delivery != Delivery::pending || waited > settings_.longest_delivery) {
      break;
    }
    status_.fault = held;
    publish(statistics_);
    clock.sleep_until(due);
  }
  if (attachments_.retainer != nullptr && !tripped_) {
    attachments_.retainer->offer(running(), applied_commits_, given_);
  }
  if (!guard_took_over_) {
    status_.state = tripped_ ? TaskState::faulted : TaskState::stopped;
    if (!safe_.settled()) {
      status_.fault = Fault::not_safe;
      faults_.note(Fault::not_safe);
    } else if (delivery != Delivery::done) {
      status_.fault = Fault::lost_link;
      faults_.note(Fault::lost_link, attachments_.field->faulty_port());
    } else {
      status_.fault = held;
    }
    // Where a device has not taken its safe value, the guard goes on once this process is gone, as after a crash.
    if (attachments_.guard != nullptr && delivery == Delivery::done) {
      (void)attachments_.guard->goodbye();
    }
  }
  publish(statistics_);
}

}  // namespace hysteron::runtime
