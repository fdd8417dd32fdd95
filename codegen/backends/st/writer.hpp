// The statements of a step in Structured Text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/layout.hpp"
#include "codegen/backends/shared/step_writer.hpp"
#include "codegen/backends/shared/words.hpp"
#include "codegen/backends/st/printer.hpp"

namespace hysteron {

/// A local variable, of a value that has a name, or of those of a vector.
struct StLocal {
  std::string_view name{};
  Type type = Type::Real;
  std::uint32_t length = 1;
};

class StWriter final : public StepWriter {
 public:
  StWriter(const Graph& the_graph, const Routine& the_routine, StPrinter& printer, Identifiers& the_locals,
           const Layout& layout, const StNames& names);

  /// Values that are an output as they stand get its name at once, but for those that `ahead` leaves for the end. So do
  /// elements of vectors where each is a pin of its own.
  void name_outputs_at_once(const std::vector<bool>& ahead, bool single_pins);
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
