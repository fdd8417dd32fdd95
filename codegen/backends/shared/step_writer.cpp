#include "codegen/backends/shared/step_writer.hpp"

#include <algorithm>

#include "codegen/backends/shared/generated_file.hpp"

namespace hysteron {
namespace {

constexpr std::size_t shortest_loop = 3;

/// Lines as one, in which a name stands for the place of an element, [0] in the first line and [2] in the third; empty
/// where they differ in more.
std::string rolled(const std::vector<std::string>& lines, std::string_view place) {
  std::string line;
  std::vector<std::size_t> at(lines.size(), 0);
  const auto all = [&](auto expected) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!std::string_view(lines[i]).substr(at[i]).starts_with(expected(i))) {
        return false;
      }
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
      at[i] += std::string_view(expected(i)).size();
    }
    return true;
  };
  while (at[0] < lines[0].size()) {
    if (all([](std::size_t i) { return "[" + std::to_string(i) + "]"; })) {
      append(line, "[", place, "]");
    } else if (const std::string one(1, lines[0][at[0]]); all([&](std::size_t) { return one; })) {
      line += one;
    } else {
      return {};
    }
  }
  const bool whole = std::ranges::equal(lines, at, {}, &std::string::size) && std::ranges::count(line, '\n') == 1;
  return whole ? line : std::string();
}

}  // namespace

StepWriter::StepWriter(const Graph& the_graph, const Routine& the_routine, ExpressionPrinter& the_expressions,
                       Identifiers& locals)
    : graph(the_graph), routine(the_routine), expressions(the_expressions), locals_(locals) {
  arrays_ = port_groups(graph.outputs);
  std::erase_if(arrays_, [](const PortGroup& one) { return !one.is_array(); });
  own_definition_.assign(routine.tape.size(), no_value);
  for (std::uint32_t i = 0; i < routine.step.size(); ++i) {
    const Statement& one = routine.step[i];
    if (one.kind == Statement::Kind::Define && one.always && own_definition_[one.value] == no_value) {
      own_definition_[one.value] = i;
    }
  }
}

void StepWriter::write(const std::vector<Statement>& list, std::string& text) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto array = std::ranges::find_if(arrays_, [&](const PortGroup& one) {
      return list[i].kind == Statement::Kind::SetOutput && list[i].target == one.first && i + one.length <= list.size();
    });
    if (array == arrays_.end()) {
      write(list[i], text);
    } else {
      write_array(list, *array, i, text);
      i += array->length - 1;
    }
  }
}

/// The elements of an output, whose statements follow each other.
void StepWriter::write_array(const std::vector<Statement>& list, const PortGroup& group, std::size_t at,
                             std::string& text) {
  std::vector<std::string> lines(group.length);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    write(list[at + i], lines[i]);
  }
  const bool may_loop = lines.size() >= shortest_loop && !place_name().empty();
  const std::string line = may_loop ? rolled(lines, place_name()) : std::string();
  if (line.empty()) {
    std::ranges::for_each(lines, [&](const std::string& one) { text += one; });
    return;
  }
  text += indentation;
  begin_loop(group.length, text);
  append(text, "  ", line, indentation);
  end_loop(text);
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
void StepWriter::begin_line(std::string& text) {
  if (section_begins_) {
    heading(graph.nodes[section_], text);
    section_begins_ = false;
  }
  text += indentation;
}

void StepWriter::write_definition(ValueId id, std::string_view name, std::string& text) {
  begin_line(text);
  define(id, name, text);
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
      if ((needs_name(id) || own != no_value) && (with_root || id != root)) {
        write_definition(id,
                         own != no_value ? name_of(routine.step[own])
                                         : locals_.make({graph.nodes[section_].owner(), word_for(value)}),
                         text);
      }
      continue;
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
