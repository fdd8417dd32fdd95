#include "codegen/backends/cpp/dialect.hpp"

#include "codegen/backends/c_family/operators.hpp"

namespace hysteron {
namespace {

constexpr SpellingTable cpp_operations = c_family_operators.with({
    {Op::Abs, call("std::fabs")},
    {Op::Sqrt, call("std::sqrt")},
    {Op::Exp, call("std::exp")},
    {Op::Log, call("std::log")},
    {Op::Sin, call("std::sin")},
    {Op::Cos, call("std::cos")},
    {Op::Tan, call("std::tan")},
    {Op::Asin, call("std::asin")},
    {Op::Acos, call("std::acos")},
    {Op::Atan, call("std::atan")},
    {Op::Power, call("detail::power")},
    {Op::Min, call("detail::min")},
    {Op::Max, call("detail::max")},
    {Op::IntAdd, call("detail::add")},
    {Op::IntSubtract, call("detail::subtract")},
    {Op::IntMultiply, call("detail::multiply")},
    {Op::IntDivide, call("detail::divide")},
    {Op::IntModulo, call("detail::modulo")},
    {Op::IntNegate, call("detail::negate")},
    {Op::IntMin, call("detail::min")},
    {Op::IntMax, call("detail::max")},
    {Op::IntAnd, call("detail::bits_and")},
    {Op::IntOr, call("detail::bits_or")},
    {Op::IntXor, call("detail::bits_xor")},
    {Op::IntShiftLeft, call("detail::shift_left")},
    {Op::IntShiftRight, call("detail::shift_right")},
    {Op::WordToInt, call("std::int32_t")},
    {Op::IntToWord, call("static_cast<std::uint16_t>")},
    {Op::ToSingle, call("detail::single")},
    {Op::ToInt, call("detail::to_int")},
    {Op::ToReal, call("static_cast<Real>")},
});

}  // namespace

const DialectOfC cpp_dialect{.operations = cpp_operations,
                             .real = "Real",
                             .truth = "bool",
                             .integer = "std::int32_t",
                             .word = "std::uint16_t",
                             .parameters = "params.",
                             .state = "state.",
                             .input = "in.",
                             .output = "out.",
                             .infinity = "std::numeric_limits<Real>::infinity()",
                             .not_a_number = "std::numeric_limits<Real>::quiet_NaN()",
                             .word_begin = "std::uint16_t{",
                             .word_end = "}",
                             .read_begin = "detail::at(",
                             .element_begin = "detail::store(",
                             .passes_length = false,
                             .place = "std::size_t"};

}  // namespace hysteron
