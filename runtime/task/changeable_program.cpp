#include "runtime/task/changeable_program.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace hysteron::runtime {
namespace {

/// By known signal: the place of the same one, by name, type and unit.
std::vector<std::optional<std::size_t>> places_of(std::span<const ProgramSignal> known,
                                                  const std::vector<ProgramSignal>& own) {
  std::vector<std::optional<std::size_t>> places;
  for (const ProgramSignal& signal : known) {
    const auto found = std::ranges::find_if(own, [&](const ProgramSignal& one) {
      return one.name == signal.name && one.type == signal.type && one.unit == signal.unit;
    });
    places.push_back(found == own.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - own.begin())));
  }
  return places;
}

/// The same, and then those that are new, in their own order.
std::vector<std::optional<std::size_t>> all_places_of(std::span<const ProgramSignal> known,
                                                      const std::vector<ProgramSignal>& own) {
  auto places = places_of(known, own);
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (std::ranges::find(places, std::optional(i)) == places.end()) {
      places.emplace_back(i);
    }
  }
  return places;
}

}  // namespace

ProgramVersion::ProgramVersion(std::unique_ptr<StepProgram> program, const ProgramShape& first,
                               std::span<const ProgramSignal> parameters)
    : program_(std::move(program)),
      parameters_(all_places_of(parameters, program_->shape().parameters)),
      inner_(places_of(first.inner, program_->shape().inner)),
      inner_values_(program_->shape().inner.size()) {}

bool Bump::is_within(const BumpLimit& limit) const noexcept {
  return std::isfinite(after) && size <= limit.most;
}

Bump bump_of(double before, double after, const BumpLimit& limit) noexcept {
  const auto limited = [&](double value) { return std::clamp(value, limit.low, limit.high); };
  const bool are_numbers = std::isfinite(before) && std::isfinite(after);
  return {.before = before, .after = after, .size = are_numbers ? std::abs(limited(after) - limited(before)) : 0.0};
}

ChangeableProgram::ChangeableProgram(std::unique_ptr<StepProgram> first)
    : shape_(first->shape()), parameters_(shape_.parameters), values_(parameters_of(*first)) {
  owned_.push_back(std::make_unique<ProgramVersion>(std::move(first), shape_, parameters_));
  running_ = owned_.front().get();  // NOLINT(cppcoreguidelines-prefer-member-initializer): once it is owned
}

void ChangeableProgram::step(std::span<const double> inputs, std::span<double> outputs) noexcept {
  Ask asked = Ask::seen;
  if (change_.load(std::memory_order_relaxed) != Ask::none &&
      change_.compare_exchange_strong(asked, Ask::at_work, std::memory_order_acquire)) {
    if (try_change(inputs, outputs)) {
      number_.fetch_add(1, std::memory_order_relaxed);
      taken_ = proposed_;
    } else {
      conclude();
    }
    return;
  }
  if (asked == Ask::asked) {
    (void)change_.compare_exchange_strong(asked, Ask::seen, std::memory_order_acquire);
  }
  plain_step(inputs, outputs);
}

void ChangeableProgram::plain_step(std::span<const double> inputs, std::span<double> outputs) noexcept {
  StepProgram& program = running_->program();
  Ask asked = Ask::asked;
  if (image_.load(std::memory_order_relaxed) != Ask::asked ||
      !image_.compare_exchange_strong(asked, Ask::at_work, std::memory_order_acquire)) {
    program.step(inputs, outputs);
    return;
  }
  copy_parameters(program, wanted_->parameters);
  program.save(wanted_->state);
  std::ranges::copy(inputs, wanted_->inputs.begin());
  program.step(inputs, outputs);
  std::ranges::copy(outputs, wanted_->outputs.begin());
  image_.store(Ask::done, std::memory_order_release);
}

bool ChangeableProgram::try_change(std::span<const double> inputs, std::span<double> outputs) noexcept {
  ProposedChange& change = *proposed_;
  StepProgram& old = running_->program();
  StepProgram& next = change.to->program();
  for (std::size_t i = 0; i < change.parameters.size(); ++i) {
    // By their bits: a limit that is off is no number.
    if (std::bit_cast<std::uint64_t>(old.parameter(i)) != std::bit_cast<std::uint64_t>(change.parameters[i])) {
      change.verdict = ChangeVerdict::other_values;
      old.step(inputs, outputs);
      return false;
    }
  }
  old.save(change.from);
  std::ranges::copy(change.start, change.into.begin());
  for (const SharedNumber& one : change.shared) {
    (void)copy_shared(one, change.from, change.into);
  }
  next.restore(change.into);
  next.step(inputs, change.outputs);
  old.step(inputs, outputs);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    change.bumps[i] = bump_of(outputs[i], change.outputs[i], change.limits[i]);
    if (!change.bumps[i].is_within(change.limits[i])) {
      change.too_large = i;
      change.verdict = ChangeVerdict::bump;
      return false;
    }
  }
  std::ranges::copy(change.outputs, outputs.begin());
  copy_parameters(*this, values_);
  running_ = change.to;
  change.verdict = ChangeVerdict::taken;
  return true;
}

void ChangeableProgram::inner_values(std::span<double> into) const noexcept {
  const auto values = running_->inner_values();
  const auto places = running_->inner();
  for (std::size_t i = 0; i < into.size(); ++i) {
    into[i] = places[i] ? values[*places[i]] : std::numeric_limits<double>::quiet_NaN();
  }
}

void ChangeableProgram::set_parameter(std::size_t parameter, double value) noexcept {
  const auto places = running_->parameters();
  if (parameter < places.size() && places[parameter]) {
    running_->program().set_parameter(*places[parameter], value);
  }
}

double ChangeableProgram::parameter(std::size_t parameter) const noexcept {
  const auto place = running_->parameters()[parameter];
  return place ? running_->program().parameter(*place) : values_[parameter];
}

void ChangeableProgram::ask_for_image(StepImage& into) noexcept {
  wanted_ = &into;
  image_.store(Ask::asked, std::memory_order_release);
}

bool ChangeableProgram::withdraw_image() noexcept {
  Ask asked = Ask::asked;
  return image_.compare_exchange_strong(asked, Ask::none, std::memory_order_acq_rel);
}

void ChangeableProgram::propose(ProposedChange& change) noexcept {
  proposed_ = &change;
  change_.store(Ask::asked, std::memory_order_release);
}

bool ChangeableProgram::withdraw() noexcept {
  for (const Ask from : {Ask::asked, Ask::seen}) {
    Ask asked = from;
    if (change_.compare_exchange_strong(asked, Ask::none, std::memory_order_acq_rel)) {
      return true;
    }
  }
  return false;
}

std::unique_ptr<ProgramVersion> ChangeableProgram::keep(std::unique_ptr<ProgramVersion> taken) {
  std::unique_ptr<ProgramVersion> gone;
  const auto places = taken->parameters();
  for (std::size_t i = parameters_.size(); i < places.size(); ++i) {
    parameters_.push_back(taken->program().shape().parameters[places[i].value()]);
  }
  owned_.insert(owned_.begin(), std::move(taken));
  if (owned_.size() > 2) {
    gone = std::move(owned_.back());
    owned_.pop_back();
  }
  return gone;
}

}  // namespace hysteron::runtime
