// The functions of the standard that stand for operators of the text: ADD for +, GE for >=.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "codegen/language/syntax.hpp"

namespace hysteron::plcopen {

struct OperatorFunction {
  language::Operator op{};
  std::string_view name;       ///< ADD
  std::string_view symbol;     ///< +
  bool takes_more = false;     ///< ADD(A, B, C)
  bool is_comparison = false;  ///< the result is a BOOL
};

/// The function of a binary operator, or of NOT.
[[nodiscard]] const OperatorFunction& function_of(language::Operator op);

/// The operator of a function, without regard to case; null where none does the same.
[[nodiscard]] const OperatorFunction* operator_of(std::string_view function);

/// What a function's input is called: IN1 of ADD, MN of LIMIT. `place` counts from 0.
[[nodiscard]] std::string input_of(std::string_view function, std::size_t place);

/// Where an input of a function belongs, by its name; nothing where the name says no place.
[[nodiscard]] std::optional<std::size_t> place_of(std::string_view function, std::string_view input);

/// What a function's only output is called.
inline constexpr std::string_view function_output = "OUT";

}  // namespace hysteron::plcopen
