#include "codegen/graph/unit_of_operation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hysteron::units {
namespace {

MaybeUnit radian() {
  std::string reason;
  return parse_unit("rad", reason);
}

}  // namespace

MaybeUnit unit_of_operation(Op op, std::span<const MaybeUnit> operands, std::optional<double> exponent,
                            const Agree& agree) {
  const auto same = [&](std::size_t a, std::size_t b) {
    agree(operands[b], operands[a]);
    return operands[a] ? operands[a] : operands[b];
  };
  switch (op) {
    case Op::Add:
    case Op::Subtract:
    case Op::Min:
    case Op::Max:
      return same(0, 1);
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
      same(0, 1);
      return std::nullopt;
    case Op::Select:
      return same(1, 2);
    case Op::Negate:
    case Op::Abs:
    case Op::ToSingle:
      return operands[0];
    case Op::Multiply:
    case Op::Divide: {
      if (!operands[0] || !operands[1]) {
        return std::nullopt;
      }
      Unit product = *operands[0];
      product.multiply(*operands[1], {op == Op::Multiply ? 1 : -1, 1});
      return product;
    }
    case Op::Sqrt:
    case Op::Power: {
      const double twice = op == Op::Sqrt ? 1.0 : exponent.value_or(0.0) * 2.0;
      if (!operands[0] || (op == Op::Power && !exponent) || twice != std::floor(twice) || std::abs(twice) > 48.0) {
        return std::nullopt;
      }
      Unit result;
      result.multiply(*operands[0], Fraction::of(static_cast<std::int64_t>(twice), 2));
      return result;
    }
    case Op::Exp:
    case Op::Log:
      agree(operands[0], Unit{});
      return Unit{};
    case Op::Sin:
    case Op::Cos:
    case Op::Tan:
      agree(operands[0], radian());
      return Unit{};
    case Op::Asin:
    case Op::Acos:
    case Op::Atan:
      agree(operands[0], Unit{});
      return radian();
    default:
      return std::nullopt;
  }
}

std::optional<std::string> unit_of_constants(Op op, std::span<const std::string_view> operands, double exponent) {
  if (std::ranges::all_of(operands, &std::string_view::empty)) {
    return std::string();
  }
  std::vector<MaybeUnit> units;
  std::string reason;
  for (const std::string_view text : operands) {
    const bool factor = op == Op::Multiply || op == Op::Divide;
    units.push_back(text.empty() ? (factor ? MaybeUnit(Unit{}) : std::nullopt) : parse_unit(text, reason));
  }
  bool agreed = true;
  const MaybeUnit result =
      unit_of_operation(op, units, exponent, [&](const MaybeUnit& given, const MaybeUnit& expected) {
        agreed = agreed && (!given || !expected || same_size(conversion(*given, *expected).value_or(0.0), 1.0));
      });
  if (!agreed) {
    return std::nullopt;
  }
  return result ? unit_text(*result) : std::string();
}

}  // namespace hysteron::units
