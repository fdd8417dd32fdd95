// The statements of a step as text: which values get a name, in which order, under which block's heading. A target
// spells the single lines.
//
// A value that is used once is written where it is used. A value that is used more often, and one that a target cannot
// write inside an expression, gets a name before its first use. The elements of a vector are one array, and what their
// lines have in common is a loop (step_loops.cpp, step_families.cpp, row_loops.cpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "codegen/backends/shared/expression_printer.hpp"
#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/shared/place_pattern.hpp"
#include "codegen/backends/shared/port_groups.hpp"
#include "codegen/backends/shared/routine.hpp"
#include "codegen/backends/shared/value_shapes.hpp"
#include "support/element_name.hpp"

namespace hysteron {

/// How a target writes loops.
struct LoopWords {
  PlaceWords places{};  ///< the variables that count rows, and terms of a sum
  /// Variables of the sums within a loop: one, or one for each of the rows that are computed at once.
  std::vector<std::string_view> sums{};
  std::string_view assign{};     ///< between a variable and its value
  bool several_at_once = false;  ///< for processors that add while they wait for another sum
};

class StepWriter {
 public:
  /// `locals` gives the names of values; the words that they may not be are in it.
  StepWriter(const Graph& graph, const Routine& routine, ExpressionPrinter& expressions, Identifiers& locals);
  virtual ~StepWriter() = default;
  StepWriter(const StepWriter&) = delete;
  StepWriter& operator=(const StepWriter&) = delete;

  /// Statements in their order. Rows that differ in the places of arrays alone are a loop.
  void write(const std::vector<Statement>& list, std::string& text) { write_list(list, false, text); }
  /// The reset: values take their names from the block whose state they set.
  void write_reset(std::string& text) { write_list(routine.reset, true, text); }

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
  [[nodiscard]] virtual bool has_loops() const { return false; }
  /// Asked for once, where there is something to loop over.
  [[nodiscard]] virtual LoopWords loop_words() { return {}; }
  /// From place `first` to before place `end`.
  virtual void begin_loop(std::string_view /*place*/, std::size_t /*first*/, std::size_t /*end*/, std::size_t /*step*/,
                          std::string& /*text*/) {}
  virtual void end_loop(std::string& /*text*/) {}
  /// The line that declares a local array, with its indentation; nothing where declarations stand elsewhere.
  virtual void declare_array(std::string_view /*name*/, Type /*type*/, std::size_t /*length*/, std::string& /*text*/) {}
  struct SumVariable {
    bool is_known = false;  ///< declared before
    bool changes = false;   ///< assigned again after the first time
  };
  /// The variable of a sum, of type LREAL, as its first assignment writes it.
  virtual void begin_variable(std::string_view /*name*/, SumVariable /*variable*/, std::string& /*text*/) {}
  virtual void print_variable(std::string_view name, std::string& text) const { text += name; }
  /// An element of a local array gets its value.
  virtual void set_local(std::string_view /*element*/, ValueId /*value*/, std::string& /*text*/) {}
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
  /// By value: the cell that it becomes, whose name it then has; empty: none.
  std::vector<std::uint32_t> cell_of_value{};
  [[nodiscard]] bool is_output(ValueId id) const {
    return id < output_of_value.size() && output_of_value[id] != no_value;
  }
  std::string_view indentation = "  ";
  std::string_view outer_indentation = "  ";  ///< outside of a rate

 private:
  void write_list(const std::vector<Statement>& list, bool reset, std::string& text);
  void write(const Statement& statement, std::string& text);
  void begin_section(std::string& text);
  void begin_line(std::string& text);
  void write_definition(ValueId id, std::string_view name, std::string& text);
  void write_shared(ValueId root, bool with_root, std::string& text);
  [[nodiscard]] bool needs_name(ValueId id) const {
    return (routine.uses[id] > 1 && !is_written_in_place(id)) || (id < must_be_named.size() && must_be_named[id]) ||
           shapes_.is_sum(id);
  }
  [[nodiscard]] bool has_name(ValueId id) const {
    return !is_leaf(routine.tape[id].op) && (needs_name(id) || own_definition_[id] != no_value);
  }
  [[nodiscard]] bool is_written_in_place(ValueId id) const { return id < in_place_.size() && in_place_[id]; }
  void find_elements_in_place();

  // --- loops ---

  /// A line that sets a variable to a value, and what becomes of it.
  struct Row {
    ValueId value = no_value;
    ValueId sum = no_value;  ///< a long sum within the value
    const Statement* statement = nullptr;
    std::string_view element{};  ///< of a local array; empty: what the statement sets
    bool reads_last = false;     ///< the row before: rows one after the other
  };
  struct TermText {
    std::string text{};
    bool minus = false;
  };
  /// A row as text. Of its sum, the terms; its line names the sum's variable.
  struct RowText {
    std::string line{};
    std::vector<TermText> terms{};
  };
  /// Terms that follow each other and differ in their places alone; or a single one.
  struct TermRun {
    PlacePattern pattern;
    std::size_t first = 0;
    std::size_t count = 1;
    bool minus = false;  ///< they are taken off
    [[nodiscard]] std::string_view sign() const { return minus ? " - " : " + "; }
  };
  /// Rows as a loop.
  struct RowLoop {
    PlacePattern line;
    std::vector<TermRun> terms{};
    std::uint32_t count = 0;
  };
  /// A variable that becomes a sum.
  struct Sum {
    std::string_view name{};
    bool is_known = false;
    std::vector<TermRun> runs{};
  };
  /// How many rows are computed at once: the more, the less a sum waits for its own last addition. Measured in
  /// decision 48.
  static constexpr std::size_t looped_rows_at_once = 4;   ///< where terms are a loop
  static constexpr std::size_t written_rows_at_once = 2;  ///< where terms are written out
  void prepare_loops();
  /// Values that are the elements of one local array.
  struct LocalArray {
    std::vector<ValueId> values{};
    std::uint32_t first = no_value;  ///< statement of the step that defines the first element; no_value: no statement
    std::string_view variable{};     ///< of a diagram
    bool reads_last = false;         ///< each element but the first is computed from the one before
    bool is_begun = false;
  };
  void find_shapes();
  void find_arrays();
  void find_families();
  void keep_family(std::vector<ValueId> values, bool reads_last);
  void drop_families();
  [[nodiscard]] bool is_in_order(const LocalArray& array) const;
  [[nodiscard]] std::vector<std::uint32_t> elements_of_block(std::size_t begin) const;
  [[nodiscard]] std::vector<std::uint32_t> elements_of_variable(
      std::size_t begin, const std::unordered_map<std::uint32_t, ElementName>& variables) const;
  void keep_array(const std::vector<std::uint32_t>& statements, std::string_view variable);
  [[nodiscard]] bool are_independent(std::span<const ValueId> values, std::uint32_t node) const;
  [[nodiscard]] std::size_t rows_from(std::span<const Statement> list) const;
  void write_group(std::span<const Statement> list, std::string& text);
  void write_array(LocalArray& array, std::string& text);
  void write_elements(std::span<const ValueId> values, std::string_view name, bool reads_last, std::string& text);
  class Opened;
  void write_rows(std::vector<Row>& rows, std::string& text);
  [[nodiscard]] ValueId sum_within(ValueId root, bool whole) const;
  /// By operand of the terms of a sum that are alike: calls `use(operands)`.
  template <class Use>
  void for_operands(ValueId sum, std::size_t shortest, Use use) const;
  void write_operands_of(ValueId sum, std::string& text);
  void write_operands(std::span<const ValueId> values, std::string& text);
  void gather_operands(std::span<const ValueId> values, std::vector<std::pair<ValueId, std::uint32_t>>& called,
                       std::string& text);
  [[nodiscard]] bool is_written_out(std::span<const Row> rows) const;
  std::string_view name_of_sum(const Row& row);
  void write_row(const Row& row, std::string& text);
  void write_line(const Row& row, std::string& text);
  [[nodiscard]] RowText text_of(const Row& row);
  /// Terms of at least this many that are alike become a loop.
  [[nodiscard]] std::size_t shortest_sum() const {
    return loops_->several_at_once ? shortest_sum_at_once : shortest_loop;
  }
  [[nodiscard]] static std::vector<TermRun> runs_of(const std::vector<TermText>& terms, std::size_t shortest);
  [[nodiscard]] static bool has_loop(const std::vector<TermRun>& runs) {
    return std::ranges::any_of(runs, [](const TermRun& run) { return run.count > 1; });
  }
  [[nodiscard]] RowLoop loop_from(std::span<const RowText> rows) const;
  [[nodiscard]] std::size_t rows_at_once(const RowLoop& loop) const;
  void write_loop(const RowLoop& loop, std::span<const Row> rows, std::string& text);
  void write_block(const RowLoop& loop, std::size_t first, std::span<const std::string_view> sums, std::string_view row,
                   std::string& text);
  void write_sums(std::span<const Sum> sums, std::string_view row, std::string& text);
  [[nodiscard]] std::vector<TermText> terms_of(ValueId sum) const;
  [[nodiscard]] std::vector<std::string_view> declare_elements(std::string_view name, Type type, std::size_t count,
                                                               std::string& text);

  std::string_view name_of(const Statement& definition);
  std::string_view name_of(ValueId shared);

  Identifiers& locals_;
  std::vector<std::uint32_t> own_definition_;  ///< by value: where the step defines it by the name of a port or state
  std::uint32_t section_ = 0;                  ///< the node to which the statement at hand belongs
  bool section_begins_ = false;
  bool in_reset_ = false;

  bool loops_are_prepared_ = false;
  std::vector<bool> in_place_;  ///< by value: an element of a parameter that a loop reads where it is
  std::optional<LoopWords> loops_;
  ValueShapes shapes_;
  static constexpr std::uint32_t no_array = no_value;
  std::vector<LocalArray> arrays_;
  std::vector<std::uint32_t> array_of_;   ///< by statement of the step: its place in arrays_, or no_array
  std::vector<std::uint32_t> family_of_;  ///< by value: the same, where no statement defines it
  std::vector<bool> held_back_;           ///< by value: the sum of a row, which is written with its row
  std::deque<std::string> texts_;         ///< names of elements, and indentations
};

}  // namespace hysteron
