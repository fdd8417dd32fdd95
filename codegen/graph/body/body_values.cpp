#include <fmt/format.h>

#include "codegen/graph/body/body.hpp"
#include "codegen/language/refused_types.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::bodies {

namespace syntax = language::body;
using language::Operator;

Value Body::literal(const syntax::Literal& written) {
  Plain type = Plain::Bool;
  switch (written.kind) {
    case syntax::Literal::Kind::Truth:
      return computer_.literal(Plain::Bool, written.value);
    case syntax::Literal::Kind::Time:
      return computer_.literal(Plain::Time, written.value);
    default:
      break;
  }
  const bool real = written.kind == syntax::Literal::Kind::Real;
  if (written.type.empty()) {
    if (!real && written.value > static_cast<double>(highest(Plain::Udint))) {
      return computer_.refused(
          error::number_out_of_range, fmt::format("no whole number of a body holds {:.0f}", written.value),
          fmt::format("They reach from {} to {}, the highest UDINT; as a real number it is {:.1f}.",
                      lowest(Plain::Dint), highest(Plain::Udint), written.value));
    }
    const bool dint = written.value <= static_cast<double>(highest(Plain::Dint));
    return computer_.literal(real ? Plain::Lreal : dint ? Plain::Dint : Plain::Udint, written.value, true);
  }
  if (!plain_of(written.type, type)) {
    const std::string_view mend = language::in_place_of_type(written.type);
    return computer_.refused(error::refused_type, fmt::format("{}# is no type of a body", written.type),
                             std::string(mend.empty() ? "Write INT#, DINT#, UINT#, WORD#, REAL# or the like." : mend));
  }
  const bool fits = real ? is_number(type)
                         : !is_integer(type) || (written.value >= static_cast<double>(lowest(type)) &&
                                                 written.value <= static_cast<double>(highest(type)));
  if (!fits) {
    return computer_.refused(
        error::number_out_of_range, fmt::format("{}# does not hold {}", written.type, number_text(written.value)),
        is_integer(type) ? fmt::format("It holds whole numbers from {} to {}.", lowest(type), highest(type))
                         : fmt::format("Write LREAL#{}, or the number alone.", number_text(written.value)));
  }
  if (type == Plain::Real) {
    return computer_.fit(computer_.literal(Plain::Lreal, written.value, true), Plain::Real);
  }
  return computer_.literal(type, written.value);
}

Value Body::value(language::ExpressionId id) {
  const syntax::Expression& written = expression(id);
  const auto outer = computer_.span();
  computer_.at(place_of(written.span));
  Value result;
  if (const auto* one = std::get_if<syntax::Literal>(&written.node)) {
    result = literal(*one);
  } else if (const auto* access = std::get_if<syntax::Access>(&written.node)) {
    result = read(*access);
  } else if (const auto* unary = std::get_if<syntax::Unary>(&written.node)) {
    const Value operand = value(unary->operand);
    result = unary->op == Operator::Not ? computer_.inverse(operand) : computer_.negative(operand);
  } else if (const auto* binary = std::get_if<syntax::Binary>(&written.node)) {
    const Value left = value(binary->left);
    const Value right = value(binary->right);
    computer_.at(place_of(written.span));
    result = left.valid() && right.valid() ? computer_.binary(binary->op, left, right) : Value{};
  } else {
    result = call(std::get<syntax::Call>(written.node), written.span);
  }
  computer_.at(outer);
  return result;
}

Value Body::condition(language::ExpressionId id) {
  const Value result = value(id);
  if (result.valid() && result.type != Plain::Bool) {
    const auto outer = computer_.span();
    computer_.at(place_of(expression(id).span));
    const Value refused = computer_.assignable(result, Plain::Bool, "a condition");
    computer_.at(outer);
    return refused;
  }
  return result;
}

}  // namespace hysteron::bodies
