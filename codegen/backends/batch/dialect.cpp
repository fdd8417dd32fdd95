#include "codegen/backends/batch/dialect.hpp"

#include "codegen/backends/c_family/operators.hpp"

namespace hysteron {
namespace {

constexpr SpellingTable batch_operations = c_family_operators.with({
    {Op::Abs, call("lanes::abs")},
    {Op::Sqrt, call("lanes::sqrt")},
    {Op::Exp, call("lanes::exp")},
    {Op::Log, call("lanes::log")},
    {Op::Sin, call("lanes::sin")},
    {Op::Cos, call("lanes::cos")},
    {Op::Tan, call("lanes::tan")},
    {Op::Asin, call("lanes::asin")},
    {Op::Acos, call("lanes::acos")},
    {Op::Atan, call("lanes::atan")},
    {Op::Power, call("lanes::power")},
    {Op::Min, call("lanes::min")},
    {Op::Max, call("lanes::max")},
    {Op::IntAdd, call("lanes::add")},
    {Op::IntSubtract, call("lanes::subtract")},
    {Op::IntMultiply, call("lanes::multiply")},
    {Op::IntDivide, call("lanes::divide")},
    {Op::IntModulo, call("lanes::modulo")},
    {Op::IntNegate, call("lanes::negate")},
    {Op::IntMin, call("lanes::min")},
    {Op::IntMax, call("lanes::max")},
    {Op::IntAnd, call("lanes::both")},
    {Op::IntOr, call("lanes::either")},
    {Op::IntXor, call("lanes::one_of")},
    {Op::IntShiftLeft, call("lanes::shift_left")},
    {Op::IntShiftRight, call("lanes::shift_right")},
    {Op::And, call("lanes::both")},
    {Op::Or, call("lanes::either")},
    {Op::Xor, call("lanes::one_of")},
    {Op::Not, call("lanes::no")},
    {Op::Select, call("lanes::select")},
    {Op::SelectInt, call("lanes::select")},
    {Op::SelectBool, call("lanes::select")},
    {Op::SelectWord, call("lanes::select")},
    {Op::WordToInt, call("lanes::same")},
    {Op::IntToWord, call("lanes::word")},
    {Op::ToSingle, call("lanes::single")},
    {Op::ToInt, call("lanes::to_int")},
    {Op::ToReal, call("lanes::to_real")},
});

}  // namespace

const DialectOfC batch_dialect{.operations = batch_operations,
                               .real = "Real",
                               .truth = "Int",
                               .integer = "Int",
                               .word = "Int",
                               .parameters = "params.",
                               .state = "state.",
                               .input = "in.",
                               .output = "out.",
                               .infinity = "std::numeric_limits<double>::infinity()",
                               .not_a_number = "std::numeric_limits<double>::quiet_NaN()",
                               .literal_begin = "lanes::all(",
                               .literal_end = ")",
                               .read_begin = "lanes::at(",
                               .element_begin = "lanes::store(",
                               .passes_length = false};

}  // namespace hysteron
