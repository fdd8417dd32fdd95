// The operators that C and C++ spell alike.
#pragma once

#include "codegen/backends/shared/expression_printer.hpp"

namespace hysteron {

inline constexpr SpellingTable c_family_operators({
    {Op::Add, infix("+", Strength::Additive)},
    {Op::Subtract, infix("-", Strength::Additive)},
    {Op::Multiply, infix("*", Strength::Multiplicative)},
    {Op::Divide, infix("/", Strength::Multiplicative)},
    {Op::Negate, sign("-")},
    {Op::Less, infix("<", Strength::Relation)},
    {Op::LessEqual, infix("<=", Strength::Relation)},
    {Op::Equal, infix("==", Strength::Equality)},
    {Op::NotEqual, infix("!=", Strength::Equality)},
    {Op::IntLess, infix("<", Strength::Relation)},
    {Op::IntLessEqual, infix("<=", Strength::Relation)},
    {Op::IntEqual, infix("==", Strength::Equality)},
    {Op::IntNotEqual, infix("!=", Strength::Equality)},
    {Op::And, infix("&&", Strength::LogicalAnd)},
    {Op::Or, infix("||", Strength::LogicalOr)},
    {Op::Xor, infix("!=", Strength::Equality)},
    {Op::Not, negation("!")},
});

}  // namespace hysteron
