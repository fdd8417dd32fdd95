// Arithmetic of sequential bodies on the wires of a graph.
//
// Intermediate results are wider than their operands, as C has it, into which IEC compilers translate: integers are
// computed with 32 bits, and a REAL with a literal or an LREAL as an LREAL. A number is taken to the width of its type
// where it is kept in a variable or handed to a function. MATIEC gives the same bits.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "codegen/graph/body/types.hpp"
#include "codegen/graph/lowering.hpp"

namespace hysteron::bodies {

struct Value {
  Wire wire{};
  Plain type = Plain::Bool;
  bool loose = false;    ///< a literal without a type: it takes that of its neighbour
  bool untyped = false;  ///< made of such literals, or with one beyond its neighbour: each type that holds it takes it
  bool wide = false;     ///< a REAL that was not yet rounded to 32 bits
  std::int64_t low = 0;
  std::int64_t high = 0;  ///< integers: what it may be, between these
  [[nodiscard]] bool valid() const { return wire.from != Wire::From::Nothing; }
  /// It may be above the greatest DINT, whose bits are those of a number below 0: its range is that of the bits.
  [[nodiscard]] bool beyond_dint() const { return is_unsigned_32(type) && low < 0; }
};

/// Whether what is made of some values has a type by its range or its target alone: of literals; of a literal beyond
/// its neighbour, X + 40000; of a real literal and integers, X * 0.1.
class Untyped {
 public:
  explicit Untyped(std::span<const Value> values);
  Untyped(std::initializer_list<Value> values) : Untyped(std::span(values.begin(), values.size())) {}
  [[nodiscard]] bool as(Plain result) const;

 private:
  bool literal_ = false;
  bool typed_number_ = false;
  std::vector<Plain> typed_{};
};

class Computer {
 public:
  using Report = Types::Report;
  Computer(GraphBuilder& builder, Report report) : builder_(builder), report_(std::move(report)) {}

  /// What the next operations feed, and where they are written.
  void at(std::string path, language::Span span) {
    path_ = std::move(path);
    span_ = span;
  }
  [[nodiscard]] language::Span span() const { return span_; }
  void at(language::Span span) { span_ = span; }

  Value literal(Plain type, double value, bool loose = false);
  Value truth(bool value) { return literal(Plain::Bool, value ? 1.0 : 0.0); }
  [[nodiscard]] bool constant(const Value& value, double& number) const;
  [[nodiscard]] bool is_true(const Value& value) const;
  [[nodiscard]] bool is_false(const Value& value) const;

  /// From a port or a cell of the graph, and to it.
  Value taken(Wire wire, Plain type);
  Wire given(const Value& value);

  /// The value as a type keeps it: integers wrap to its width, a REAL is rounded. Of one family.
  Value fit(const Value& value, Plain type);
  /// How a value becomes one of a type, as a mend.
  [[nodiscard]] std::string conversion_in_words(const Value& value, Plain type) const;
  /// What an assignment to a variable of the type takes; invalid, and an error, where it takes none.
  Value assignable(const Value& value, Plain type, const std::string& target);
  /// X_TO_Y.
  Value convert(const Value& value, Plain type);
  Value truncated(const Value& value, Plain type);

  Value negative(const Value& value);
  Value inverse(const Value& value);
  Value binary(language::Operator op, Value left, Value right);
  Value select(const Value& condition, const Value& yes, const Value& no);
  /// The lesser of two numbers of one type, or the greater; the first where they are equal.
  Value extreme(const Value& first, const Value& second, bool greater);
  Value shifted(const Value& value, const Value& places, bool left);
  Value rotated(const Value& value, const Value& places, bool left);
  /// Both as the type that the two have in common; false, and an error, where there is none.
  bool meet(Value& left, Value& right, std::string_view what);
  Value operation(Op op, std::initializer_list<Value> operands, Plain type);
  Value refused(int number, std::string cause, std::string mend);

 private:
  Wire apply(Op op, std::initializer_list<Wire> operands) { return builder_.operation(op, operands, path_, span_); }
  Wire whole(std::int64_t value);
  Wire real_of(const Value& value);
  Value whole_of(Wire real, Plain type, bool round);
  Value whole_milliseconds(const Value& time, Plain type);
  Value integer(Op op, const Value& left, const Value& right, Plain type);
  static std::optional<bool> decided(language::Operator op, const Value& left, const Value& right);
  Value compared(language::Operator op, const Value& left, const Value& right);
  Value bits(language::Operator op, const Value& left, const Value& right, Plain type);
  Value divided(bool remainder, const Value& left, const Value& right, Plain type);
  static Value ranged(Wire wire, Plain type, std::int64_t low, std::int64_t high);
  bool meet_literal(Value& left, Value& right, std::string_view what);
  Value of_literals(language::Operator op, const Value& left, const Value& right);
  Value beyond(Plain type, std::int64_t number);
  [[nodiscard]] bool is_zero(const Value& value) const;
  void warn_of_zero(bool remainder);

  GraphBuilder& builder_;
  Report report_;
  std::string path_{};
  language::Span span_{};
};

}  // namespace hysteron::bodies
