#include "runtime/host/online_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "runtime/host/notices.hpp"
#include "runtime/task/carry.hpp"
#include "runtime/task/clock.hpp"
#include "runtime/task/staged_parameters.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

using SteadyClock = std::chrono::steady_clock;

/// Of the range of an output: what the EnTech Control Valve Dynamic Specification (version 3.0, 1998) counts as a small
/// step of a valve's input, "1% and less".
constexpr double part_of_range = 0.01;
/// How long the other version is stepped before it may count: far enough for what grows without bound to show.
constexpr std::size_t rehearsed_steps = 1000;
/// Sets of parameters that are committed while a change is planned make it be planned again.
constexpr int most_plans = 5;

std::string signal_text(const ProgramSignal& signal) {
  return signal.name + (signal.unit.empty() ? "" : " in " + signal.unit);
}

/// What of a signal must stay, as its registers and devices were planned with it.
void require_same_signals(const char* kind, const std::vector<ProgramSignal>& has,
                          const std::vector<ProgramSignal>& next, Diagnostics& found) {
  const auto refuse = [&](const std::string& cause) {
    found.error(error::other_interface, {}, cause,
                fmt::format("leave the {}s as they are, or end the task and start it with the new version: retained "
                            "values are carried over.",
                            kind));
  };
  for (std::size_t i = 0; i < has.size() || i < next.size(); ++i) {
    if (i >= next.size()) {
      refuse(fmt::format("The {} {} is gone.", kind, signal_text(has[i])));
    } else if (i >= has.size()) {
      refuse(fmt::format("The {} {} is new.", kind, signal_text(next[i])));
    } else if (has[i].name != next[i].name) {
      refuse(fmt::format("The {} {} stands where {} was.", kind, signal_text(next[i]), signal_text(has[i])));
      return;  // all behind it are shifted
    } else if (has[i].unit != next[i].unit) {
      refuse(fmt::format("The {} {} has another unit: {}.", kind, signal_text(has[i]), next[i].unit));
    } else if (has[i].type != next[i].type) {
      refuse(fmt::format("The {} {} has another type.", kind, has[i].name));
    } else if (has[i].low != next[i].low || has[i].high != next[i].high) {
      refuse(fmt::format("The range of the {} {} was {} to {}, and is {} to {}.", kind, has[i].name,
                         number_text(has[i].low), number_text(has[i].high), number_text(next[i].low),
                         number_text(next[i].high)));
    }
  }
}

void require_same_interface(const ProgramShape& has, const ProgramShape& next) {
  Diagnostics found;
  if (has.period != next.period) {
    found.error(error::other_interface, {},
                fmt::format("The sample time was {} ns, and is {} ns.", has.period, next.period),
                "keep it, or end the task and start it with the new version.");
  }
  require_same_signals("input", has.inputs, next.inputs, found);
  require_same_signals("output", has.outputs, next.outputs, found);
  if (found.has_errors()) {
    throw InputError(std::move(found));
  }
}

/// Nothing where there is none of that name.
std::optional<std::size_t> place_of(const std::vector<ProgramSignal>& signals, const std::string& name) {
  const auto found = std::ranges::find(signals, name, &ProgramSignal::name);
  return found == signals.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - signals.begin()));
}

/// No number where there is none of that name.
double parameter_named(const StepProgram& program, const std::string& name) {
  const auto place = place_of(program.shape().parameters, name);
  return place ? program.parameter(*place) : not_a_number;
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

std::vector<OutputLimit> bump_limits(const RunConfig& config, const ProgramShape& shape) {
  std::vector<OutputLimit> limits;
  for (std::size_t i = 0; i < shape.outputs.size(); ++i) {
    const OutputSafety& safety = config.task.outputs[i];
    const double low = std::max(shape.outputs[i].low, safety.low);
    const double high = std::min(shape.outputs[i].high, safety.high);
    const bool is_analog = is_real(shape.outputs[i].type);
    OutputLimit one{.limit = {.low = low, .high = high}};
    if (const auto given = config.bumps.find(i); given != config.bumps.end()) {
      one.limit.most = given->second;
      one.origin = "bump in the run file";
    } else if (is_analog && std::isfinite(low) && std::isfinite(high)) {
      one.limit.most = part_of_range * (high - low);
      one.origin = fmt::format("1 % of {:.6g} to {:.6g}", low, high);
    } else {
      one.origin = is_analog ? "it has no low and high" : "it is no real number";
    }
    limits.push_back(std::move(one));
  }
  return limits;
}

struct OnlineChange::Plan {
  ProgramVersion& next;
  std::vector<double> given;  ///< parameters as the next version has them
  /// What its states begin with where they are not carried over; else they begin as after a reset.
  std::optional<std::vector<std::byte>> own_state{};
  StepImage image{};
  ProposedChange change{};
  ChangeReport report{};
};

OnlineChange::OnlineChange(ChangeableProgram& program, Task& task, std::vector<OutputLimit> limits)
    : program_(&program), task_(&task), limits_(std::move(limits)) {}

void OnlineChange::begin(Retainer* retainer, const Trace* trace) {
  retainer_ = retainer;
  trace_ = trace;
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

void OnlineChange::refuse_for_now(const std::string& why) const {
  throw InputError(error::online_change_not_now, {}, why,
                   has_ended_.load() ? "start the task with the new version: retained values are carried over."
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
    const auto place = place_of(shape.parameters, name);
    if (!place) {
      throw InputError(error::bad_usage, {}, fmt::format("The new version has no parameter {}.", name),
                       "write a name as `hysteron map` lists it.");
    }
    carried.parameters[*place] = plan.given[*place];
    const auto is_left = [&](const std::string& left) { return left.starts_with(name + " ("); };
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
    if (carried.parameters[i] != plan.given[i]) {
      report.other_values.push_back(fmt::format("{} = {}{} ({} in the diagram)", one.name,
                                                number_text(carried.parameters[i]),
                                                one.unit.empty() ? "" : " " + one.unit, number_text(plan.given[i])));
    }
    const bool is_reached = std::ranges::any_of(plan.next.parameters(), [&](const auto& place) { return place == i; });
    if (!is_reached) {
      report.without_register.push_back(one.name);
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
  for (const auto& [name, most] : wish.bumps) {
    if (!place_of(shape.outputs, name)) {
      throw InputError(error::bad_usage, {}, fmt::format("There is no output {} whose jump could be limited.", name),
                       "write a name as `hysteron map` lists it.");
    }
  }
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
  report.left = std::move(carried.left);
}

/// The other version steps on the inputs of the image, and goes on with them for a while.
void OnlineChange::rehearse(Plan& plan) const {
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
  const std::int64_t began = own_cpu_now();
  for (std::size_t step = 1; step <= rehearsed_steps; ++step) {
    next.step(plan.image.inputs, change.outputs);
    const auto bad = std::ranges::find_if(change.outputs, [](double value) { return !std::isfinite(value); });
    if (bad != change.outputs.end()) {
      OutputChange& output = plan.report.outputs[static_cast<std::size_t>(bad - change.outputs.begin())];
      output.bump.after = *bad;
      refuse_bump(found, output, fmt::format(" {} steps after the change", step));
      throw InputError(std::move(found));
    }
  }
  plan.report.step_time = static_cast<double>(own_cpu_now() - began) / static_cast<double>(rehearsed_steps);
  if (plan.report.step_time > static_cast<double>(program_->shape().period)) {
    refuse_for_now(fmt::format("A step of the new version takes {:.0f} us, and the period is {:.0f} us.",
                               plan.report.step_time * 1e-3, static_cast<double>(program_->shape().period) * 1e-3));
  }
}

ChangeVerdict OnlineChange::propose(Plan& plan) {
  if (retainer_ != nullptr && plan.next.retained == nullptr) {
    StepProgram& next = plan.next.program();
    next.reset();
    plan.next.retained = std::make_unique<RetainImage>(next, state_of(next));
  }
  retained_before_ = retainer_ == nullptr ? 0 : plan.next.retained->written();
  if (trace_ != nullptr) {
    plan.next.traced = std::make_unique<TraceProgram>(plan.next.program());
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
    rehearse(made);
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
    as_given_[name] = parameter_named(program_->version().program(), name);
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
                   report.parameters_carried, report.parameters, report.states_carried, report.states));
}

ChangeReport OnlineChange::change_to(std::unique_ptr<StepProgram> program, const ChangeWish& wish) {
  try {
    const auto lock = one_at_a_time();
    require_same_interface(program_->shape(), program->shape());
    auto next = std::make_unique<ProgramVersion>(std::move(program), program_->shape());
    auto held = wish.only_check ? nullptr : held_commits(task_->door());
    ChangeReport report = carry_out({.next = *next, .given = parameters_of(next->program())}, wish);
    if (wish.only_check) {
      return report;
    }
    const auto gone = program_->keep(std::move(next));
    keep_as_given(wish.as_given);
    task_->door().version_changed(program_->version().program(), program_->version().parameters());
    held.reset();
    tell_changed(report, ChangeOutcome::changed);
    if (retainer_ != nullptr) {
      retainer_->let_go();  // of the version that is gone
    }
    return report;
  } catch (const InputError& refused) {
    if (!wish.only_check) {
      tell_refused(refused);
    }
    throw;
  }
}

ChangeReport OnlineChange::change_back(const ChangeWish& asked) {
  ChangeWish wish = asked;
  try {
    const auto lock = one_at_a_time();
    ProgramVersion* const former = program_->former();
    if (former == nullptr) {
      refuse_for_now("There is no version before this one: none was changed since the start.");
    }
    StepProgram& program = former->program();
    for (const auto& [name, value] : as_given_) {
      if (parameter_named(program_->version().program(), name) == value &&
          !std::isnan(parameter_named(program, name))) {
        wish.as_given.push_back(name);
      }
    }
    const Plan begin{.next = *former, .given = parameters_of(program), .own_state = state_of(program)};
    const auto as_it_was = [&] {
      set_parameters(program, begin.given);
      program.restore(*begin.own_state);
    };
    try {
      auto held = wish.only_check ? nullptr : held_commits(task_->door());
      ChangeReport report = carry_out(begin, wish);
      if (wish.only_check) {
        as_it_was();
        return report;
      }
      program_->keep_former();
      keep_as_given(wish.as_given);
      task_->door().version_changed(program, former->parameters());
      held.reset();
      tell_changed(report, ChangeOutcome::back);
      return report;
    } catch (const InputError&) {
      as_it_was();
      throw;
    }
  } catch (const InputError& refused) {
    if (!wish.only_check) {
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
             ? std::make_unique<OnlineChange>(*program, task, bump_limits(config, program->shape()))
             : nullptr;
}

}  // namespace hysteron::runtime
