#include "codegen/backends/shared/value_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "codegen/backends/shared/interval.hpp"
#include "support/single.hpp"

namespace hysteron {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

class BoundsOfRoutine {
 public:
  BoundsOfRoutine(const Graph& graph, const Routine& routine, bool float32)
      : graph_(graph),
        routine_(routine),
        float32_(float32),
        cells_(routine.cells.size()),
        values_(routine.tape.size()) {}

  std::vector<ValueBounds> run() {
    find_landmarks();
    begin();
    const std::vector<ValueBounds> first = cells_;
    widen();
    sharpen(first);
    evaluate();
    std::vector<ValueBounds> outputs(graph_.outputs.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      outputs[i] = interval::any_of_type(graph_.outputs[i].type);
    }
    for (const Statement& one : routine_.step) {
      if (one.kind == Statement::Kind::SetOutput) {
        outputs[one.target] = values_[one.value];
      }
    }
    return outputs;
  }

 private:
  [[nodiscard]] ValueBounds of_input(const Port& port) const {
    ValueBounds bounds = interval::any_of_type(port.type);
    if (port.type == Type::Real || port.type == Type::Int) {
      const bool has_range = std::isfinite(port.minimum) || std::isfinite(port.maximum);
      bounds.low = std::max(bounds.low, rounded(port.minimum));
      bounds.high = std::min(bounds.high, rounded(port.maximum));
      bounds.may_be_nan = bounds.may_be_nan && !has_range;
    }
    return bounds;
  }

  [[nodiscard]] ValueBounds of_parameter(const Parameter& parameter) const {
    const auto of = [&](double value) {
      return interval::exactly(parameter.field.type == Type::Real ? rounded(value) : value);
    };
    ValueBounds bounds = of(parameter.value.front());
    for (const double value : parameter.value) {
      bounds = interval::hull(bounds, of(value));
    }
    return bounds;
  }

  [[nodiscard]] double rounded(double value) const { return float32_ ? nearest_single(value) : value; }

  /// Where an end may rest: what the text names, and powers of 16, so that a decay finds an end that it does not leave.
  void find_landmarks() {
    constexpr int least_power = -10;
    constexpr int most_power = 255;
    for (int k = least_power; k <= most_power; ++k) {
      landmarks_.push_back(std::ldexp(1.0, 4 * k));
    }
    const auto add = [this](double value) {
      if (std::isfinite(value) && value != 0.0) {
        landmarks_.push_back(std::abs(rounded(value)));
      }
    };
    for (const Port& port : graph_.inputs) {
      add(port.minimum);
      add(port.maximum);
    }
    for (const Parameter& parameter : graph_.parameters) {
      std::ranges::for_each(parameter.value, add);
    }
    for (ValueId id = 0; id < routine_.tape.size(); ++id) {
      if (is_literal(routine_.tape[id].op)) {
        add(routine_.tape[id].literal);
      }
    }
    std::ranges::sort(landmarks_);
  }

  /// The nearest landmark at or above a number.
  [[nodiscard]] double above(double value) const {
    if (value <= 0.0) {  // the negative landmark of the smallest size that is not below, or 0
      const auto next = std::ranges::upper_bound(landmarks_, -value);
      return next == landmarks_.begin() ? 0.0 : -*std::prev(next);
    }
    const auto next = std::ranges::lower_bound(landmarks_, value);
    return next == landmarks_.end() ? unlimited : *next;
  }

  void evaluate() {
    for (ValueId id = 0; id < routine_.tape.size(); ++id) {
      if (routine_.uses[id] > 0) {
        values_[id] = value_of(routine_.tape[id]);
      }
    }
  }

  [[nodiscard]] ValueBounds value_of(const Value& value) const {
    switch (value.op) {
      case Op::RealLiteral:
        return interval::exactly(rounded(value.literal));
      case Op::IntLiteral:
      case Op::BoolLiteral:
      case Op::WordLiteral:
        return interval::exactly(value.literal);
      case Op::SampleTime:
        return interval::exactly(rounded(static_cast<double>(graph_.sample_time_ns * value.index) * 1e-9));
      case Op::Input:
        return of_input(graph_.inputs[value.index]);
      case Op::Parameter:
        return of_parameter(graph_.parameters[value.index]);
      case Op::Cell:
        return cells_[value.index];
      default: {
        const auto operand = [&](std::size_t k) {
          return value.args[k] == no_value ? ValueBounds{} : values_[value.args[k]];
        };
        return interval::apply(value.op, {operand(0), operand(1), operand(2)}, float32_);
      }
    }
  }

  /// What a list of statements makes of the cells that it sets, joined with what they are.
  [[nodiscard]] std::vector<ValueBounds> after(const std::vector<Statement>& list,
                                               std::vector<ValueBounds> cells) const {
    for (const Statement& one : list) {
      if (one.kind == Statement::Kind::SetCell || one.kind == Statement::Kind::StoreCell) {
        cells[one.target] = interval::hull(cells[one.target], values_[one.value]);
      }
    }
    return cells;
  }

  /// Each cell as the reset leaves it. No reset reads a cell.
  void begin() {
    evaluate();
    std::vector<bool> is_set(cells_.size(), false);
    for (const Statement& one : routine_.reset) {
      if (one.kind == Statement::Kind::SetCell || one.kind == Statement::Kind::StoreCell) {
        cells_[one.target] =
            is_set[one.target] ? interval::hull(cells_[one.target], values_[one.value]) : values_[one.value];
        is_set[one.target] = true;
      }
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (!is_set[i]) {
        cells_[i] = interval::any_of_type(routine_.cells[i].field.type);
      } else if (routine_.cells[i].field.length > 1) {  // elements that no reset sets
        cells_[i] = interval::hull(cells_[i], interval::exactly(0.0));
      }
    }
    if (routine_.longest_period > 1) {  // it is moved on by the target's own line
      cells_[routine_.counter] = {.low = 0.0, .high = routine_.longest_period - 1.0, .may_be_nan = false};
    }
  }

  /// Outwards until no step leaves the bounds.
  void widen() {
    constexpr std::size_t plain_steps = 40;
    constexpr std::size_t patient_steps = 1000;  // then ends that still move are given up
    for (std::size_t step = 0;; ++step) {
      evaluate();
      std::vector<ValueBounds> next = after(routine_.step, cells_);
      if (next == cells_) {
        return;
      }
      for (std::size_t i = 0; step >= plain_steps && i < next.size(); ++i) {
        const auto outwards = [&](double end) { return step < patient_steps ? above(end) : unlimited; };
        next[i].low = next[i].low < cells_[i].low ? -outwards(-next[i].low) : next[i].low;
        next[i].high = next[i].high > cells_[i].high ? outwards(next[i].high) : next[i].high;
      }
      cells_ = std::move(next);
    }
  }

  /// Inwards: what a step makes of bounds that it does not leave are such bounds, too.
  void sharpen(const std::vector<ValueBounds>& first) {
    constexpr std::size_t most_steps = 200;
    for (std::size_t step = 0; step < most_steps; ++step) {
      evaluate();
      std::vector<ValueBounds> next = after(routine_.step, first);
      if (next == cells_) {
        return;
      }
      cells_ = std::move(next);
    }
  }

  const Graph& graph_;
  const Routine& routine_;
  bool float32_;
  std::vector<double> landmarks_;    ///< above 0, rising
  std::vector<ValueBounds> cells_;   ///< before and behind every step
  std::vector<ValueBounds> values_;  ///< by value of the tape
};

}  // namespace

bool ValueBounds::is_finite() const {
  return std::isfinite(low) && std::isfinite(high) && !may_be_nan;
}

bool ValueBounds::contains(double value) const {
  return std::isnan(value) ? may_be_nan : low <= value && value <= high;
}

std::vector<ValueBounds> output_bounds(const Graph& graph, const Routine& routine, bool float32) {
  return BoundsOfRoutine(graph, routine, float32).run();
}

}  // namespace hysteron
