#include "codegen/backends/shared/step_writer.hpp"

#include <algorithm>

#include "codegen/backends/shared/generated_file.hpp"

namespace hysteron {

StepWriter::StepWriter(const Graph& the_graph, const Routine& the_routine, ExpressionPrinter& the_expressions,
                       Identifiers& locals)
    : graph(the_graph), routine(the_routine), expressions(the_expressions), locals_(locals) {
  own_definition_.assign(routine.tape.size(), no_value);
  for (std::uint32_t i = 0; i < routine.step.size(); ++i) {
    const Statement& one = routine.step[i];
    if (one.kind == Statement::Kind::Define && one.always && own_definition_[one.value] == no_value) {
      own_definition_[one.value] = i;
    }
  }
}

void StepWriter::write_list(const std::vector<Statement>& list, bool reset, std::string& text) {
  prepare_loops();
  in_reset_ = reset;
  for (std::size_t i = 0; i < list.size();) {
    if (reset) {
      section_ = list[i].kind == Statement::Kind::Call ? list[i].target : routine.cells[list[i].target].node;
    }
    const std::size_t rows = loops_ ? rows_from(std::span(list).subspan(i)) : 1;
    if (rows >= shortest_loop) {
      write_group(std::span(list).subspan(i, rows), text);
      i += rows;
    } else {
      write(list[i++], text);
    }
  }
  in_reset_ = false;
}

void StepWriter::write(const Statement& statement, std::string& text) {
  switch (statement.kind) {
    case Statement::Kind::Section:
      section_ = statement.target;
      section_begins_ = graph.nodes[section_].block != nullptr;
      return;
    case Statement::Kind::BeginRate:
      text += indentation;
      begin_rate(statement.rate, text);
      indentation = "    ";
      return;
    case Statement::Kind::EndRate:
      indentation = outer_indentation;
      text += indentation;
      return end_rate(text);
    case Statement::Kind::Define:
      if (const std::uint32_t own = own_definition_[statement.value];
          loops_ && own != no_value && array_of_[own] != no_array) {
        return write_array(arrays_[array_of_[own]], text);
      }
      if ((statement.always || needs_name(statement.value)) && !expressions.is_named(statement.value)) {
        write_shared(statement.value, false, text);
        write_definition(statement.value, name_of(statement), text);
      }
      return;
    case Statement::Kind::Call:
      for (std::uint32_t i = 0; i < statement.argument_count; ++i) {
        write_shared(routine.arguments[statement.first_argument + i].value, true, text);
      }
      begin_line(text);
      return call(statement, in_reset_, text);
    case Statement::Kind::SetOutput:
      if (is_output(statement.value) && output_of_value[statement.value] == statement.target &&
          expressions.is_named(statement.value)) {
        return;
      }
      break;
    default:
      break;
  }
  write_shared(statement.value, true, text);
  if (statement.index != no_value) {
    write_shared(statement.index, true, text);
  }
  begin_line(text);
  if (statement.kind == Statement::Kind::SetOutput) {
    set_output(statement.target, statement.value, text);
  } else if (statement.kind == Statement::Kind::SetCell) {
    set_cell(statement.target, statement.value, text);
  } else if (statement.index != no_value) {
    set_element(statement.target, statement.index, statement.value, text);
  } else {
    fill_cell(statement.target, statement.value, text);
  }
}

/// The first line of a block stands behind its name.
void StepWriter::begin_section(std::string& text) {
  if (section_begins_) {
    heading(graph.nodes[section_], text);
    section_begins_ = false;
  }
}

void StepWriter::begin_line(std::string& text) {
  begin_section(text);
  text += indentation;
}

void StepWriter::write_definition(ValueId id, std::string_view name, std::string& text) {
  const std::vector<TermRun> runs =
      shapes_.is_sum(id) && loops_ ? runs_of(terms_of(id), shortest_sum()) : std::vector<TermRun>();
  if (has_loop(runs)) {
    write_sums(std::vector{Sum{.name = name, .is_known = is_output(id), .runs = runs}}, {}, text);
  } else {
    begin_line(text);
    define(id, name, text);
  }
  expressions.name(id, name);
}

std::string_view StepWriter::name_of(const Statement& definition) {
  if (is_output(definition.value)) {
    return output_name(output_of_value[definition.value]);
  }
  const std::string_view owner = graph.nodes[definition.target].owner();
  if (definition.field.empty() && is_taken(owner)) {
    return locals_.make({owner, word_for(routine.tape[definition.value])});
  }
  return locals_.make({owner, definition.field, definition.what});
}

/// Of a value that no statement of the step defines.
std::string_view StepWriter::name_of(ValueId shared) {
  if (is_output(shared)) {
    return output_name(output_of_value[shared]);
  }
  if (shared < cell_of_value.size() && cell_of_value[shared] != no_value) {
    const CellInfo& cell = routine.cells[cell_of_value[shared]];
    if (cell.node == section_) {
      return locals_.make({cell.instance, cell.field.name, "next"});
    }
  }
  return locals_.make({graph.nodes[section_].owner(), word_for(routine.tape[shared])});
}

/// Defines every value below a root that needs a name.
void StepWriter::write_shared(ValueId root, bool with_root, std::string& text) {
  struct Visit {
    ValueId id;
    bool entered;
  };
  std::vector<Visit> stack{{root, false}};
  while (!stack.empty()) {
    const auto [id, entered] = stack.back();
    stack.pop_back();
    const Value& value = routine.tape[id];
    if (is_leaf(value.op) || expressions.is_named(id)) {
      continue;
    }
    if (entered) {
      const std::uint32_t own = own_definition_[id];
      const bool wanted = (with_root || id != root) && !held_back_[id];
      if (const std::uint32_t family = loops_ ? family_of_[id] : no_array;
          wanted && family != no_array && !in_reset_ && !arrays_[family].is_begun) {
        write_array(arrays_[family], text);
      } else if (wanted && own != no_value && array_of_[own] != no_array && !arrays_[array_of_[own]].is_begun) {
        write_array(arrays_[array_of_[own]], text);
      } else if (wanted && (needs_name(id) || own != no_value)) {
        write_definition(id, own != no_value ? name_of(routine.step[own]) : name_of(id), text);
      }
      continue;
    }
    if (loops_ && shapes_.is_sum(id)) {
      write_operands_of(id, text);
    }
    stack.push_back({id, true});
    for (std::size_t i = value.args.size(); i-- > 0;) {
      if (value.args[i] != no_value) {
        stack.push_back({value.args[i], false});
      }
    }
  }
}

}  // namespace hysteron
