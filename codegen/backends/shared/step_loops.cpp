// Vectors within a step: local arrays, loops over rows, and loops over the terms of a sum.
//
// Rows are first written one by one, as texts. Those that differ in the places of arrays alone, and evenly, become a
// loop of one row; terms of a sum become a loop within it, which adds them in their order. So a loop computes what its
// rows say, to the bit, whatever they mean.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

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
  array_length_.assign(routine.step.size(), 0);
  array_is_begun_.assign(routine.step.size(), false);
  const bool has_places = has_arrays(graph.inputs) || has_arrays(graph.outputs) || routine.uses_operation(Op::At) ||
                          std::ranges::any_of(cell_groups(routine.cells), &PortGroup::is_array);
  if (!has_loops() || !has_places) {
    return;
  }
  shapes_ = ValueShapes(graph, routine, [this](ValueId id) {
    return !is_leaf(routine.tape[id].op) && (needs_name(id) || own_definition_[id] != no_value);
  });
  find_arrays();
  const bool any = shapes_.has_sums() || has_arrays(graph.outputs) ||
                   std::ranges::any_of(array_length_, [](std::uint32_t length) { return length > 0; }) ||
                   std::ranges::any_of(cell_groups(routine.cells), &PortGroup::is_array);
  if (any) {
    loops_ = loop_words();
  }
}

/// The values of a vector that a block gives, or that are to be the next of its state.
void StepWriter::find_arrays() {
  const auto definition = [&](std::size_t at) {
    const bool is = at < routine.step.size() && routine.step[at].kind == Statement::Kind::Define &&
                    routine.step[at].always && own_definition_[routine.step[at].value] == at &&
                    !is_output(routine.step[at].value);
    return is ? element_of(routine.step[at].field) : std::nullopt;
  };
  for (std::size_t i = 0; i < routine.step.size(); ++i) {
    const auto begin = definition(i);
    if (!begin || begin->index != 0) {
      continue;
    }
    const Statement& first = routine.step[i];
    std::vector<ValueId> values{first.value};
    for (auto next = definition(i + values.size()); next; next = definition(i + values.size())) {
      const Statement& one = routine.step[i + values.size()];
      if (next->vector != begin->vector || next->index != static_cast<std::int64_t>(values.size()) ||
          one.target != first.target || one.what != first.what ||
          routine.tape[one.value].type != routine.tape[first.value].type) {
        break;
      }
      values.push_back(one.value);
    }
    if (shapes_.has_loop(values) && are_independent(values, first.target)) {
      array_length_[i] = static_cast<std::uint32_t>(values.size());
      std::fill_n(array_of_.begin() + static_cast<std::ptrdiff_t>(i), values.size(), static_cast<std::uint32_t>(i));
    }
    i += values.size() - 1;
  }
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
  if (first.kind == Statement::Kind::Define) {
    const std::uint32_t own = first.always ? own_definition_[first.value] : no_value;
    return own == no_value ? 1 : std::max<std::size_t>(array_length_[own], 1);
  }
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
  if (list.front().kind == Statement::Kind::Define) {
    return write_array(own_definition_[list.front().value], text);
  }
  std::vector<Row> rows;
  for (const Statement& one : list) {
    rows.push_back({.value = one.value, .statement = &one});
  }
  write_rows(rows, text);
}

// --- local arrays ---

void StepWriter::write_array(std::size_t first_statement, std::string& text) {
  if (array_is_begun_[first_statement]) {
    return;
  }
  array_is_begun_[first_statement] = true;
  std::vector<ValueId> values;
  for (std::size_t i = 0; i < array_length_[first_statement]; ++i) {
    values.push_back(routine.step[first_statement + i].value);
  }
  const Statement& first = routine.step[first_statement];
  write_elements(values, locals_.make({graph.nodes[first.target].owner(), element_of(first.field)->vector, first.what}),
                 text);
}

void StepWriter::write_elements(std::span<const ValueId> values, std::string_view name, std::string& text) {
  const auto elements = declare_elements(name, routine.tape[values.front()].type, values.size(), text);
  std::vector<Row> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    rows.push_back({.value = values[i], .element = elements[i]});
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
void StepWriter::for_operands(ValueId sum, Use use) const {
  const std::vector<ValueId> terms = shapes_.terms(routine, sum);
  for (std::size_t i = 0; i < terms.size();) {
    const auto run = std::span(terms).subspan(i, shapes_.terms_alike_from(std::span(terms).subspan(i)));
    i += run.size();
    if (run.size() < shortest_loop) {
      continue;
    }
    use(run);
    std::vector<ValueId> operands(run.size());
    for (std::size_t arg = 0; arg < info(routine.tape[run.front()].op).arity; ++arg) {
      std::ranges::transform(run, operands.begin(), [&](ValueId id) { return routine.tape[id].args[arg]; });
      use(std::span<const ValueId>(operands));
    }
  }
}

void StepWriter::write_operands_of(ValueId sum, std::string& text) {
  for_operands(sum, [&](std::span<const ValueId> operands) { write_operands(operands, text); });
}

/// Values that have no name yet, and need one, become an array.
void StepWriter::write_operands(std::span<const ValueId> values, std::string& text) {
  const auto is_new = [&](ValueId id) {
    return !is_leaf(routine.tape[id].op) && !expressions.is_named(id) && needs_name(id) &&
           own_definition_[id] == no_value && !is_output(id) && !held_back_[id] &&
           routine.tape[id].type == routine.tape[values.front()].type;
  };
  if (std::ranges::all_of(values, is_new) && are_independent(values, section_)) {
    write_elements(values, locals_.make({graph.nodes[section_].owner(), word_for(routine.tape[values.front()])}), text);
  }
}

/// Values that have names of their own are copied into an array: a loop over rows reads each of them once a row.
void StepWriter::gather_operands(std::span<const ValueId> values,
                                 std::vector<std::pair<ValueId, std::uint32_t>>& called, std::string& text) {
  std::vector<std::string> names(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if ((!expressions.is_named(values[i]) && !is_leaf(routine.tape[values[i]].op)) ||
        is_literal(routine.tape[values[i]].op)) {
      return;
    }
    expressions.print(values[i], names[i]);
  }
  if (std::unordered_set<ValueId>(values.begin(), values.end()).size() != values.size() || runs_of(names).size() == 1) {
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

void StepWriter::write_rows(std::vector<Row>& rows, std::string& text) {
  for (Row& row : rows) {
    row.sum = sum_within(row.value, row.statement == nullptr);
    if (row.sum != no_value) {
      held_back_[row.sum] = true;
    }
  }
  for (const Row& row : rows) {
    write_shared(row.value, row.statement != nullptr, text);
  }
  std::vector<std::pair<ValueId, std::uint32_t>> called;
  if (rows.size() >= shortest_loop) {
    for (const Row& row : rows) {
      if (row.sum != no_value) {
        for_operands(row.sum, [&](std::span<const ValueId> operands) { gather_operands(operands, called, text); });
      }
    }
  }
  std::vector<RowText> texts;
  for (const Row& row : rows) {
    texts.push_back(text_of(row));
  }
  for (std::size_t i = 0; i < rows.size();) {
    const RowLoop loop = loop_from(std::span(texts).subspan(i));
    if (loop.count >= shortest_loop) {
      write_loop(loop, text);
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

/// A row that shares no loop.
void StepWriter::write_row(const Row& row, std::string& text) {
  if (row.sum != no_value && !expressions.is_named(row.sum)) {
    write_definition(row.sum, locals_.make({graph.nodes[section_].owner(), word_for(routine.tape[row.sum])}), text);
  }
  write_line(row, text);
}

void StepWriter::write_line(const Row& row, std::string& text) {
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
    expressions.name(row.sum, loops_->sum);
  }
  const std::string_view outside = indentation;
  const bool begins = section_begins_;
  indentation = texts_.emplace_back(std::string(outside) + "  ");
  section_begins_ = false;  // its heading stands before the loop
  write_line(row, made.line);
  section_begins_ = begins;
  indentation = outside;
  if (row.sum != no_value) {
    expressions.unname(row.sum);
  }
  return made;
}

// --- loops ---

std::vector<std::string> StepWriter::terms_of(ValueId sum) const {
  std::vector<std::string> texts;
  for (const ValueId term : shapes_.terms(routine, sum)) {
    expressions.print_added(term, texts.emplace_back());
  }
  return texts;
}

std::vector<StepWriter::TermRun> StepWriter::runs_of(const std::vector<std::string>& terms) {
  std::vector<TermRun> runs;
  for (std::size_t i = 0; i < terms.size();) {
    TermRun run{.pattern = PlacePattern(terms[i]), .first = i};
    while (i + run.count < terms.size() && run.pattern.takes(terms[i + run.count], 0, run.count)) {
      ++run.count;
    }
    run.count = run.count < shortest_loop ? 1 : run.count;
    i += run.count;
    runs.push_back(std::move(run));
  }
  return runs;
}

StepWriter::RowLoop StepWriter::loop_from(std::span<const RowText> rows) {
  RowLoop loop{.line = PlacePattern(rows.front().line), .terms = runs_of(rows.front().terms), .count = 1};
  const auto fits = [&](const RowText& row, std::size_t at) {
    return row.terms.size() == rows.front().terms.size() && loop.line.takes(row.line, at, 0) &&
           std::ranges::all_of(loop.terms, [&](TermRun& run) {
             for (std::size_t i = 0; i < run.count; ++i) {
               if (!run.pattern.takes(row.terms[run.first + i], at, i)) {
                 return false;
               }
             }
             return true;
           });
  };
  while (loop.count < rows.size() && fits(rows[loop.count], loop.count)) {
    ++loop.count;
  }
  return loop;
}

void StepWriter::write_loop(const RowLoop& loop, std::string& text) {
  PlaceWords words = loops_->places;
  words.column = {};
  begin_line(text);
  begin_loop(words.row, 0, loop.count, text);
  const std::string_view outside = indentation;
  indentation = texts_.emplace_back(std::string(outside) + "  ");
  if (!loop.terms.empty()) {
    write_sum(loops_->sum, false, loop.terms, words.row, text);
  }
  text += loop.line.text(words);
  indentation = outside;
  text += indentation;
  end_loop(text);
}

namespace {

/// A text without the brackets that stand round the whole of it.
std::string_view without_brackets(std::string_view text) {
  if (!text.starts_with('(')) {
    return text;
  }
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (depth == 0 && i + 1 < text.size()) {
      return text;
    }
  }
  return text.substr(1, text.size() - 2);
}

}  // namespace

/// A variable becomes a sum from the left.
void StepWriter::write_sum(std::string_view name, bool is_known, const std::vector<TermRun>& runs, std::string_view row,
                           std::string& text) {
  PlaceWords first = loops_->places;
  first.row = row;
  first.column = {};
  PlaceWords each = first;
  each.column = loops_->places.column;
  std::string variable;
  print_variable(name, variable);

  begin_line(text);
  begin_variable(name, is_known, text);
  const std::string begin = runs.front().pattern.text(first);
  const bool stands_alone = runs.size() == 1 || runs[0].count > 1 || runs[1].count > 1;
  append(text, loops_->assign, stands_alone ? without_brackets(begin) : begin);
  bool line_is_open = true;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].count == 1) {
      if (i > 0) {
        if (!line_is_open) {
          append(text, indentation, variable, loops_->assign, variable);
          line_is_open = true;
        }
        append(text, " + ", runs[i].pattern.text(first));
      }
      continue;
    }
    text += line_is_open ? ";\n" : "";
    line_is_open = false;
    text += indentation;
    begin_loop(each.column, i == 0 ? 1 : 0, runs[i].count, text);
    append(text, indentation, "  ", variable, loops_->assign, variable, " + ", runs[i].pattern.text(each), ";\n",
           indentation);
    end_loop(text);
  }
  text += line_is_open ? ";\n" : "";
}

}  // namespace hysteron
