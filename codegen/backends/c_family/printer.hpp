// Expressions and statements in what C and C++ have in common. How they differ is data: DialectOfC.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "codegen/backends/shared/layout.hpp"
#include "codegen/backends/shared/step_writer.hpp"

namespace hysteron {

struct DialectOfC {
  const SpellingTable& operations;
  std::string_view real{}, truth{}, integer{}, word{};        ///< types
  std::string_view parameters{}, state{}, input{}, output{};  ///< what stands before a member: params.
  std::string_view infinity{}, not_a_number{};
  std::string_view word_begin{}, word_end{};        ///< round the digits of a word
  std::string_view literal_begin{}, literal_end{};  ///< round every literal
  std::string_view read_begin{};                    ///< the call that reads an element of an array at a computed place
  std::string_view element_begin{};                 ///< the call that sets one
  bool passes_length = false;                       ///< whether the calls for elements take the length of the array
  std::string_view place{};  ///< the type of a place in an array, in loops; empty: there are none
  bool careful = false;      ///< x == x is written as !isnan(x), and operators of two kinds stand in brackets
};

std::string_view type_of(const DialectOfC& dialect, Type type);
std::string literal_of(const DialectOfC& dialect, Type type, double value, bool float32);

class PrinterOfC final : public ExpressionPrinter {
 public:
  PrinterOfC(const Graph& graph, const Routine& routine, const Layout& layout, const DialectOfC& dialect, bool float32)
      : ExpressionPrinter(routine.tape, dialect.operations),
        graph_(graph),
        routine_(routine),
        layout_(layout),
        dialect_(dialect),
        float32_(float32) {
    looks_for_equal_sides = dialect.careful;
    brackets_mixed_operators = dialect.careful;
  }

  void print_cell(std::uint32_t cell, std::string& out) const {
    print_member(dialect_.state, layout_.cells[cell], out);
  }
  [[nodiscard]] std::size_t length_of_cell(std::uint32_t cell) const { return routine_.cells[cell].field.length; }
  [[nodiscard]] std::string literal(Type type, double value) const {
    return literal_of(dialect_, type, value, float32_);
  }

 private:
  void print_leaf(const Value& value, int outer, std::string& out) const override;
  void print_special(const Value& value, int outer, std::string& out) const override;
  void print_element(const Value& value, std::string& out) const;
  bool print_equal_sides(const Value& value, const std::string& side, std::string& out) const override;
  static void print_member(std::string_view object, const Member& member, std::string& out);

  const Graph& graph_;
  const Routine& routine_;
  const Layout& layout_;
  const DialectOfC& dialect_;
  bool float32_;
};

class WriterOfC : public StepWriter {
 public:
  WriterOfC(const Graph& the_graph, const Routine& the_routine, PrinterOfC& printer, Identifiers& locals,
            const Layout& layout, const DialectOfC& dialect)
      : StepWriter(the_graph, the_routine, printer, locals),
        printer_(printer),
        layout_(layout),
        dialect_(dialect),
        locals_(locals) {}

  /// The end of a step: the counter of steps goes on, within the longest period.
  void write_counter(std::string& text) const;

 protected:
  void heading(const Node& node, std::string& text) override;
  void begin_rate(const Rate& rate, std::string& text) override;
  void end_rate(std::string& text) override { text += "}\n"; }
  void define(ValueId id, std::string_view name, std::string& text) override;
  void set_output(std::uint32_t output, ValueId value, std::string& text) override;
  void set_cell(std::uint32_t cell, ValueId value, std::string& text) override;
  void set_element(std::uint32_t cell, ValueId index, ValueId value, std::string& text) override;

  [[nodiscard]] bool has_loops() const override { return !dialect_.place.empty(); }
  [[nodiscard]] LoopWords loop_words() override;
  void begin_loop(std::string_view place, std::size_t first, std::size_t end, std::size_t step,
                  std::string& text) override;
  void end_loop(std::string& text) override { text += "}\n"; }
  void declare_array(std::string_view name, Type type, std::size_t length, std::string& text) override;
  void begin_variable(std::string_view name, SumVariable variable, std::string& text) override;
  void set_local(std::string_view element, ValueId value, std::string& text) override;

  const PrinterOfC& printer() const { return printer_; }
  const Layout& layout() const { return layout_; }

 private:
  PrinterOfC& printer_;
  const Layout& layout_;
  const DialectOfC& dialect_;
  Identifiers& locals_;
};

/// Whether a list of statements reads or sets the state.
bool touches_state(const std::vector<Statement>& list, const Operations& used);
/// Whether it sets single elements of arrays.
bool sets_elements(const std::vector<Statement>& list);

/// Appends a comment to the end of the line, if there is something to say: the unit in brackets, and the meaning.
void append_comment(std::string& text, std::string_view begin, std::string_view unit, std::string_view meaning,
                    std::string_view end);

}  // namespace hysteron
