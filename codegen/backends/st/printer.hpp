// Expressions in Structured Text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/expression_printer.hpp"
#include "codegen/backends/shared/layout.hpp"
#include "codegen/backends/shared/routine.hpp"
#include "codegen/backends/st/dialect.hpp"
#include "codegen/backends/st/guards.hpp"
#include "codegen/backends/st/literals.hpp"
#include "codegen/backends/st/words.hpp"

namespace hysteron {

/// What the block declares beside what the diagram has.
struct StNames {
  std::string_view sample_time{};
  std::string_view largest{};  ///< the largest number of the type, where the interpreter has infinity
  std::string_view place{};    ///< of an element, in loops
};

class StPrinter final : public ExpressionPrinter {
 public:
  StPrinter(const Graph& graph, const Routine& routine, const Layout& layout, const StNames& names,
            const StDialect& dialect, bool float32);

  [[nodiscard]] const Guards& guards() const { return guards_; }
  [[nodiscard]] bool float32() const { return float32_; }
  [[nodiscard]] std::string literal(Type type, double value) const {
    return st_literal(type, value, {.float32 = float32_, .small_literals = dialect_.small_literals});
  }
  [[nodiscard]] std::uint16_t length_of(ValueId array) const;

  /// A variable of the block in its body.
  void print_variable(std::string_view name, std::string& out) const { out.append(dialect_.local_prefix).append(name); }
  void print_cell(std::uint32_t cell, std::string& out) const { print_variable(layout_.cells[cell].name, out); }
  [[nodiscard]] std::string pin_name(std::string_view name) const { return st_pin_name(name, dialect_); }
  /// [LIMIT(0, index, last)]
  void print_place(ValueId index, std::uint16_t length, std::string& out) const;
  /// The largest number, above or below 0.
  void print_largest(bool negative, int outer, std::string& out) const;
  void print_power(std::string_view base, std::string_view exponent, std::string& out) const;
  /// A function of two or three arguments, by the names that they have.
  void print_call(std::string_view function, std::initializer_list<std::string_view> names,
                  std::initializer_list<std::string_view> arguments, std::string& out) const;
  /// A real literal in the body, and 0.
  [[nodiscard]] std::string real(std::string_view digits) const {
    return float32_ ? st_typed_literal("REAL", digits) : std::string(digits);
  }
  [[nodiscard]] std::string zero() const { return real("0.0"); }
  [[nodiscard]] std::string text(ValueId id, int outer = Strength::Loosest) const;

  mutable bool uses_sample_time = false;
  mutable bool uses_largest = false;

 private:
  void print_name(std::string_view name, std::string& out) const override { print_variable(name, out); }
  void print_leaf(const Value& value, int outer, std::string& out) const override;
  void print_special(const Value& value, int outer, std::string& out) const override;
  [[nodiscard]] bool sign_needs_brackets(int outer) const override { return outer > Strength::Loosest; }
  void print_power_inside(const Value& value, int outer, std::string& out) const;
  [[nodiscard]] std::string argument(ValueId id) const;
  [[nodiscard]] std::string pattern(ValueId id) const;
  [[nodiscard]] std::string bits_text(const Value& value) const;
  /// A literal of an integer, which the text writes where it is used.
  [[nodiscard]] bool is_integer(ValueId id) const { return tape()[id].op == Op::IntLiteral && !is_named(id); }
  [[nodiscard]] bool is_word(ValueId id) const;
  void print_as_word(ValueId id, int outer, std::string& out) const;
  void print_bits(const Value& value, int outer, std::string& out) const;
  void print_negated(ValueId id, int outer, std::string& out) const;
  void print_comparison(const Value& value, int outer, std::string& out) const;

  const Graph& graph_;
  const Routine& routine_;
  const Layout& layout_;
  const StNames& names_;
  const StDialect& dialect_;
  bool float32_;
  Guards guards_;
};

}  // namespace hysteron
