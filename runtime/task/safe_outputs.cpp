#include "runtime/task/safe_outputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hysteron::runtime {
namespace {

/// As std::clamp, with limits that may be infinite.
double limited(const OutputSafety& output, double value) noexcept {
  return std::min(std::max(value, output.low), output.high);
}

/// From a value towards a target, by no more than a step.
double towards(double from, double target, double step) noexcept {
  return target > from ? std::min(target, from + step) : std::max(target, from - step);
}

/// On the way to the safe value, a second.
double rate_of(const OutputSafety& output) noexcept {
  return output.action == SafeAction::ramp ? std::min(output.slew, output.ramp) : output.slew;
}

}  // namespace

double safe_value(const OutputSafety& output) noexcept {
  return limited(output, output.value);
}

double longest_way(const OutputSafety& output, double sample_time) noexcept {
  if (output.action == SafeAction::hold) {
    return 0.0;
  }
  const double safe = safe_value(output);
  const double distance = std::max(output.high - safe, safe - output.low);
  const double way = std::isinf(rate_of(output)) ? 0.0 : distance / rate_of(output);
  return static_cast<double>(output.hold_cycles) * sample_time + way;
}

std::string_view name_of(Fault fault) {
  constexpr std::array<std::string_view, 12> names{"none",        "hang",      "crash",        "not finite",
                                                   "stale input", "lost link", "missed cycle", "stop",
                                                   "lost client", "not safe",  "lost guard",   "overload"};
  return names[static_cast<std::size_t>(fault)];
}

SafeOutputs::SafeOutputs(std::vector<OutputSafety> outputs, double sample_time)
    : outputs_(std::move(outputs)),
      sample_time_(sample_time),
      values_(outputs_.size()),
      faults_(outputs_.size(), Fault::none),
      since_(outputs_.size(), 0) {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    values_[i] = safe_value(outputs_[i]);
  }
}

void SafeOutputs::start_from(std::span<const double> values) noexcept {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if (std::isfinite(values[i])) {
      values_[i] = limited(outputs_[i], values[i]);
    }
  }
}

void SafeOutputs::step(std::span<const double> wanted, Fault fault) noexcept {
  held_back_ = 0;
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const OutputSafety& output = outputs_[i];
    const Fault now = fault != Fault::none ? fault : std::isfinite(wanted[i]) ? Fault::none : Fault::not_finite;
    since_[i] = now == Fault::none ? 0 : since_[i] + 1;
    faults_[i] = now;
    if (now == Fault::none) {
      values_[i] = towards(values_[i], limited(output, wanted[i]), output.slew * sample_time_);
      held_back_ += values_[i] == wanted[i] ? 0 : 1;
    } else if (since_[i] > output.hold_cycles && output.action != SafeAction::hold) {
      values_[i] = next(i);
    }
  }
}

double SafeOutputs::next(std::size_t output) const noexcept {
  return towards(values_[output], target(output), rate_of(outputs_[output]) * sample_time_);
}

double SafeOutputs::target(std::size_t output) const noexcept {
  return safe_value(outputs_[output]);
}

std::size_t SafeOutputs::worst_output() const noexcept {
  const auto found = std::ranges::find_if(faults_, [](Fault one) { return one != Fault::none; });
  return static_cast<std::size_t>(found - faults_.begin());
}

Fault SafeOutputs::worst() const noexcept {
  const std::size_t output = worst_output();
  return output == faults_.size() ? Fault::none : faults_[output];
}

bool SafeOutputs::stuck() const noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const bool moves = outputs_[i].action != SafeAction::hold && since_[i] > outputs_[i].hold_cycles;
    if (moves && values_[i] != target(i) && next(i) == values_[i]) {
      return true;
    }
  }
  return false;
}

bool SafeOutputs::settled() const noexcept {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const bool there = outputs_[i].action == SafeAction::hold || values_[i] == target(i);
    if (faults_[i] == Fault::none || !there) {
      return false;
    }
  }
  return true;
}

}  // namespace hysteron::runtime
