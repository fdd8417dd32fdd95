// Expressions and statements in Structured Text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/layout.hpp"
#include "codegen/backends/shared/step_writer.hpp"
#include "codegen/backends/shared/words.hpp"
#include "codegen/backends/st/dialect.hpp"
#include "codegen/backends/st/guards.hpp"
#include "codegen/backends/st/words.hpp"

namespace hysteron {

/// What the block declares beside what the diagram has.
struct StNames {
  std::string_view sample_time{};
  std::string_view largest{};  ///< the largest number of the type, where the interpreter has infinity
  std::string_view place{};    ///< of an element, in loops
};

/// A local variable, of a value that has a name, or of those of a vector.
struct StLocal {
  std::string_view name{};
  Type type = Type::Real;
  std::uint32_t length = 1;
};

std::string_view st_type(Type type, bool float32);

/// The range and the type of real literals.
struct StReals {
  bool float32 = false;
  bool small_literals = false;
};

/// A literal as an initial value; infinities are the largest number that the dialect can write.
std::string st_literal(Type type, double value, const StReals& reals);

/// A literal with its type. The sign stands before: LREAL#-0.5 is no number for some compilers.
std::string st_typed_literal(std::string_view type, std::string_view digits);

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

class StWriter final : public StepWriter {
 public:
  StWriter(const Graph& the_graph, const Routine& the_routine, StPrinter& printer, Identifiers& the_locals,
           const Layout& layout, const StNames& names);

  /// Values that are an output as they stand get its name at once.
  void name_outputs_at_once(const std::vector<bool>& ahead);
  /// What stands within an IF of the block's own.
  void indent(std::string_view spaces) { indentation = outer_indentation = spaces; }
  void write_reset_body(std::string& text);
  void write_counter(std::string& text) const;

  /// Of the values that the text names, in the order of their coming.
  std::vector<StLocal> locals{};
  bool uses_place = false;
  bool uses_term = false;
  std::string_view term_name{};  ///< what counts the terms of a sum

 protected:
  void heading(const Node& node, std::string& text) override;
  void begin_rate(const Rate& rate, std::string& text) override;
  void end_rate(std::string& text) override { text += "END_IF;\n"; }
  void define(ValueId id, std::string_view name, std::string& text) override;
  void set_output(std::uint32_t output, ValueId value, std::string& text) override;
  void set_cell(std::uint32_t cell, ValueId value, std::string& text) override;
  void set_element(std::uint32_t cell, ValueId index, ValueId value, std::string& text) override;
  void fill_cell(std::uint32_t cell, ValueId value, std::string& text) override;
  /// An output is a variable of the block itself.
  [[nodiscard]] bool is_taken(std::string_view owner) const override {
    return find_port(graph.outputs, owner) != nullptr;
  }
  void call(const Statement& statement, bool reset, std::string& text) override;
  [[nodiscard]] std::string_view output_name(std::uint32_t output) const override { return layout_.outputs[output]; }
  [[nodiscard]] std::string_view word_for(const Value& value) const override { return word_for_result(value.op); }
  [[nodiscard]] bool has_loops() const override { return true; }
  [[nodiscard]] LoopWords loop_words() override;
  void begin_loop(std::string_view place, std::size_t first, std::size_t end, std::size_t step,
                  std::string& text) override;
  void end_loop(std::string& text) override { text += "END_FOR;\n"; }
  void declare_array(std::string_view name, Type type, std::size_t length, std::string& text) override;
  void begin_variable(std::string_view name, SumVariable variable, std::string& text) override;
  void print_variable(std::string_view name, std::string& text) const override { printer_.print_variable(name, text); }
  void set_local(std::string_view element, ValueId value, std::string& text) override;

 private:
  void assign(std::string_view target, ValueId value, std::string& text);
  void set_variable(const std::string& target, ValueId id, std::string& text);
  void line(std::string_view words, std::string& text) const;
  void define_quotient(const Value& value, const std::string& name, std::string& text);
  void define_integer_quotient(const Value& value, const std::string& name, std::string& text);
  void define_power(const Value& value, const std::string& name, std::string& text);
  void define_power_of_any(const Value& value, const std::string& name, std::string& text);
  void define_integer(const Value& value, const std::string& name, std::string& text);

  StPrinter& printer_;
  const Layout& layout_;
  Identifiers& identifiers_;
  std::string place_;
  std::string term_;
  std::string_view sum_;
};

}  // namespace hysteron
