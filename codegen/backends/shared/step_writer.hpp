// The statements of a step as text: which values get a name, in which order, under which block's heading. A target
// spells the single lines.
//
// A value that is used once is written where it is used. A value that is used more often, and one that a target cannot
// write inside an expression, gets a name before its first use.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/expression_printer.hpp"
#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/backends/shared/routine.hpp"

namespace hysteron {

class StepWriter {
 public:
  /// `locals` gives the names of values; the words that they may not be are in it.
  StepWriter(const Graph& graph, const Routine& routine, ExpressionPrinter& expressions, Identifiers& locals);
  virtual ~StepWriter() = default;
  StepWriter(const StepWriter&) = delete;
  StepWriter& operator=(const StepWriter&) = delete;

  /// Elements of an output that are set by lines which differ in their place alone are set in a loop.
  void write(const std::vector<Statement>& list, std::string& text);
  /// The reset: values take their names from the block whose state they set.
  void write_reset(std::string& text) {
    in_reset_ = true;
    for (const Statement& statement : routine.reset) {
      section_ = statement.kind == Statement::Kind::Call ? statement.target : routine.cells[statement.target].node;
      write(statement, text);
    }
    in_reset_ = false;
  }

 protected:
  // What a target spells. Each of the last five writes what follows the indentation of a line.
  virtual void heading(const Node& node, std::string& text) = 0;
  virtual void begin_rate(const Rate& rate, std::string& text) = 0;
  virtual void end_rate(std::string& text) = 0;
  virtual void define(ValueId id, std::string_view name, std::string& text) = 0;
  virtual void set_output(std::uint32_t output, ValueId value, std::string& text) = 0;
  virtual void set_cell(std::uint32_t cell, ValueId value, std::string& text) = 0;
  virtual void set_element(std::uint32_t cell, ValueId index, ValueId value, std::string& text) = 0;
  virtual void fill_cell(std::uint32_t cell, ValueId value, std::string& text) = 0;
  /// Of a block that stays a block; only a target that asks for calls spells them.
  virtual void call(const Statement& /*statement*/, bool /*reset*/, std::string& /*text*/) {}
  /// The variable of an output, for values that are one.
  [[nodiscard]] virtual std::string_view output_name(std::uint32_t /*output*/) const { return {}; }
  /// A loop over the places of an array, round a line that names its place; nothing where the target has none.
  [[nodiscard]] virtual std::string_view place_name() const { return {}; }
  virtual void begin_loop(std::uint32_t /*count*/, std::string& /*text*/) {}
  virtual void end_loop(std::string& /*text*/) {}
  /// What a shared value is called that is no port and no state.
  [[nodiscard]] virtual std::string_view word_for(const Value& value) const = 0;

  /// Whether a value that stands for a whole pin or output is better called by its operation.
  [[nodiscard]] virtual bool is_taken(std::string_view /*owner*/) const { return false; }

  /// Values that are never written inside an expression, by value; empty: every value may be.
  std::vector<bool> must_be_named{};

  const Graph& graph;
  const Routine& routine;
  ExpressionPrinter& expressions;
  /// By value: the output whose variable it is from its computation on, or no_value; empty: none.
  std::vector<std::uint32_t> output_of_value{};
  [[nodiscard]] bool is_output(ValueId id) const {
    return id < output_of_value.size() && output_of_value[id] != no_value;
  }
  std::string_view indentation = "  ";
  std::string_view outer_indentation = "  ";  ///< outside of a rate

 private:
  void write(const Statement& statement, std::string& text);
  void write_array(const std::vector<Statement>& list, const PortGroup& group, std::size_t at, std::string& text);
  void begin_line(std::string& text);
  void write_definition(ValueId id, std::string_view name, std::string& text);
  void write_shared(ValueId root, bool with_root, std::string& text);
  [[nodiscard]] bool needs_name(ValueId id) const {
    return routine.uses[id] > 1 || (id < must_be_named.size() && must_be_named[id]);
  }
  std::string_view name_of(const Statement& definition);

  Identifiers& locals_;
  std::vector<PortGroup> arrays_;              ///< of the outputs
  std::vector<std::uint32_t> own_definition_;  ///< by value: where the step defines it by the name of a port or state
  std::uint32_t section_ = 0;                  ///< the node to which the statement at hand belongs
  bool section_begins_ = false;
  bool in_reset_ = false;
};

}  // namespace hysteron
