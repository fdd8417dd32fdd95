#include "runtime/host/online_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "runtime/config/run_keys.hpp"
#include "runtime/host/notices.hpp"
#include "runtime/task/carry.hpp"
#include "runtime/task/clock.hpp"
#include "runtime/task/staged_parameters.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// How long the other version is stepped before it may count: far enough for what grows without bound to show.
constexpr std::size_t most_rehearsed = 1000;
/// But no longer than this: a step that takes a second is known after two.
constexpr std::chrono::seconds longest_rehearsal{2};
/// A step that is far too long is refused as soon as its mean is of that many steps and of so much time.
constexpr std::size_t least_rehearsed = 20;
constexpr std::chrono::milliseconds least_rehearsal{200};
/// Sets of parameters that are committed while a change is planned make it be planned again.
constexpr int most_plans = 5;

/// Nothing where there is none of that name.
std::optional<std::size_t> place_of(const std::vector<ProgramSignal>& signals, const std::string& name) {
  const auto found = std::ranges::find(signals, name, &ProgramSignal::name);
  return found == signals.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - signals.begin()));
}

/// Nothing where there is none of that name.
std::optional<double> parameter_named(const StepProgram& program, const std::string& name) {
  const auto place = place_of(program.shape().parameters, name);
  return place ? std::optional(program.parameter(*place)) : std::nullopt;
}

/// By their bits: a limit that is off is no number.
bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void refuse_bump(Diagnostics& found, const OutputChange& output, const std::string& when) {
  const std::string unit = output.unit.empty() ? "" : " " + output.unit;
  if (!std::isfinite(output.bump.after)) {
    found.error(error::bump_too_large, {}, fmt::format("The output {} would be no number{}.", output.name, when),
                "mend the diagram; `hysteron run` shows where it comes from.");
    return;
  }
  found.error(error::bump_too_large, {},
              fmt::format("The output {} would jump by {:.6g}{} from {:.6g} to {:.6g}{}; its limit is {:.6g}{} ({}).",
                          output.name, output.bump.size, unit, output.bump.before, output.bump.after, when,
                          output.limit, unit, output.origin),
              fmt::format("bring the process to where both versions agree, or allow it with --bump {}={:.3g}.",
                          output.name, std::max(output.bump.size * 1.05, 1e-300)));
}

/// While it lives, nobody commits parameters.
std::shared_ptr<void> held_commits(TaskDoor& door) {
  door.hold_commits(true);
  return {&door, [](void* held) { static_cast<TaskDoor*>(held)->hold_commits(false); }};
}

}  // namespace

struct OnlineChange::Plan {
  ProgramVersion& next;
  std::vector<double> given;  ///< parameters as the next version has them
  /// What its states begin with where they are not carried over; else they begin as after a reset.
  std::optional<std::vector<std::byte>> own_state{};
  StepImage image{};
  ProposedChange change{};
  ChangeReport report{};
};

OnlineChange::OnlineChange(ChangeableProgram& program, Task& task, std::vector<OutputLimit> limits, double most_load)
    : program_(&program), task_(&task), limits_(std::move(limits)), most_load_(most_load) {}

void OnlineChange::begin(Retainer* retainer, const Trace* trace, ServedMap* registers) {
  retainer_ = retainer;
  trace_ = trace;
  registers_ = registers;
  has_begun_.store(true, std::memory_order_release);
}

template <class Ready>
bool OnlineChange::wait_for(const Ready& ready) const {
  const std::chrono::nanoseconds five_periods(5 * program_->shape().period);
  const auto until = SteadyClock::now() + std::max<std::chrono::nanoseconds>(std::chrono::seconds(2), five_periods);
  while (!ready()) {
    if (has_ended_.load() || SteadyClock::now() > until) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

template <class Ready, class Withdraw>
bool OnlineChange::wait_or_withdraw(const Ready& ready, const Withdraw& withdraw) const {
  if (!wait_for(ready) && withdraw()) {
    return false;
  }
  while (!ready()) {
    std::this_thread::yield();  // it is at work
  }
  return true;
}

void OnlineChange::refuse_for_now(const std::string& why, const std::string& mend) const {
  throw InputError(error::online_change_not_now, {}, why,
                   !mend.empty()       ? mend
                   : has_ended_.load() ? "start the task with the new version: retained values are carried over."
                                       : "see to that, and ask for the change again.");
}

StepImage OnlineChange::image() {
  const StepProgram& running = program_->version().program();
  const ProgramShape& shape = running.shape();
  StepImage image{.parameters = std::vector<double>(shape.parameters.size()),
                  .state = std::vector<std::byte>(running.state_size()),
                  .inputs = std::vector<double>(shape.inputs.size()),
                  .outputs = std::vector<double>(shape.outputs.size())};
  program_->ask_for_image(image);
  if (!wait_or_withdraw([&] { return program_->has_image(); }, [&] { return program_->withdraw_image(); })) {
    const FaultReport faults = task_->faults();
    refuse_for_now(has_ended_.load() ? "The task ends."
                                     : fmt::format("The diagram is not stepped; the last fault of the task was: {}.",
                                                   name_of(faults.last)));
  }
  return image;
}

void OnlineChange::plan(Plan& plan, const ChangeWish& wish) const {
  StepProgram& next = plan.next.program();
  const ProgramShape& shape = next.shape();
  const StepProgram& running = program_->version().program();
  ChangeReport& report = plan.report;
  ProposedChange& change = plan.change;
  const KeptLayout layout = read_description(describe(running.shape()), running.state_size());
  CarriedValues carried = carry_parameters(layout, plan.image.parameters, shape, plan.given);
  for (const std::string& name : wish.as_given) {
    const std::size_t place = place_of(shape.parameters, name).value();
    carried.parameters[place] = plan.given[place];
    const auto is_left = [&](const std::string& left) { return without_reason(left) == name; };
    if (std::ranges::none_of(carried.left, is_left)) {
      carried.left.push_back(name + " (as given)");
      --carried.parameters_taken;
    }
  }
  if (const auto why = refusal_of(shape, carried.parameters, plan.given); !why.empty()) {
    throw InputError(error::carried_parameters_unfit, {},
                     "The parameters carried over cannot be beside those of the new version: " + why,
                     "change them in the running task first, or take them as the diagram has them: --as-given NAME.");
  }
  set_parameters(next, carried.parameters);
  for (std::size_t i = 0; i < carried.parameters.size(); ++i) {
    const ProgramSignal& one = shape.parameters[i];
    if (!is_same(carried.parameters[i], plan.given[i])) {
      report.other_values.push_back(fmt::format("{} = {}{} ({} {})", one.name, number_text(carried.parameters[i]),
                                                one.unit.empty() ? "" : " " + one.unit, number_text(plan.given[i]),
                                                plan.own_state ? "before the change" : "in the files"));
    }
  }
  next.reset();  // what starts at a parameter starts at the carried one
  change.start = plan.own_state ? *plan.own_state : state_of(next);
  change.to = &plan.next;
  change.parameters = plan.image.parameters;
  change.from.resize(running.state_size());
  change.into = change.start;
  change.shared = carry_state(layout, plan.image.state, shape, change.into, carried);
  change.outputs.resize(shape.outputs.size());
  change.bumps.resize(shape.outputs.size());
  for (std::size_t i = 0; i < shape.outputs.size(); ++i) {
    const auto own = wish.bumps.find(shape.outputs[i].name);
    BumpLimit limit = limits_[i].limit;
    limit.most = own == wish.bumps.end() ? limit.most : own->second;
    change.limits.push_back(limit);
    report.outputs.push_back({.name = shape.outputs[i].name,
                              .unit = shape.outputs[i].unit,
                              .limit = limit.most,
                              .origin = own == wish.bumps.end() ? limits_[i].origin : "--bump"});
  }
  report.program = shape.name;
  report.version = program_->version_number();
  report.parameters = shape.parameters.size();
  report.parameters_carried = carried.parameters_taken;
  report.states = shape.state.size();
  report.states_carried = carried.states_taken;
  for (std::string& one : carried.left) {
    // What only this version has is new in it; on the way back it goes on as it was.
    if (plan.own_state && is_new(one)) {
      report.as_before.push_back(without_reason(one));
    } else {
      report.left.push_back(std::move(one));
    }
  }
}

/// The other version steps on the inputs of the image, and goes on with them for a while.
void OnlineChange::rehearse(Plan& plan, const ChangeWish& wish) const {
  StepProgram& next = plan.next.program();
  ProposedChange& change = plan.change;
  Diagnostics found;
  next.restore(change.into);
  next.step(plan.image.inputs, change.outputs);
  for (std::size_t i = 0; i < change.outputs.size(); ++i) {
    OutputChange& output = plan.report.outputs[i];
    output.bump = bump_of(plan.image.outputs[i], change.outputs[i], change.limits[i]);
    if (!output.bump.is_within(change.limits[i])) {
      refuse_bump(found, output, "");
    }
  }
  if (found.has_errors()) {
    throw InputError(std::move(found));
  }
  ChangeReport& report = plan.report;
  // What ran before may run again: it has to fit into the period, and no more.
  report.most_load = wish.load.value_or(plan.own_state ? 1.0 : most_load_);
  const auto period = static_cast<double>(program_->shape().period);
  const auto begin = SteadyClock::now();
  const std::int64_t began = own_cpu_now();
  for (bool goes_on = true; goes_on;) {
    next.step(plan.image.inputs, change.outputs);
    ++report.rehearsed;
    const auto bad = std::ranges::find_if(change.outputs, [](double value) { return !std::isfinite(value); });
    if (bad != change.outputs.end()) {
      OutputChange& output = report.outputs[static_cast<std::size_t>(bad - change.outputs.begin())];
      output.bump.after = *bad;
      refuse_bump(found, output, fmt::format(" {} steps after the change", report.rehearsed));
      throw InputError(std::move(found));
    }
    report.step_time = static_cast<double>(own_cpu_now() - began) / static_cast<double>(report.rehearsed);
    report.load = report.step_time / period;
    const auto passed = SteadyClock::now() - begin;
    const bool is_known = report.rehearsed >= least_rehearsed && passed >= least_rehearsal;
    goes_on = report.rehearsed < most_rehearsed && passed < longest_rehearsal &&
              !(is_known && report.load > report.most_load);
  }
  require_room(report, wish.load.has_value());
}

void OnlineChange::require_room(const ChangeReport& report, bool by_wish) const {
  if (report.load <= report.most_load) {
    return;
  }
  const bool is_too_long = report.load > 1.0;
  throw InputError(
      error::online_change_not_now, {},
      fmt::format("A step of the new version takes {}, {:.3g} % of the period of {}; the limit is {:.3g} % ({}).",
                  short_time_text(report.step_time), 100.0 * report.load,
                  time_text(static_cast<double>(program_->shape().period)), 100.0 * report.most_load,
                  by_wish ? "--load" : "load under [online_change] in the run file at the start"),
      is_too_long ? "leave out what costs most, or state a longer sample time and start the task with it."
                  : fmt::format("leave out what costs most, or allow it for this change: --load {:.2g}.",
                                std::min(1.0, 1.1 * report.load)));
}

ChangeVerdict OnlineChange::propose(Plan& plan) {
  if (retainer_ != nullptr && plan.next.retained == nullptr) {
    StepProgram& next = plan.next.program();
    next.reset();
    plan.next.retained = std::make_unique<RetainImage>(next, state_of(next), retainer_->inputs());
  }
  retained_before_ = retainer_ == nullptr ? 0 : plan.next.retained->written();
  if (trace_ != nullptr) {
    plan.next.traced = std::make_unique<TraceProgram>(plan.next.program());
  }
  if (plan.next.sound == nullptr) {
    plan.next.sound = std::make_unique<SoundState>(plan.next.program());
  }
  program_->propose(plan.change);
  if (!wait_or_withdraw([&] { return program_->is_decided(); }, [&] { return program_->withdraw(); })) {
    refuse_for_now("The task did not take the change up: it steps the diagram no more.");
  }
  return plan.change.verdict;
}

ChangeReport OnlineChange::carry_out(const Plan& begin, const ChangeWish& wish) {
  for (int i = 0; i < most_plans; ++i) {
    Plan made{.next = begin.next, .given = begin.given, .own_state = begin.own_state, .image = image()};
    plan(made, wish);
    rehearse(made, wish);
    if (wish.only_check) {
      return std::move(made.report);
    }
    const ChangeVerdict verdict = propose(made);
    for (std::size_t output = 0; output < made.change.bumps.size(); ++output) {
      made.report.outputs[output].bump = made.change.bumps[output];
    }
    if (verdict == ChangeVerdict::taken) {
      made.report.is_done = true;
      return std::move(made.report);
    }
    if (verdict == ChangeVerdict::bump) {
      Diagnostics found;
      refuse_bump(found, made.report.outputs[made.change.too_large], " in the step of the change");
      throw InputError(std::move(found));
    }
    // Parameters came meanwhile, which counted before: it is planned again, with these.
  }
  refuse_for_now("Parameters are committed faster than a change can be planned.");
}

std::unique_lock<std::mutex> OnlineChange::one_at_a_time() {
  std::unique_lock lock(under_way_, std::try_to_lock);
  if (!lock.owns_lock()) {
    refuse_for_now("Another online change is under way.");
  }
  if (!has_begun_.load(std::memory_order_acquire)) {
    refuse_for_now("The task has not begun yet.");
  }
  return lock;
}

void OnlineChange::tell_refused(const InputError& refused) const {
  program_->tell(ChangeOutcome::refused);
  for (const Diagnostic& one : refused.diagnostics().all()) {
    tell("Online change", fmt::format("refused, HY{}: {}", one.number, one.cause));
  }
}

void OnlineChange::keep_as_given(const std::vector<std::string>& names) {
  as_given_.clear();
  for (const std::string& name : names) {
    if (const auto value = parameter_named(program_->version().program(), name)) {
      as_given_[name] = *value;
    }
  }
}

void OnlineChange::tell_changed(ChangeReport& report, ChangeOutcome outcome) {
  ProgramVersion& version = program_->version();
  program_->tell(outcome);
  report.version = program_->version_number();
  // A crash from here on shall find the values of this version on the disk.
  report.is_retained = retainer_ == nullptr || wait_for([&] { return version.retained->written() > retained_before_; });
  tell("Online change",
       fmt::format("{}version {} of {} runs; {} of {} parameters and {} of {} states are carried over",
                   outcome == ChangeOutcome::back ? "back: " : "", report.version, report.program,
                   report.parameters_carried, report.parameters, report.states_carried, report.states),
       Weight::notice);
}

std::optional<NextMap> OnlineChange::next_map(const ProgramVersion& version) const {
  if (registers_ == nullptr) {
    return {};
  }
  return registers_->next(
      task_->door().points_of({.program = version.program(), .places = version.parameters(), .parameters = {}}),
      version.program());
}

void OnlineChange::tell_door(std::optional<NextMap> registers) {
  const ProgramVersion& version = program_->version();
  task_->door().version_changed({.program = version.program(),
                                 .places = version.parameters(),
                                 .parameters = program_->parameters(),
                                 .live = version.live,
                                 .number = program_->version_number()});
  if (registers) {
    registers_->show(std::move(*registers));
  }
}

void OnlineChange::require_sound(const ProgramShape& next, const ChangeWish& wish) const {
  require_same_interface(program_->shape(), next);
  (void)as_named(wish, next);
}

ChangeReport OnlineChange::change_to(std::unique_ptr<StepProgram> program, const ChangeWish& asked) {
  try {
    const auto lock = one_at_a_time();
    require_same_interface(program_->shape(), program->shape());
    const ChangeWish wish = as_named(asked, program->shape());
    auto next = std::make_unique<ProgramVersion>(std::move(program), program_->shape(), program_->parameters());
    next->live = task_->door().live_row({.program = next->program(), .places = next->parameters()});
    auto registers = next_map(*next);
    auto held = wish.only_check ? nullptr : held_commits(task_->door());
    ChangeReport report = carry_out({.next = *next, .given = parameters_of(next->program())}, wish);
    report.registers = registers ? registers->change : RegisterChange{};
    if (wish.only_check) {
      return report;
    }
    const auto gone = program_->keep(std::move(next));
    keep_as_given(wish.as_given);
    tell_door(std::move(registers));
    held.reset();
    tell_changed(report, ChangeOutcome::changed);
    if (retainer_ != nullptr) {
      retainer_->let_go();  // of the version that is gone
    }
    return report;
  } catch (const InputError& refused) {
    if (!asked.only_check) {
      tell_refused(refused);
    }
    throw;
  }
}

ChangeReport OnlineChange::nothing_to_change() const {
  const ProgramShape& shape = program_->version().program().shape();
  return {.program = shape.name,
          .version = program_->version_number(),
          .parameters = shape.parameters.size(),
          .parameters_carried = shape.parameters.size(),
          .states = shape.state.size(),
          .states_carried = shape.state.size()};
}

ChangeReport OnlineChange::change_back(const ChangeWish& asked) {
  try {
    const auto lock = one_at_a_time();
    ProgramVersion* const former = program_->former();
    if (former == nullptr) {
      refuse_for_now("There is no version before this one: none was changed since the start.",
                     "put the files as you want them, and give the command without --back.");
    }
    StepProgram& program = former->program();
    ChangeWish wish = as_named(asked, program.shape());
    for (const auto& [name, value] : as_given_) {
      const auto now = parameter_named(program_->version().program(), name);
      if (now && is_same(*now, value) && parameter_named(program, name)) {
        wish.as_given.push_back(name);
      }
    }
    const Plan begin{.next = *former, .given = parameters_of(program), .own_state = state_of(program)};
    const auto as_it_was = [&] {
      set_parameters(program, begin.given);
      program.restore(*begin.own_state);
    };
    try {
      auto registers = next_map(*former);
      auto held = wish.only_check ? nullptr : held_commits(task_->door());
      ChangeReport report = carry_out(begin, wish);
      report.registers = registers ? registers->change : RegisterChange{};
      if (wish.only_check) {
        as_it_was();
        return report;
      }
      program_->keep_former();
      keep_as_given(wish.as_given);
      tell_door(std::move(registers));
      held.reset();
      tell_changed(report, ChangeOutcome::back);
      return report;
    } catch (const InputError&) {
      as_it_was();
      throw;
    }
  } catch (const InputError& refused) {
    if (!asked.only_check) {
      tell_refused(refused);
    }
    throw;
  }
}

std::unique_ptr<OnlineChange> online_change(const RunConfig& config, ChangeableProgram* program, Task& task) {
  if (config.online_change && program == nullptr) {
    tell("Online change", "[online_change] has no effect here: only `hysteron serve` can compile a new version.");
  }
  return config.online_change && program != nullptr
             ? std::make_unique<OnlineChange>(*program, task, bump_limits(config, program->shape()),
                                              config.online_change->most_load)
             : nullptr;
}

}  // namespace hysteron::runtime
