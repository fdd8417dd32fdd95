#include "runtime/task/staged_parameters.hpp"

#include <cmath>
#include <utility>

#include "support/numbers.hpp"

namespace hysteron::runtime {

std::string refusal_of(const ProgramSignal& signal, double value) {
  if (!std::isfinite(value)) {
    return signal.name + " is not a finite number.";
  }
  if (signal.type == PointType::boolean && value != 0.0 && value != 1.0) {
    return signal.name + " takes 0 or 1.";
  }
  if (signal.type != PointType::real32 && signal.type != PointType::real64 && value != std::trunc(value)) {
    return signal.name + " takes a whole number.";
  }
  const bool too_low = signal.low_excluded ? !(value > signal.low) : !(value >= signal.low);
  if (too_low) {
    return signal.name + (signal.low_excluded ? " must be above " : " must be at least ") + number_text(signal.low) +
           ".";
  }
  if (!(value <= signal.high)) {
    return signal.name + " must be at most " + number_text(signal.high) + ".";
  }
  return {};
}

StagedParameters::StagedParameters(std::vector<ProgramSignal> parameters, std::vector<double> values, SetCheck check)
    : parameters_(std::move(parameters)),
      committed_(std::move(values)),
      staged_(committed_),
      check_(std::move(check)) {}

void StagedParameters::stage(std::size_t parameter, double value) {
  staged_[parameter] = value;
}

void StagedParameters::discard() {
  staged_ = committed_;
}

std::string StagedParameters::commit() {
  for (std::size_t i = 0; i < staged_.size(); ++i) {
    if (auto refusal = refusal_of(parameters_[i], staged_[i]); !refusal.empty()) {
      return refusal;
    }
  }
  if (check_) {
    if (auto refusal = check_(staged_); !refusal.empty()) {
      return refusal;
    }
  }
  committed_ = staged_;
  return {};
}

}  // namespace hysteron::runtime
