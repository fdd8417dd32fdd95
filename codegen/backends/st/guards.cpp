#include "codegen/backends/st/guards.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hysteron {
namespace {

/// No comparison with it holds.
constexpr double not_a_bound = std::numeric_limits<double>::quiet_NaN();

/// A literal below it may be 0 in the target: it is the smallest_literal normal REAL.
constexpr double smallest_literal = std::numeric_limits<float>::min();

}  // namespace

Guards::Guards(const Graph& graph, const Routine& routine)
    : graph_(graph), tape_(routine.tape), must_be_named_(routine.tape.size(), false) {
  for (ValueId id = 0; id < tape_.size(); ++id) {
    const Value& value = tape_[id];
    if (routine.uses[id] == 0) {
      continue;
    }
    if ((value.op == Op::Divide && !is_plain_divisor(value.args[1])) ||
        ((value.op == Op::IntDivide || value.op == Op::IntModulo) && !is_safe_divisor(value.args[1]))) {
      name_with_operands(id, 2);
    } else if (value.op == Op::Power) {
      const PowerForm form = power_form(value);
      if (form == PowerForm::Square) {
        must_be_named_[value.args[0]] = true;
      } else if (form >= PowerForm::NonZero) {
        name_with_operands(id, 2);
      }
    } else if (value.op == Op::ToInt) {
      name_with_operands(id, 1);
    } else if (value.op == Op::Log) {
      must_be_named_[value.args[0]] = true;
    }
  }
}

void Guards::name_with_operands(ValueId id, std::size_t operands) {
  must_be_named_[id] = true;
  for (std::size_t i = 0; i < operands; ++i) {
    must_be_named_[tape_[id].args[i]] = true;
  }
}

bool Guards::may_be_infinite(ValueId id) const {
  const Value& value = tape_[id];
  if (value.op != Op::Parameter) {
    return false;
  }
  const Parameter& parameter = graph_.parameters[value.index];
  return !std::isfinite(parameter.field.preset) ||
         std::ranges::any_of(parameter.value, [](double one) { return !std::isfinite(one); });
}

bool Guards::is_safe_divisor(ValueId id) const {
  const Value& value = tape_[id];
  return value.op == Op::IntLiteral && value.literal != 0.0 && value.literal != -1.0;
}

/// Above zero, or not a number, which is no zero either.
bool Guards::is_positive(ValueId id) const {
  const Value& value = tape_[id];
  switch (value.op) {
    case Op::RealLiteral:
      return value.literal >= smallest_literal;
    case Op::SampleTime:
      return true;
    case Op::Add:
      return (is_positive(value.args[0]) && never_negative(value.args[1])) ||
             (never_negative(value.args[0]) && is_positive(value.args[1]));
    case Op::Max:
      return is_positive(value.args[0]) || is_positive(value.args[1]);
    case Op::Min:
      return is_positive(value.args[0]) && is_positive(value.args[1]);
    case Op::Select:
      return is_positive(value.args[1]) && is_positive(value.args[2]);
    default:
      return false;
  }
}

bool Guards::never_negative(ValueId id) const {
  const Value& value = tape_[id];
  switch (value.op) {
    case Op::Abs:
    case Op::Exp:
    case Op::Sqrt:
      return true;
    case Op::Multiply:
      return value.args[0] == value.args[1];
    case Op::Add:
      return never_negative(value.args[0]) && never_negative(value.args[1]);
    case Op::Select:
      return never_negative(value.args[1]) && never_negative(value.args[2]);
    case Op::RealLiteral:
      return value.literal >= 0.0;
    default:
      return is_positive(id);
  }
}

/// An input or a parameter keeps its value through a step, wherever it is read; a state does not.
bool Guards::is_same(ValueId a, ValueId b) const {
  const Op op = tape_[a].op;
  return a == b || ((op == Op::Input || op == Op::Parameter) && tape_[a] == tape_[b]);
}

/// Whether a condition that holds, or does not, says that a value is not 0.
bool Guards::tells_nonzero(ValueId condition, bool holds, ValueId id) const {
  const Value& value = tape_[condition];
  const auto side = [&](std::size_t at) { return value.args[at]; };
  const auto literal = [&](std::size_t at) {
    return tape_[side(at)].op == Op::RealLiteral ? tape_[side(at)].literal : not_a_bound;
  };
  switch (value.op) {
    case Op::Not:
      return tells_nonzero(side(0), !holds, id);
    case Op::And:
      return holds && (tells_nonzero(side(0), true, id) || tells_nonzero(side(1), true, id));
    case Op::Or:
      return !holds && (tells_nonzero(side(0), false, id) || tells_nonzero(side(1), false, id));
    case Op::Less:
      return holds ? (is_same(side(1), id) && literal(0) >= 0.0) || (is_same(side(0), id) && literal(1) <= 0.0)
                   : (is_same(side(0), id) && literal(1) > 0.0) || (is_same(side(1), id) && literal(0) < 0.0);
    case Op::LessEqual:
      return holds ? (is_same(side(1), id) && literal(0) > 0.0) || (is_same(side(0), id) && literal(1) < 0.0)
                   : (is_same(side(0), id) && literal(1) >= 0.0) || (is_same(side(1), id) && literal(0) <= 0.0);
    case Op::Equal:
    case Op::NotEqual:
      return holds == (value.op == Op::NotEqual) &&
             ((is_same(side(0), id) && literal(1) == 0.0) || (is_same(side(1), id) && literal(0) == 0.0));
    default:
      return false;
  }
}

bool Guards::never_zero(ValueId id, const Known* known) const {
  for (const Known* one = known; one != nullptr; one = one->outer) {
    if (tells_nonzero(one->condition, one->holds, id)) {
      return true;
    }
  }
  const Value& value = tape_[id];
  switch (value.op) {
    case Op::RealLiteral:
      return std::fabs(value.literal) >= smallest_literal;
    case Op::Negate:
    case Op::Abs:
      return never_zero(value.args[0], known);
    case Op::Select: {
      const Known chosen{value.args[0], true, known};
      const Known left_out{value.args[0], false, known};
      return never_zero(value.args[1], &chosen) && never_zero(value.args[2], &left_out);
    }
    default:
      return is_positive(id);
  }
}

PowerForm Guards::power_form(const Value& power) const {
  const Value& exponent = tape_[power.args[1]];
  if (exponent.op != Op::RealLiteral) {
    return PowerForm::Any;
  }
  const double e = exponent.literal;
  if (e == 1.0) {
    return PowerForm::Base;
  }
  if (e == 2.0) {
    return PowerForm::Square;
  }
  if (e == 0.5) {
    return PowerForm::Root;
  }
  if (e == 0.0) {
    return PowerForm::One;
  }
  const bool any_sign = never_negative(power.args[0]) || e == std::floor(e);
  if (e > 0.0) {
    return any_sign ? PowerForm::Plain : PowerForm::PositivePart;
  }
  return any_sign ? PowerForm::NonZero : PowerForm::Positive;
}

}  // namespace hysteron
