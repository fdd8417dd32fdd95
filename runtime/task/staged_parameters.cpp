#include "runtime/task/staged_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/numbers.hpp"

namespace hysteron::runtime {

std::string refusal_by_type(const std::string& name, PointType type, double value) {
  if (!std::isfinite(value)) {
    return name + " is not a finite number.";
  }
  if (type == PointType::boolean && value != 0.0 && value != 1.0) {
    return name + " takes 0 or 1.";
  }
  if (!is_real(type) && value != std::trunc(value)) {
    return name + " takes a whole number.";
  }
  const auto [low, high] = type_limits(type);
  if (value < low || value > high) {
    return name + " takes " + (is_real(type) ? "numbers" : "whole numbers") + " from " + number_text(low) + " to " +
           number_text(high) + "; " + number_text(value) + " was given.";
  }
  return {};
}

std::string refusal_of(const ProgramSignal& signal, double value) {
  if (auto refusal = refusal_by_type(signal.name, signal.type, value); !refusal.empty()) {
    return refusal;
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

namespace {

class Relation {
 public:
  Relation(const ProgramShape& shape, const ProgramRelation& relation, std::span<const double> values)
      : shape_(&shape), relation_(&relation), values_(values) {}

  [[nodiscard]] bool changes(std::span<const double> has) const {
    const auto changed = [&](const RelatedNumber& one) {
      return one.parameter && values_[*one.parameter] != has[*one.parameter];
    };
    return std::ranges::any_of(relation_->numbers, changed) || (relation_->count && changed(*relation_->count));
  }
  [[nodiscard]] std::string refusal() const {
    const double count = relation_->count ? value(*relation_->count) : 0.0;
    const std::size_t all = relation_->numbers.size();
    const std::size_t used = count > 0.0 && count < static_cast<double>(all) ? static_cast<std::size_t>(count) : all;
    for (std::size_t i = 1; i < used; ++i) {
      const RelatedNumber& low = relation_->numbers[i - 1];
      const RelatedNumber& high = relation_->numbers[i];
      if (!(relation_->strictly ? value(low) < value(high) : value(low) <= value(high))) {
        return high.parameter
                   ? text(high) + (relation_->strictly ? " must be above " : " must be at least ") + text(low) + "."
                   : text(low) + (relation_->strictly ? " must be below " : " must be at most ") + text(high) + ".";
      }
    }
    return {};
  }

 private:
  [[nodiscard]] double value(const RelatedNumber& one) const {
    return one.parameter ? values_[*one.parameter] : one.constant;
  }
  [[nodiscard]] std::string text(const RelatedNumber& one) const {
    return (one.parameter ? shape_->parameters[*one.parameter].name + " = " : "") + number_text(value(one));
  }

  const ProgramShape* shape_;
  const ProgramRelation* relation_;
  std::span<const double> values_;
};

}  // namespace

std::string refusal_of(const ProgramShape& shape, std::span<const double> values, std::span<const double> has) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_same_value(values[i], has[i])) {
      if (auto refusal = refusal_of(shape.parameters[i], values[i]); !refusal.empty()) {
        return refusal;
      }
    }
  }
  for (const ProgramRelation& one : shape.relations) {
    const Relation relation(shape, one, values);
    if (auto refusal = relation.changes(has) ? relation.refusal() : ""; !refusal.empty()) {
      return refusal;
    }
  }
  return {};
}

StagedParameters::StagedParameters(const ProgramShape& shape, std::vector<double> values)
    : shape_(&shape), committed_(std::move(values)), staged_(committed_) {}

void StagedParameters::stage(std::size_t parameter, double value) {
  staged_[parameter] = value;
}

void StagedParameters::discard() {
  staged_ = committed_;
}

void StagedParameters::follow(const std::vector<double>& committed) {
  for (std::size_t i = 0; i < staged_.size(); ++i) {
    staged_[i] = is_staged(i) ? staged_[i] : committed[i];
  }
  committed_ = committed;
}

std::string StagedParameters::commit() {
  auto refusal = refusal_of(*shape_, staged_, committed_);
  if (refusal.empty()) {
    committed_ = staged_;
  }
  return refusal;
}

}  // namespace hysteron::runtime
