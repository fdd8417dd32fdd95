// Expressions as text, with the brackets that keep the order of rounding. A target gives the spelling of each
// operation as a row of a table, and spells by itself its leaves and what has a form of its own.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/trace/tape.hpp"

namespace hysteron {

/// How strongly an operator binds, weakest first: the order that C++, C and Structured Text have in common.
struct Strength {
  enum Level : int {
    Loosest = 0,
    Conditional,
    LogicalOr,
    LogicalXor,
    LogicalAnd,
    Equality,
    Relation,
    Additive,
    Multiplicative,
    Prefix,
    Primary
  };
};

struct Spelling {
  enum class Form : std::uint8_t {
    Special,  ///< spelled by the target
    Infix,
    Sign,  ///< a minus before its operand
    Not,
    Call
  };
  std::string_view text{};
  Form form = Form::Special;
  int strength = Strength::Primary;
};

inline constexpr std::size_t operation_count = static_cast<std::size_t>(Op::At) + 1;

/// By operation; leaves have no row of their own.
class SpellingTable {
 public:
  struct Row {
    Op op = Op::RealLiteral;
    Spelling spelling{};
  };
  template <std::size_t N>
  constexpr explicit SpellingTable(const Row (&rows)[N]) {
    for (const Row& row : rows) {
      table_[static_cast<std::size_t>(row.op)] = row.spelling;
    }
  }
  /// The same with further rows.
  template <std::size_t N>
  [[nodiscard]] constexpr SpellingTable with(const Row (&rows)[N]) const {
    SpellingTable result = *this;
    for (const Row& row : rows) {
      result.set(row.op, row.spelling);
    }
    return result;
  }
  constexpr void set(Op op, const Spelling& spelling) { table_[static_cast<std::size_t>(op)] = spelling; }
  constexpr const Spelling& operator[](Op op) const { return table_[static_cast<std::size_t>(op)]; }

 private:
  std::array<Spelling, operation_count> table_{};
};

constexpr Spelling infix(std::string_view text, int strength) {
  return {text, Spelling::Form::Infix, strength};
}
constexpr Spelling call(std::string_view text) {
  return {text, Spelling::Form::Call, Strength::Primary};
}
constexpr Spelling sign(std::string_view text) {
  return {text, Spelling::Form::Sign, Strength::Prefix};
}
constexpr Spelling negation(std::string_view text) {
  return {text, Spelling::Form::Not, Strength::Prefix};
}

/// A literal place in an array of a length: one that lies outside is the nearest end.
[[nodiscard]] inline std::size_t place_within(double place, std::size_t length) {
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(length - 1)));
}

/// Prints the values of a tape. A value that has a name is its name.
class ExpressionPrinter {
 public:
  ExpressionPrinter(const Tape& tape, const SpellingTable& table)
      : tape_(tape), table_(table), name_of_(tape.size(), 0) {}
  virtual ~ExpressionPrinter() = default;
  ExpressionPrinter(const ExpressionPrinter&) = delete;
  ExpressionPrinter& operator=(const ExpressionPrinter&) = delete;

  void name(ValueId id, std::string_view name) {
    names_.push_back(name);
    name_of_[id] = static_cast<std::uint32_t>(names_.size());
  }
  [[nodiscard]] bool is_named(ValueId id) const { return name_of_[id] != 0; }
  /// A value is written out again.
  void unname(ValueId id) { name_of_[id] = 0; }
  /// What a value is called, for `call_again`: 0 where it has no name.
  [[nodiscard]] std::uint32_t called(ValueId id) const { return name_of_[id]; }
  void call_again(ValueId id, std::uint32_t called) { name_of_[id] = called; }
  [[nodiscard]] const Tape& tape() const { return tape_; }

  /// Appends a value's text, with brackets where it binds less strongly than `outer`.
  void print(ValueId id, int outer, std::string& out) const;
  void print(ValueId id, std::string& out) const { print(id, Strength::Loosest, out); }
  /// Appends what is added: the right side of a +.
  void print_added(ValueId id, std::string& out) const;

 protected:
  /// A value that has a name.
  virtual void print_name(std::string_view name, std::string& out) const { out += name; }
  /// A literal, a sample time, an input, a parameter or a cell.
  virtual void print_leaf(const Value& value, int outer, std::string& out) const = 0;
  /// An operation whose row is Special.
  virtual void print_special(const Value& value, int outer, std::string& out) const = 0;
  /// Whether a minus before an operand needs brackets within an expression.
  [[nodiscard]] virtual bool sign_needs_brackets(int outer) const {
    return outer > Strength::Prefix || outer == Strength::Additive + 1;
  }

  /// A comparison of two sides that read alike, which compilers warn of: false where it is to be written as it is.
  virtual bool print_equal_sides(const Value& /*value*/, const std::string& /*side*/, std::string& /*out*/) const {
    return false;
  }
  bool looks_for_equal_sides = false;
  bool brackets_mixed_operators = false;  ///< a + (b * c), as rules for C ask for

  void print_arguments(const Value& value, std::string& out) const;

 private:
  void print_infix(const Value& value, const Spelling& spelled, int outer, std::string& out) const;

  const Tape& tape_;
  const SpellingTable& table_;
  std::vector<std::uint32_t> name_of_;  ///< by value: 0, or one more than its place in names_
  std::vector<std::string_view> names_;
};

}  // namespace hysteron
