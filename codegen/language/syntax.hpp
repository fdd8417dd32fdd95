// The syntax tree of a diagram file: what was written, where, before anything is known of its meaning.
//
// Names and texts are views into the source text, which the SourceFile owns; expressions stand in one array and
// name each other by index, so that a file of 100 000 instances costs a handful of allocations.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "support/diagnostic.hpp"

namespace hysteron::language {

/// A stretch of the source text, by offset and length. Line and column are found when they are printed.
struct Span {
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
};

/// An identifier as written. Identifiers are compared without regard to case: see same_name and upper.
struct Name {
  std::string_view text{};
  Span span{};
};

/// `@unit um` in a comment: key "unit", value "um". Value is empty where there is none.
struct Annotation {
  std::string_view key{};
  std::string_view value{};
  Span span{};  ///< key and value
  Span value_span{};
};

enum class Operator : std::uint8_t {
  Negate,
  Not,  // unary
  Add,
  Subtract,
  Multiply,
  Divide,
  Modulo,
  Power,  // arithmetic
  Less,
  LessEqual,
  Greater,
  GreaterEqual,
  Equal,
  NotEqual,
  And,
  Or,
  Xor
};

using ExpressionId = std::uint32_t;
inline constexpr ExpressionId no_expression = std::numeric_limits<ExpressionId>::max();

struct RealLiteral {
  double value = 0.0;
};
struct IntLiteral {
  std::int64_t value = 0;  ///< within DINT, or within WORD
  bool is_word = false;    ///< written WORD#…
};
struct BoolLiteral {
  bool value = false;
};
/// `X` (pin empty) or `INSTANCE.PIN`; `X[2]` and `INSTANCE.PIN[2]` have an index.
struct Reference {
  Name name{};
  Name pin{};
  ExpressionId index = no_expression;
};
struct Unary {
  Operator op{};
  ExpressionId operand = no_expression;
};
struct Binary {
  Operator op{};
  ExpressionId left = no_expression;
  ExpressionId right = no_expression;
  std::int8_t bit = -1;  ///< written W.3: this is (W AND 16#8) <> 16#0, and 3
};
/// `LIMIT(0.0, X, 1.0)`; a formal argument (`MN := 0.0`) keeps its name.
struct FunctionArgument {
  Name formal{};
  ExpressionId value = no_expression;
};
struct FunctionCall {
  Name function{};
  std::vector<FunctionArgument> arguments{};
};
/// `[0.0, 1.0, 2.0]`: a vector, or the values of a parameter that is an array.
struct ArrayLiteral {
  std::vector<ExpressionId> elements{};
};

struct Expression {
  std::variant<RealLiteral, IntLiteral, BoolLiteral, Reference, Unary, Binary, FunctionCall, ArrayLiteral> node{};
  Span span{};
};

/// `XIN := RATE.XOUT` in a call or in the initial value of an instance.
struct Argument {
  Name pin{};
  ExpressionId value = no_expression;
};

/// `RATE(XIN := Y_REF);`
struct Call {
  Name instance{};
  std::vector<Argument> arguments{};
  Span span{};
};

/// `U := SUM.XOUT;`, `U[0] := SUM.XOUT;`
struct Assignment {
  Name target{};
  ExpressionId index = no_expression;
  ExpressionId value = no_expression;
  Span span{};
};

using Statement = std::variant<Call, Assignment>;

enum class Section : std::uint8_t { Input, Output, Local, Constant };

/// One declared name. `X, Y : LREAL;` makes two variables, which share the expressions of their initial value.
struct Variable {
  Name name{};
  Name type{};  ///< LREAL, BOOL, DINT, WORD, or the name of a block; of a vector, that of its elements
  ExpressionId first = no_expression;  ///< ARRAY[first..last] OF type
  ExpressionId last = no_expression;
  Section section = Section::Local;
  ExpressionId initial = no_expression;  ///< `:= 1.0` of an elementary variable
  std::vector<Argument> settings{};      ///< `:= (C1 := 0.05, C2 := 1.3)` of an instance
  std::vector<Annotation> annotations{};
  [[nodiscard]] bool is_vector() const { return first != no_expression; }
};

namespace body {
struct Library;
}

struct FunctionBlock {
  static constexpr std::uint32_t no_body = std::numeric_limits<std::uint32_t>::max();
  Name name{};
  std::vector<Annotation> annotations{};
  std::vector<Variable> variables{};
  std::vector<Statement> statements{};
  Span span{};
  /// Of a text whose vectors have become their elements: by statement, which one of the text it was.
  std::vector<std::uint32_t> origins{};
  std::uint32_t body = no_body;  ///< which unit of SourceFile::bodies its text is, too
  bool sequential = false;       ///< it is that unit: it has no statements of a diagram
};

struct SourceFile {
  std::string path{};
  std::shared_ptr<const std::string> text{};  ///< all views and spans point into it
  std::vector<FunctionBlock> blocks{};
  std::shared_ptr<const body::Library> bodies{};  ///< null where no block of the file is sequential
  std::vector<Expression> expressions{};
  std::vector<std::uint32_t> line_starts{};          ///< the offset at which each line begins
  bool valid = false;                                ///< read without a syntax error
  bool has_vectors = false;                          ///< a diagram in it declares a vector, or writes one
  std::shared_ptr<std::deque<std::string>> names{};  ///< that the text does not have: of elements, Y[2]

  /// The place of a span: file, line and column.
  [[nodiscard]] Place place(Span span) const;
  /// What is written there.
  [[nodiscard]] std::string_view text_of(Span span) const {
    return std::string_view(*text).substr(span.offset, span.length);
  }
};

/// Parses a text. Finds every syntax error, not only the first; the tree then holds what could be read.
SourceFile parse(std::string path, std::string text, Diagnostics& diagnostics);

/// Reads and parses a file; a file that cannot be read is a diagnostic like any other.
SourceFile parse_file(const std::string& path, Diagnostics& diagnostics);

/// Identifiers compared as the language does: without regard to case.
bool same_name(std::string_view a, std::string_view b);
/// X3, as some editors write the bit 3 of a word: W.X3.
bool names_bit(std::string_view member);
std::string upper(std::string_view name);

/// For each block of a file, its statements by their indexes in the order wanted; an empty order keeps the source's.
using StatementOrders = std::vector<std::vector<std::uint32_t>>;

/// The same diagram in the house's layout: one declaration and one call a line, columns aligned, comments kept with
/// what they stood beside, statements in the order given. Formatting twice changes nothing. A file with syntax
/// errors is given back as it is. Throws std::invalid_argument where an order is not a permutation of the
/// statements.
std::string format(const SourceFile& file, const StatementOrders& orders = {});

}  // namespace hysteron::language
