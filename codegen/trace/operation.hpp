// The operations that a step is made of: the words of blocks/scalar.hpp as data.
//
// Diagram expressions, traced blocks, the interpreter and every back-end share this one list. A back-end spells each
// operation in its language; nothing is ever reordered, since reordering changes rounding.
#pragma once

#include <cstdint>
#include <string_view>

#include "blocks/description.hpp"

namespace hysteron {

enum class Op : std::uint8_t {
  // leaves
  RealLiteral,
  IntLiteral,
  BoolLiteral,
  WordLiteral,
  SampleTime,  ///< TS in seconds, of the rate at which the reader runs
  Pin,         ///< in a block's trace: its input, or its parameter behind the inputs
  Cell,        ///< a state variable, before this step; an array as a whole is a Cell too
  Input,       ///< an input of the diagram
  Parameter,   ///< a parameter of the diagram
  // real numbers
  Add,
  Subtract,
  Multiply,
  Divide,
  Negate,
  Abs,
  Sqrt,
  Exp,
  Log,
  Sin,
  Cos,
  Tan,
  Asin,
  Acos,
  Atan,
  Power,
  Min,
  Max,
  // integers: wrap at the ends of DINT; a division by zero gives 0
  IntAdd,
  IntSubtract,
  IntMultiply,
  IntDivide,
  IntModulo,
  IntNegate,
  IntMin,
  IntMax,
  // the bits of integers; a shift is by a literal from 1 to 31, zeros come in on either side
  IntAnd,
  IntOr,
  IntXor,
  IntShiftLeft,
  IntShiftRight,
  // comparison of reals, of integers
  Less,
  LessEqual,
  Equal,
  NotEqual,
  IntLess,
  IntLessEqual,
  IntEqual,
  IntNotEqual,
  // truth values
  And,
  Or,
  Xor,
  Not,
  // the rest
  Select,
  SelectInt,
  SelectBool,
  SelectWord,
  ToInt,
  ToReal,
  ToSingle,   ///< the nearest number that an IEC REAL (32 bits) holds
  WordToInt,  ///< 0 to 65535
  IntToWord,  ///< the lower 16 bits
  At          ///< element of an array: array, index
};

struct OperationInfo {
  std::string_view name;
  std::uint8_t arity;
  Type result;
  Type operand;
};

/// What an operation takes and gives. Select takes a truth value first.
constexpr OperationInfo info(Op op) {
  using enum Op;
  switch (op) {
    case RealLiteral:
      return {"real", 0, Type::Real, Type::Real};
    case IntLiteral:
      return {"int", 0, Type::Int, Type::Int};
    case BoolLiteral:
      return {"bool", 0, Type::Bool, Type::Bool};
    case WordLiteral:
      return {"word", 0, Type::Word, Type::Word};
    case SampleTime:
      return {"TS", 0, Type::Real, Type::Real};
    case Pin:
      return {"pin", 0, Type::Real, Type::Real};
    case Cell:
      return {"cell", 0, Type::Real, Type::Real};
    case Input:
      return {"input", 0, Type::Real, Type::Real};
    case Parameter:
      return {"parameter", 0, Type::Real, Type::Real};
    case Add:
      return {"+", 2, Type::Real, Type::Real};
    case Subtract:
      return {"-", 2, Type::Real, Type::Real};
    case Multiply:
      return {"*", 2, Type::Real, Type::Real};
    case Divide:
      return {"/", 2, Type::Real, Type::Real};
    case Negate:
      return {"negate", 1, Type::Real, Type::Real};
    case Abs:
      return {"abs", 1, Type::Real, Type::Real};
    case Sqrt:
      return {"sqrt", 1, Type::Real, Type::Real};
    case Exp:
      return {"exp", 1, Type::Real, Type::Real};
    case Log:
      return {"log", 1, Type::Real, Type::Real};
    case Sin:
      return {"sin", 1, Type::Real, Type::Real};
    case Cos:
      return {"cos", 1, Type::Real, Type::Real};
    case Tan:
      return {"tan", 1, Type::Real, Type::Real};
    case Asin:
      return {"asin", 1, Type::Real, Type::Real};
    case Acos:
      return {"acos", 1, Type::Real, Type::Real};
    case Atan:
      return {"atan", 1, Type::Real, Type::Real};
    case Power:
      return {"power", 2, Type::Real, Type::Real};
    case Min:
      return {"min", 2, Type::Real, Type::Real};
    case Max:
      return {"max", 2, Type::Real, Type::Real};
    case IntAdd:
      return {"+", 2, Type::Int, Type::Int};
    case IntSubtract:
      return {"-", 2, Type::Int, Type::Int};
    case IntMultiply:
      return {"*", 2, Type::Int, Type::Int};
    case IntDivide:
      return {"/", 2, Type::Int, Type::Int};
    case IntModulo:
      return {"mod", 2, Type::Int, Type::Int};
    case IntNegate:
      return {"negate", 1, Type::Int, Type::Int};
    case IntMin:
      return {"min", 2, Type::Int, Type::Int};
    case IntMax:
      return {"max", 2, Type::Int, Type::Int};
    case IntAnd:
      return {"bits and", 2, Type::Int, Type::Int};
    case IntOr:
      return {"bits or", 2, Type::Int, Type::Int};
    case IntXor:
      return {"bits xor", 2, Type::Int, Type::Int};
    case IntShiftLeft:
      return {"shift left", 2, Type::Int, Type::Int};
    case IntShiftRight:
      return {"shift right", 2, Type::Int, Type::Int};
    case Less:
      return {"<", 2, Type::Bool, Type::Real};
    case LessEqual:
      return {"<=", 2, Type::Bool, Type::Real};
    case Equal:
      return {"=", 2, Type::Bool, Type::Real};
    case NotEqual:
      return {"<>", 2, Type::Bool, Type::Real};
    case IntLess:
      return {"<", 2, Type::Bool, Type::Int};
    case IntLessEqual:
      return {"<=", 2, Type::Bool, Type::Int};
    case IntEqual:
      return {"=", 2, Type::Bool, Type::Int};
    case IntNotEqual:
      return {"<>", 2, Type::Bool, Type::Int};
    case And:
      return {"and", 2, Type::Bool, Type::Bool};
    case Or:
      return {"or", 2, Type::Bool, Type::Bool};
    case Xor:
      return {"xor", 2, Type::Bool, Type::Bool};
    case Not:
      return {"not", 1, Type::Bool, Type::Bool};
    case Select:
      return {"select", 3, Type::Real, Type::Real};
    case SelectInt:
      return {"select", 3, Type::Int, Type::Int};
    case SelectBool:
      return {"select", 3, Type::Bool, Type::Bool};
    case SelectWord:
      return {"select", 3, Type::Word, Type::Word};
    case ToInt:
      return {"to_int", 1, Type::Int, Type::Real};
    case ToReal:
      return {"to_real", 1, Type::Real, Type::Int};
    case ToSingle:
      return {"to_single", 1, Type::Real, Type::Real};
    case WordToInt:
      return {"word_to_int", 1, Type::Int, Type::Word};
    case IntToWord:
      return {"int_to_word", 1, Type::Word, Type::Int};
    case At:
      return {"at", 2, Type::Real, Type::Real};
  }
  return {"", 0, Type::Real, Type::Real};
}

constexpr bool is_leaf(Op op) {
  return op <= Op::Parameter;
}
constexpr bool is_literal(Op op) {
  return op <= Op::WordLiteral;
}
constexpr bool is_select(Op op) {
  return op >= Op::Select && op <= Op::SelectWord;
}

}  // namespace hysteron
