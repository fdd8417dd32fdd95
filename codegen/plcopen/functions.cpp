#include "codegen/plcopen/functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "codegen/graph/lowering.hpp"
#include "support/names.hpp"

namespace hysteron::plcopen {
namespace {

using language::Operator;

constexpr std::array functions{
    OperatorFunction{Operator::Add, "ADD", "+", true},
    OperatorFunction{Operator::Subtract, "SUB", "-"},
    OperatorFunction{Operator::Multiply, "MUL", "*", true},
    OperatorFunction{Operator::Divide, "DIV", "/"},
    OperatorFunction{Operator::Modulo, "MOD", "MOD"},
    OperatorFunction{Operator::Power, "EXPT", "**"},
    OperatorFunction{Operator::Less, "LT", "<", false, true},
    OperatorFunction{Operator::LessEqual, "LE", "<=", false, true},
    OperatorFunction{Operator::Greater, "GT", ">", false, true},
    OperatorFunction{Operator::GreaterEqual, "GE", ">=", false, true},
    OperatorFunction{Operator::Equal, "EQ", "=", false, true},
    OperatorFunction{Operator::NotEqual, "NE", "<>", false, true},
    OperatorFunction{Operator::And, "AND", "AND", true},
    OperatorFunction{Operator::Or, "OR", "OR", true},
    OperatorFunction{Operator::Xor, "XOR", "XOR", true},
    OperatorFunction{Operator::Not, "NOT", "NOT"},
};

}  // namespace

const OperatorFunction& function_of(Operator op) {
  return *std::ranges::find_if(functions, [&](const OperatorFunction& one) { return one.op == op; });
}

const OperatorFunction* operator_of(std::string_view function) {
  const auto* const found = std::ranges::find_if(
      functions, [&](const OperatorFunction& one) { return equal_ignoring_case(one.name, function); });
  return found == functions.end() ? nullptr : found;
}

std::string input_of(std::string_view function, std::size_t place) {
  const OperatorFunction* const own = operator_of(function);
  if (own != nullptr && own->op != Operator::Not) {
    return fmt::format("IN{}", place + 1);
  }
  const auto names = formal_arguments(function);
  return place < names.size() ? std::string(names[place]) : fmt::format("IN{}", place + 1);
}

std::optional<std::size_t> place_of(std::string_view function, std::string_view input) {
  constexpr std::size_t most_inputs = 64;
  for (std::size_t place = 0; place < most_inputs; ++place) {
    if (equal_ignoring_case(input_of(function, place), input)) {
      return place;
    }
  }
  return std::nullopt;
}

}  // namespace hysteron::plcopen
