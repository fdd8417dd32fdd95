// Vectors within a step: local arrays, loops over rows, and loops over the terms of a sum.
//
// Rows are first written one by one, as texts. Those that differ in the places of arrays alone, and evenly, become a
// loop of one row; terms of a sum become a loop within it, which adds them in their order. So a loop computes what its
// rows say, to the bit, whatever they mean.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/shared/step_writer.hpp"
#include "support/element_name.hpp"

namespace hysteron {

void StepWriter::prepare_loops() {
  if (loops_are_prepared_) {
    return;
  }
  loops_are_prepared_ = true;
  held_back_.assign(routine.tape.size(), false);
  array_of_.assign(routine.step.size(), no_array);
  family_of_.assign(routine.tape.size(), no_array);
  const bool has_places = has_arrays(graph.inputs) || has_arrays(graph.outputs) || routine.uses_operation(Op::At) ||
                          std::ranges::any_of(cell_groups(routine.cells), &PortGroup::is_array);
  if (!has_loops() || !has_places) {
    return;
  }
  find_elements_in_place();
  find_shapes();
  find_families();
  find_arrays();
  const bool any = shapes_.has_sums() || has_arrays(graph.outputs) ||
                   std::ranges::any_of(arrays_, [](const LocalArray& one) { return !one.values.empty(); }) ||
                   std::ranges::any_of(cell_groups(routine.cells), &PortGroup::is_array);
  if (any) {
    loops_ = loop_words();
  }
}

void StepWriter::find_shapes() {
  std::vector<bool> in_array(routine.tape.size(), false);
  for (const LocalArray& array : arrays_) {
    for (const ValueId id : array.values) {
      in_array[id] = true;
    }
  }
  shapes_ = {};
  shapes_ = ValueShapes(graph, routine, in_array, [this](ValueId id) { return has_name(id); });
}

namespace {

/// The elements of vectors that a diagram works out, by the operation that gives each: of those that the text has in
/// one place, the one that no other of them takes.
std::unordered_map<std::uint32_t, ElementName> elements_by_operation(const Graph& graph) {
  std::unordered_map<std::uint32_t, ElementName> elements;
  for (std::uint32_t i = 0; i < graph.nodes.size(); ++i) {
    const auto element = graph.nodes[i].block == nullptr ? element_of(graph.nodes[i].owner()) : std::nullopt;
    if (element) {
      elements.emplace(i, *element);
    }
  }
  for (const Node& node : graph.nodes) {
    for (std::uint32_t pin = 0; node.block == nullptr && pin < node.wire_count; ++pin) {
      const Wire& wire = graph.wire(node, pin);
      if (wire.from == Wire::From::Node && graph.nodes[wire.index].block == nullptr &&
          graph.nodes[wire.index].owner() == node.owner()) {
        elements.erase(wire.index);
      }
    }
  }
  return elements;
}

}  // namespace

void StepWriter::find_arrays() {
  for (std::size_t i = 0; i < routine.step.size();) {
    const std::vector<std::uint32_t> statements = elements_of_block(i);
    keep_array(statements, {});
    i += std::max<std::size_t>(statements.size(), 1);
  }
  const auto variables = elements_by_operation(graph);
  for (std::size_t i = 0; i < routine.step.size() && !variables.empty(); ++i) {
    if (const std::vector<std::uint32_t> statements = elements_of_variable(i, variables); !statements.empty()) {
      keep_array(statements, variables.at(routine.step[i].target).vector);
    }
  }
}

/// The statements that define a vector which a block gives, or which is to be the next of its state, from one on.
std::vector<std::uint32_t> StepWriter::elements_of_block(std::size_t begin) const {
  std::vector<std::uint32_t> statements;
  for (std::size_t at = begin; at < routine.step.size(); ++at) {
    const Statement& first = routine.step[begin];
    const Statement& one = routine.step[at];
    const bool is = one.kind == Statement::Kind::Define && one.always && own_definition_[one.value] == at &&
                    !is_output(one.value) && one.target == first.target && one.what == first.what;
    const auto element = is ? element_of(one.field) : std::nullopt;
    if (!element || element->vector != element_of(first.field)->vector ||
        element->index != static_cast<std::int64_t>(statements.size())) {
      break;
    }
    statements.push_back(static_cast<std::uint32_t>(at));
  }
  return statements;
}

/// The same of a vector that a diagram works out, V := A + B. Other operations may stand between its elements; what is
/// set there may not, since elements behind it may read it.
std::vector<std::uint32_t> StepWriter::elements_of_variable(
    std::size_t begin, const std::unordered_map<std::uint32_t, ElementName>& variables) const {
  const auto element = [&](const Statement& one) {
    const auto found = variables.find(one.target);
    const bool is = one.kind == Statement::Kind::Define && !one.always && found != variables.end() &&
                    needs_name(one.value) && own_definition_[one.value] == no_value && !is_output(one.value);
    return is ? std::optional(found->second) : std::nullopt;
  };
  const auto first = element(routine.step[begin]);
  std::vector<std::uint32_t> statements;
  for (std::size_t at = begin; first && at < routine.step.size(); ++at) {
    const Statement& one = routine.step[at];
    const bool passes = (one.kind == Statement::Kind::Section || one.kind == Statement::Kind::Define) &&
                        graph.nodes[one.target].block == nullptr;
    if (!passes) {
      break;
    }
    const auto next = element(one);
    if (next && next->vector == first->vector && next->index == static_cast<std::int64_t>(statements.size())) {
      statements.push_back(static_cast<std::uint32_t>(at));
    }
  }
  return statements;
}

/// `variable`: what a diagram calls it; empty for a block's.
void StepWriter::keep_array(const std::vector<std::uint32_t>& statements, std::string_view variable) {
  LocalArray array{.variable = variable};
  for (const std::uint32_t at : statements) {
    array.values.push_back(routine.step[at].value);
  }
  const auto type = [&](ValueId id) { return routine.tape[id].type; };
  if (statements.size() < shortest_loop || !shapes_.has_loop(array.values) ||
      std::ranges::any_of(array.values, [&](ValueId id) { return type(id) != type(array.values.front()); }) ||
      !are_independent(array.values, routine.step[statements.front()].target)) {
    return;
  }
  array.first = statements.front();
  for (const std::uint32_t at : statements) {
    array_of_[at] = static_cast<std::uint32_t>(arrays_.size());
    own_definition_[routine.step[at].value] = at;
  }
  arrays_.push_back(std::move(array));
}

/// Whether none of some values of a node needs another of them. What another node gives was written before.
bool StepWriter::are_independent(std::span<const ValueId> values, std::uint32_t node) const {
  const std::unordered_set<ValueId> wanted(values.begin(), values.end());
  std::unordered_set<ValueId> seen;
  std::vector<ValueId> stack(values.begin(), values.end());
  while (!stack.empty()) {
    const ValueId id = stack.back();
    stack.pop_back();
    for (const ValueId arg : routine.tape[id].args) {
      if (arg == no_value || expressions.is_named(arg) || !seen.insert(arg).second) {
        continue;
      }
      if (wanted.contains(arg)) {
        return false;
      }
      const std::uint32_t own = own_definition_[arg];
      if (own == no_value || routine.step[own].target == node) {
        stack.push_back(arg);
      }
    }
  }
  return wanted.size() == values.size();
}

/// How many statements from the first on set the elements of one vector.
std::size_t StepWriter::rows_from(std::span<const Statement> list) const {
  const Statement& first = list.front();
  if (first.kind != Statement::Kind::SetCell && first.kind != Statement::Kind::SetOutput) {
    return 1;
  }
  const auto element = [&](const Statement& one) {
    return element_of(one.kind == Statement::Kind::SetCell ? routine.cells[one.target].field.name
                                                           : std::string_view(graph.outputs[one.target].name));
  };
  const auto begin = element(first);
  std::size_t count = 1;
  for (; begin && count < list.size() && list[count].kind == first.kind; ++count) {
    const Statement& one = list[count];
    const bool follows = one.target == first.target + count && !is_output(one.value);
    const auto next = follows ? element(one) : std::nullopt;
    const bool same_node =
        first.kind == Statement::Kind::SetOutput || routine.cells[one.target].node == routine.cells[first.target].node;
    if (!next || next->vector != begin->vector || !same_node) {
      break;
    }
  }
  return is_output(first.value) ? 1 : count;
}

void StepWriter::write_group(std::span<const Statement> list, std::string& text) {
  std::vector<Row> rows;
  for (const Statement& one : list) {
    rows.push_back({.value = one.value, .statement = &one});
  }
  write_rows(rows, text);
}

// --- local arrays ---

void StepWriter::write_array(LocalArray& array, std::string& text) {
  if (std::exchange(array.is_begun, true)) {
    return;
  }
  if (array.first == no_value) {
    const std::string_view family =
        locals_.make({graph.nodes[section_].owner(), word_for(routine.tape[array.values[array.values.size() - 1]])});
    return write_elements(array.values, family, array.reads_last, text);
  }
  const Statement& first = routine.step[array.first];
  const std::string_view owner = graph.nodes[first.target].owner();
  const std::string_view name = first.field.empty()
                                    ? locals_.make({array.variable})
                                    : locals_.make({owner, element_of(first.field)->vector, first.what});
  write_elements(array.values, name, false, text);
}

void StepWriter::write_elements(std::span<const ValueId> values, std::string_view name, bool reads_last,
                                std::string& text) {
  const auto elements = declare_elements(name, routine.tape[values.front()].type, values.size(), text);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    rows.push_back({.value = values[i], .element = elements[i], .reads_last = reads_last});
    if (reads_last) {
      expressions.name(values[i], elements[i]);
    }
  }
  write_rows(rows, text);
  for (std::size_t i = 0; i < values.size(); ++i) {
    expressions.name(values[i], elements[i]);
  }
}

std::vector<std::string_view> StepWriter::declare_elements(std::string_view name, Type type, std::size_t count,
                                                           std::string& text) {
  begin_section(text);
  declare_array(name, type, count, text);
  std::vector<std::string_view> elements;
  for (std::size_t i = 0; i < count; ++i) {
    elements.push_back(texts_.emplace_back(element_name(name, static_cast<std::int64_t>(i))));
  }
  return elements;
}

// --- operands of sums ---

template <class Use>
void StepWriter::for_operands(ValueId sum, std::size_t shortest, Use use) const {
  const std::vector<ValueShapes::Term> terms = shapes_.terms(routine, sum);
  for (std::size_t i = 0; i < terms.size();) {
    const std::size_t alike = shapes_.terms_alike_from(std::span(terms).subspan(i));
    std::vector<ValueId> run(alike);
    std::ranges::transform(std::span(terms).subspan(i, alike), run.begin(), &ValueShapes::Term::value);
    i += alike;
    if (run.size() < shortest) {
      continue;
    }
    use(std::span<const ValueId>(run));
    std::vector<ValueId> operands(run.size());
    for (std::size_t arg = 0; arg < info(routine.tape[run.front()].op).arity; ++arg) {
      std::ranges::transform(run, operands.begin(), [&](ValueId id) { return routine.tape[id].args[arg]; });
      use(std::span<const ValueId>(operands));
    }
  }
}

void StepWriter::write_operands_of(ValueId sum, std::string& text) {
  for_operands(sum, shortest_loop, [&](std::span<const ValueId> operands) { write_operands(operands, text); });
}

/// Values that have no name yet, and need one, become an array.
void StepWriter::write_operands(std::span<const ValueId> values, std::string& text) {
  const auto is_new = [&](ValueId id) {
    return !is_leaf(routine.tape[id].op) && !expressions.is_named(id) && needs_name(id) &&
           own_definition_[id] == no_value && family_of_[id] == no_array && !is_output(id) && !held_back_[id] &&
           routine.tape[id].type == routine.tape[values.front()].type;
  };
  if (std::ranges::all_of(values, is_new) && are_independent(values, section_)) {
    write_elements(values, locals_.make({graph.nodes[section_].owner(), word_for(routine.tape[values.front()])}), false,
                   text);
  }
}

/// Values that have names of their own are copied into an array: a loop over rows reads each of them once a row.
void StepWriter::gather_operands(std::span<const ValueId> values,
                                 std::vector<std::pair<ValueId, std::uint32_t>>& called, std::string& text) {
  std::vector<TermText> names(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if ((!expressions.is_named(values[i]) && !is_leaf(routine.tape[values[i]].op)) ||
        is_literal(routine.tape[values[i]].op)) {
      return;
    }
    expressions.print(values[i], names[i].text);
  }
  if (std::unordered_set<ValueId>(values.begin(), values.end()).size() != values.size() ||
      runs_of(names, shortest_loop).size() == 1) {
    return;
  }
  const Type type = routine.tape[values.front()].type;
  const auto elements =
      declare_elements(locals_.make({graph.nodes[section_].owner(), "vector"}), type, values.size(), text);
  for (std::size_t i = 0; i < values.size(); ++i) {
    write_line({.value = values[i], .element = elements[i]}, text);
    called.emplace_back(values[i], expressions.called(values[i]));
    expressions.name(values[i], elements[i]);
  }
}

// --- rows ---

/// A long sum that is written within a value; of the value itself only where `whole` says so.
ValueId StepWriter::sum_within(ValueId root, bool whole) const {
  std::vector<ValueId> stack{root};
  while (!stack.empty()) {
    const ValueId id = stack.back();
    stack.pop_back();
    const bool is_root = id == root;
    const bool must = id < must_be_named.size() && must_be_named[id];
    if (is_leaf(routine.tape[id].op) ||
        (!(is_root && whole) && (expressions.is_named(id) || must || routine.uses[id] > 1))) {
      continue;
    }
    if (shapes_.is_sum(id)) {
      return id;
    }
    std::ranges::copy_if(routine.tape[id].args, std::back_inserter(stack), [](ValueId arg) { return arg != no_value; });
  }
  return no_value;
}

/// While a row is written that others read, its value has no name.
class StepWriter::Opened {
 public:
  Opened(ExpressionPrinter& expressions, const Row& row)
      : expressions_(expressions), row_(row), called_(expressions.called(row.value)) {
    if (row_.reads_last) {
      expressions_.unname(row_.value);
    }
  }
  ~Opened() {
    if (row_.reads_last) {
      expressions_.call_again(row_.value, called_);
    }
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

 private:
  ExpressionPrinter& expressions_;
  const Row& row_;
  std::uint32_t called_;
};

void StepWriter::write_rows(std::vector<Row>& rows, std::string& text) {
  for (Row& row : rows) {
    row.sum = sum_within(row.value, row.statement == nullptr);
    if (row.sum != no_value) {
      held_back_[row.sum] = true;
    }
  }
  for (const Row& row : rows) {
    const Opened opened(expressions, row);
    write_shared(row.value, row.statement != nullptr, text);
  }
  std::vector<std::pair<ValueId, std::uint32_t>> called;
  if (rows.size() >= shortest_loop) {
    for (const Row& row : rows) {
      if (row.sum != no_value) {
        for_operands(row.sum, shortest_sum(),
                     [&](std::span<const ValueId> operands) { gather_operands(operands, called, text); });
      }
    }
  }
  std::vector<RowText> texts;
  texts.reserve(rows.size());
  for (const Row& row : rows) {
    texts.push_back(text_of(row));
  }
  for (std::size_t i = 0; i < rows.size();) {
    const RowLoop loop = loop_from(std::span(texts).subspan(i));
    if (loop.count >= shortest_loop && !is_written_out(std::span(rows).subspan(i, loop.count))) {
      write_loop(loop, std::span(rows).subspan(i, loop.count), text);
      i += loop.count;
    } else {
      write_row(rows[i++], text);
    }
  }
  for (const auto& [id, before] : called) {
    expressions.call_again(id, before);
  }
  for (const Row& row : rows) {
    if (row.sum != no_value) {
      held_back_[row.sum] = false;
    }
  }
}

/// Whether rows are copies of a few variables. As a loop a compiler makes one wide copy of them, which waits for each
/// narrow write before it.
bool StepWriter::is_written_out(std::span<const Row> rows) const {
  return loops_->several_at_once && !rows.front().reads_last && rows.size() < shortest_sum() &&
         std::ranges::all_of(rows, [&](const Row& row) {
           const Op op = routine.tape[row.value].op;
           return (is_leaf(op) && !is_literal(op)) || expressions.is_named(row.value);
         });
}

std::string_view StepWriter::name_of_sum(const Row& row) {
  return locals_.make({graph.nodes[section_].owner(), word_for(routine.tape[row.sum])});
}

/// A row that shares no loop.
void StepWriter::write_row(const Row& row, std::string& text) {
  if (row.sum != no_value && !expressions.is_named(row.sum) && has_loop(runs_of(terms_of(row.sum), shortest_sum()))) {
    write_definition(row.sum, name_of_sum(row), text);
  }
  write_line(row, text);
}

void StepWriter::write_line(const Row& row, std::string& text) {
  const Opened opened(expressions, row);
  begin_line(text);
  if (row.statement == nullptr) {
    set_local(row.element, row.value, text);
  } else if (row.statement->kind == Statement::Kind::SetOutput) {
    set_output(row.statement->target, row.value, text);
  } else {
    set_cell(row.statement->target, row.value, text);
  }
}

StepWriter::RowText StepWriter::text_of(const Row& row) {
  RowText made;
  if (row.sum != no_value) {
    made.terms = terms_of(row.sum);
    expressions.name(row.sum, PlacePattern::sum);
  }
  const std::string_view outside = indentation;
  const bool begins = section_begins_;
  indentation = {};
  section_begins_ = false;  // its heading stands before the loop
  write_line(row, made.line);
  section_begins_ = begins;
  indentation = outside;
  if (row.sum != no_value) {
    expressions.unname(row.sum);
  }
  return made;
}

}  // namespace hysteron
