#include "codegen/backends/c/dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "codegen/backends/c_family/operators.hpp"
#include "codegen/backends/c_family/words.hpp"

namespace hysteron {
namespace {

/// The functions of <math.h> by operation, for double and for float.
struct LibraryFunction {
  Op op;
  std::string_view of_double;
  std::string_view of_float;
};
constexpr std::array library_functions{
    LibraryFunction{Op::Abs, "fabs", "fabsf"},  LibraryFunction{Op::Sqrt, "sqrt", "sqrtf"},
    LibraryFunction{Op::Exp, "exp", "expf"},    LibraryFunction{Op::Log, "log", "logf"},
    LibraryFunction{Op::Sin, "sin", "sinf"},    LibraryFunction{Op::Cos, "cos", "cosf"},
    LibraryFunction{Op::Tan, "tan", "tanf"},    LibraryFunction{Op::Asin, "asin", "asinf"},
    LibraryFunction{Op::Acos, "acos", "acosf"}, LibraryFunction{Op::Atan, "atan", "atanf"},
};

constexpr SpellingTable c_operations(bool float32) {
  SpellingTable result = c_family_operators.with({
      {Op::Power, call("real_power")},
      {Op::Min, call("real_min")},
      {Op::Max, call("real_max")},
      {Op::IntAdd, call("int_add")},
      {Op::IntSubtract, call("int_subtract")},
      {Op::IntMultiply, call("int_multiply")},
      {Op::IntDivide, call("int_divide")},
      {Op::IntModulo, call("int_modulo")},
      {Op::IntNegate, call("int_negate")},
      {Op::IntMin, call("int_min")},
      {Op::IntMax, call("int_max")},
      {Op::IntAnd, call("int_and")},
      {Op::IntOr, call("int_or")},
      {Op::IntXor, call("int_xor")},
      {Op::IntShiftLeft, call("int_shift_left")},
      {Op::IntShiftRight, call("int_shift_right")},
      {Op::WordToInt, call("(int32_t)")},
      {Op::IntToWord, call("int_to_word")},
      {Op::ToSingle, call("to_single")},
      {Op::ToInt, call("to_int")},
      {Op::ToReal, call(float32 ? "(float)" : "(double)")},
  });
  for (const LibraryFunction& one : library_functions) {
    result.set(one.op, call(float32 ? one.of_float : one.of_double));
  }
  return result;
}

constexpr SpellingTable operations_of_double = c_operations(false);
constexpr SpellingTable operations_of_float = c_operations(true);

constexpr DialectOfC dialect_with(const SpellingTable& operations, std::string_view real) {
  return {.operations = operations,
          .real = real,
          .truth = "bool",
          .integer = "int32_t",
          .word = "uint16_t",
          .parameters = "params->",
          .state = "state->",
          .input = "in->",
          .output = "out->",
          .infinity = real == "float" ? "INFINITY" : "(double)INFINITY",
          .not_a_number = real == "float" ? "NAN" : "(double)NAN",
          .word_begin = "(uint16_t)",
          .word_end = "U",
          .read_begin = "element(",
          .element_begin = "set_element(",
          .passes_length = true,
          .place = "size_t",
          .careful = true};
}

/// Code with {real}, {zero} and the like filled in.
struct CHelper {
  std::string_view name;
  std::string_view text;
};

constexpr std::array c_helpers{
    CHelper{"real_power", R"(// base^exponent; the common exponents have a path of their own.
static {real} real_power({real} base, {real} exponent) {{
  {real} result;
  if (exponent == 1.0{f}) {{
    result = base;
  }} else if (exponent == 0.5{f}) {{
    result = sqrt{m}(base);
  }} else if (exponent == 2.0{f}) {{
    result = base * base;
  }} else if (exponent == 0.0{f}) {{
    result = 1.0{f};
  }} else {{
    result = pow{m}(base, exponent);
  }}
  return result;
}}
)"},
    CHelper{"real_min", R"(static {real} real_min({real} a, {real} b) {{
  return (b < a) ? b : a;
}}
)"},
    CHelper{"real_max", R"(static {real} real_max({real} a, {real} b) {{
  return (b > a) ? b : a;
}}
)"},
    CHelper{"int_min", R"(static int32_t int_min(int32_t a, int32_t b) {{
  return (b < a) ? b : a;
}}
)"},
    CHelper{"int_max", R"(static int32_t int_max(int32_t a, int32_t b) {{
  return (b > a) ? b : a;
}}
)"},
    CHelper{"to_int", R"(// Towards zero; saturates at the ends, 0 for not-a-number.
static int32_t to_int({real} x) {{
  int32_t result;
  if (x >= 2147483648.0{f}) {{
    result = INT32_MAX;
  }} else if (x > -2147483648.0{f}) {{
    result = (int32_t)x;
  }} else if (x <= -2147483648.0{f}) {{
    result = -2147483647 - 1;
  }} else {{
    result = 0;
  }}
  return result;
}}
)"},
    CHelper{"place", R"(// An index outside of an array is taken to its nearest end.
static int32_t place(int32_t length, int32_t index) {{
  const int32_t last = length - 1;
  return (index < 0) ? 0 : ((index > last) ? last : index);
}}
)"},
    CHelper{"element", R"(static {real} element(const {real} *array, int32_t length, int32_t index) {{
  return array[place(length, index)];
}}
)"},
    CHelper{"set_element", R"(static void set_element({real} *array, int32_t length, int32_t index, {real} value) {{
  array[place(length, index)] = value;
}}
)"},
    CHelper{"fill", R"(static void fill({real} *array, int32_t length, {real} value) {{
  for (int32_t i = 0; i < length; ++i) {{
    array[i] = value;
  }}
}}
)"},
    CHelper{"wrap", R"(// An int32_t wraps at its ends; a division by zero gives 0.
static int32_t wrap(int64_t x) {{
  const uint32_t bits = (uint32_t)((uint64_t)x & 0xFFFFFFFFU);
  int32_t result = -2147483647 - 1;
  if (bits <= 0x7FFFFFFFU) {{
    result = (int32_t)bits;
  }} else {{
    const uint32_t above = bits - 0x80000000U;
    result += (int32_t)above;
  }}
  return result;
}}
)"},
    CHelper{"int_add", R"(static int32_t int_add(int32_t a, int32_t b) {{
  return wrap((int64_t)a + (int64_t)b);
}}
)"},
    CHelper{"int_subtract", R"(static int32_t int_subtract(int32_t a, int32_t b) {{
  return wrap((int64_t)a - (int64_t)b);
}}
)"},
    CHelper{"int_multiply", R"(static int32_t int_multiply(int32_t a, int32_t b) {{
  return wrap((int64_t)a * (int64_t)b);
}}
)"},
    CHelper{"int_divide", R"(static int32_t int_divide(int32_t a, int32_t b) {{
  return (b == 0) ? 0 : wrap((int64_t)a / (int64_t)b);
}}
)"},
    CHelper{"int_modulo", R"(static int32_t int_modulo(int32_t a, int32_t b) {{
  return (b == 0) ? 0 : wrap((int64_t)a % (int64_t)b);
}}
)"},
    CHelper{"int_and", R"(static int32_t int_and(int32_t a, int32_t b) {{
  const uint32_t bits = (uint32_t)a & (uint32_t)b;
  return wrap((int64_t)bits);
}}
)"},
    CHelper{"int_or", R"(static int32_t int_or(int32_t a, int32_t b) {{
  const uint32_t bits = (uint32_t)a | (uint32_t)b;
  return wrap((int64_t)bits);
}}
)"},
    CHelper{"int_xor", R"(static int32_t int_xor(int32_t a, int32_t b) {{
  const uint32_t bits = (uint32_t)a ^ (uint32_t)b;
  return wrap((int64_t)bits);
}}
)"},
    CHelper{"int_shift_left", R"(static int32_t int_shift_left(int32_t a, int32_t places) {{
  const uint32_t bits = (uint32_t)a << (uint32_t)places;
  return wrap((int64_t)bits);
}}
)"},
    CHelper{"int_shift_right", R"(static int32_t int_shift_right(int32_t a, int32_t places) {{
  const uint32_t bits = (uint32_t)a >> (uint32_t)places;
  return wrap((int64_t)bits);
}}
)"},
    CHelper{"int_to_word", R"(// The lower 16 bits.
static uint16_t int_to_word(int32_t x) {{
  return (uint16_t)((uint32_t)x & 0xFFFFU);
}}
)"},
    CHelper{"to_single",
            R"(// The nearest number of 32 bits. Through memory, since GCC 12 leaves two of them side by side unrounded.
static {real} to_single({real} x) {{
  volatile float nearest = (float)x;
  return ({real})nearest;
}}
)"},
    CHelper{"int_negate", R"(static int32_t int_negate(int32_t a) {{
  return wrap(-(int64_t)a);
}}
)"},
};

/// Which of them a step calls, by name.
std::set<std::string_view> c_helpers_of(const Routine& routine) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < operation_count; ++i) {
    const auto op = static_cast<Op>(i);
    if (routine.uses_operation(op) && !is_leaf(op)) {
      names.insert(operations_of_double[op].text);
    }
  }
  if (routine.reads_by_index) {
    names.insert("element");
  }
  for (const auto* list : {&routine.reset, &routine.step}) {
    for (const Statement& one : *list) {
      if (one.kind == Statement::Kind::StoreCell) {
        names.insert(one.index == no_value ? "fill" : "set_element");
      }
    }
  }
  if (names.contains("element") || names.contains("set_element")) {
    names.insert("place");
  }
  if (std::ranges::any_of(names, [](std::string_view name) {
        return name.starts_with("int_") && name != "int_min" && name != "int_max" && name != "int_to_word";
      })) {
    names.insert("wrap");
  }
  return names;
}

}  // namespace

const DialectOfC& c_dialect(bool float32) {
  static constexpr DialectOfC of_double = dialect_with(operations_of_double, "double");
  static constexpr DialectOfC of_float = dialect_with(operations_of_float, "float");
  return float32 ? of_float : of_double;
}

std::span<const std::string_view> c_words() {
  static const std::vector<std::string_view> words = [] {
    std::vector<std::string_view> list(cpp_words.begin(), cpp_words.end());
    for (const LibraryFunction& one : library_functions) {
      list.insert(list.end(), {one.of_double, one.of_float});
    }
    for (const CHelper& helper : c_helpers) {
      list.push_back(helper.name);
    }
    list.insert(list.end(), {"restrict", "pow", "powf", "isnan", "sample_time"});
    list.insert(list.end(),
                {"size_t", "int32_t", "uint32_t", "uint16_t", "int64_t", "uint64_t"});  // a local would hide its type
    return list;
  }();
  return words;
}

std::vector<std::string> c_library_functions(const Routine& routine, bool float32) {
  std::set<std::string> names;
  for (const LibraryFunction& one : library_functions) {
    if (routine.uses_operation(one.op)) {
      names.emplace(float32 ? one.of_float : one.of_double);
    }
  }
  if (routine.uses_operation(Op::Power)) {
    names.insert({float32 ? "powf" : "pow", float32 ? "sqrtf" : "sqrt"});
  }
  return {names.begin(), names.end()};
}

std::string c_helper_functions(const Routine& routine, bool float32) {
  const auto names = c_helpers_of(routine);
  std::string text;
  for (const CHelper& helper : c_helpers) {
    if (names.contains(helper.name)) {
      text += fmt::format(fmt::runtime(helper.text), fmt::arg("real", float32 ? "float" : "double"),
                          fmt::arg("f", float32 ? "F" : ""), fmt::arg("m", float32 ? "f" : "")) +
              "\n";
    }
  }
  return text;
}

}  // namespace hysteron
