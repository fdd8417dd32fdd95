// The syntax of a sequential body: what a FUNCTION_BLOCK holds that is executed from top to bottom, and the types and
// functions that stand beside it. Diagrams have a syntax of their own, in syntax.hpp.
//
// Names are views into the source text. Expressions stand in one array and name each other by index.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "codegen/language/syntax.hpp"

namespace hysteron::language::body {

/// `42`, `1.5`, `TRUE`, `T#1m30s`, `INT#5`.
struct Literal {
  enum class Kind : std::uint8_t { Whole, Real, Truth, Time };
  Kind kind = Kind::Whole;
  double value = 0.0;       ///< a time in milliseconds; a whole number up to 2^53 is exact
  std::string_view type{};  ///< what stands before #; empty where nothing does
};

/// `.FIELD`, `[I, J]` or `.3`, which is a bit.
struct Step {
  Name member{};
  std::vector<ExpressionId> indexes{};
  int bit = -1;
};

/// `X`, `S.FIELD`, `A[I].B`, `INST.Q`, and `MODE#AUTO`, which has the name of its type in `type`.
struct Access {
  Name name{};
  std::vector<Step> steps{};
  std::string_view type{};
  Span span{};
};

using language::Binary;
using language::Unary;

/// `PIN := value`, `value`, or `OUTPUT => variable`.
struct Argument {
  Name formal{};
  ExpressionId value = no_expression;
  bool output = false;
};
struct Call {
  Name function{};
  std::vector<Argument> arguments{};
};

struct Expression {
  std::variant<Literal, Access, Unary, Binary, Call> node{};
  Span span{};
};

struct Statement;
using Statements = std::vector<Statement>;  // members of it have no {}, which would need a complete Statement here

struct Assign {
  Access target{};
  ExpressionId value = no_expression;
};
/// `INST(IN := X, Q => Y)`
struct Invoke {
  Access instance{};
  std::vector<Argument> arguments{};
};
struct Branch {
  ExpressionId condition = no_expression;
  Statements statements;
};
struct If {
  std::vector<Branch> branches{};
  Statements otherwise;
};
struct Label {
  ExpressionId low = no_expression;
  ExpressionId high = no_expression;  ///< no_expression: one value
};
struct Arm {
  std::vector<Label> labels{};
  Statements statements;
};
struct Case {
  ExpressionId selector = no_expression;
  std::vector<Arm> arms{};
  Statements otherwise;
};
struct For {
  Name variable{};
  ExpressionId from = no_expression;
  ExpressionId to = no_expression;
  ExpressionId by = no_expression;
  Statements statements;
};
/// WHILE, which is tested before each round, or REPEAT, which is tested behind it and ends where its condition holds.
struct Loop {
  ExpressionId condition = no_expression;
  bool tested_first = true;
  Statements statements;
};
enum class Jump : std::uint8_t { Return, Exit, Continue };

struct Statement {
  std::variant<Assign, Invoke, If, Case, For, Loop, Jump> node{};
  Span span{};
};

struct InitialMember;

/// `1.0`, `[1, 2, 3(0)]`, `(A := 1)`.
struct Initial {
  ExpressionId value = no_expression;
  std::vector<Initial> elements{};
  std::vector<InitialMember> members;
  ExpressionId repeat = no_expression;  ///< of an element: 3(0)
  Span span{};
  [[nodiscard]] bool given() const { return value != no_expression || !elements.empty() || !members.empty(); }
};

/// `A := 1`
struct InitialMember {
  Name name{};
  Initial initial{};
};

struct Declaration;

struct TypeSpec {
  Name name{};                                                      ///< INT, MOTOR, of an array that of its elements
  std::vector<std::pair<ExpressionId, ExpressionId>> dimensions{};  ///< 0..9, 1..3
  std::vector<Declaration> fields;                                  ///< STRUCT
  std::vector<std::pair<Name, ExpressionId>> values{};              ///< (OFF, ON := 4)
  Label subrange{};                                                 ///< INT (0..100)
};

enum class Role : std::uint8_t { Input, Output, InOut, Local, Temporary, Constant };

struct Declaration {
  Name name{};
  TypeSpec type{};
  Initial initial{};
  Role role = Role::Local;
};

struct TypeDefinition {
  Name name{};
  TypeSpec type{};
  Initial initial{};
};

/// A FUNCTION_BLOCK or a FUNCTION.
struct Unit {
  Name name{};
  bool function = false;
  TypeSpec result{};
  std::vector<Declaration> declarations{};  ///< of a block, beside FunctionBlock::variables
  std::vector<Declaration> externals{};     ///< VAR_EXTERNAL: global variables of the file
  Statements statements{};
  Span span{};
};

/// All that the bodies of a file need.
struct Library {
  std::vector<TypeDefinition> types{};
  std::vector<Declaration> globals{};  ///< VAR_GLOBAL
  std::vector<Unit> units{};
  std::vector<Expression> expressions{};
  bool has_open_loops = false;  ///< a WHILE, a REPEAT, or a FOR whose bounds are no literals
};

}  // namespace hysteron::language::body
