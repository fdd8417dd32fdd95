#include "codegen/backends/st/writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/backends/shared/generated_file.hpp"

namespace hysteron {
namespace {
constexpr std::size_t widest_call = 100;
}  // namespace

StWriter::StWriter(const Graph& the_graph, const Routine& the_routine, StPrinter& printer, Identifiers& the_locals,
                   const Layout& layout, const StNames& names)
    : StepWriter(the_graph, the_routine, printer, the_locals),
      printer_(printer),
      layout_(layout),
      identifiers_(the_locals) {
  must_be_named = printer.guards().must_be_named();
  cell_of_value.assign(routine.tape.size(), no_value);
  for (const Statement& one : routine.step) {
    if (one.kind == Statement::Kind::SetCell && cell_of_value[one.value] == no_value) {
      cell_of_value[one.value] = one.target;
    }
  }
  printer.print_variable(names.place, place_);
}

void StWriter::write_reset_body(std::string& text) {
  indentation = "    ";
  write_reset(text);
  indentation = "  ";
}

void StWriter::write_counter(std::string& text) const {
  if (routine.longest_period > 1) {
    std::string counter;
    printer_.print_cell(routine.counter, counter);
    append(text, fmt::format("\n  {0} := {0} + 1;\n  IF {0} >= {1} THEN\n    {0} := 0;\n  END_IF;\n", counter,
                             routine.longest_period));
  }
}

void StWriter::name_outputs_at_once(const std::vector<bool>& ahead, bool single_pins) {
  output_of_value.assign(routine.tape.size(), no_value);
  std::vector<bool> is_element(routine.tape.size(), false);
  for (const Statement& one : routine.step) {
    if (one.kind == Statement::Kind::Define && !single_pins) {
      is_element[one.value] = is_element[one.value] || element_of(one.field);
    }
    const bool late = one.target < ahead.size() && ahead[one.target];
    if (one.kind == Statement::Kind::SetOutput && !late && output_of_value[one.value] == no_value &&
        !is_element[one.value] && !element_of(layout_.outputs[one.target])) {
      output_of_value[one.value] = one.target;
    }
  }
}

/// A block with memory has an input RESET; it keeps its value from call to call, so each call says it.
void StWriter::call(const Statement& statement, bool reset, std::string& text) {
  const BlockType& block = *graph.nodes[statement.target].block;
  std::string line;
  printer_.print_variable(layout_.instances[statement.target], line);
  line += '(';
  const std::size_t first_column = line.size();
  bool first = true;
  const auto argument = [&](std::string_view pin, const std::string& value) {
    const std::size_t width = line.size() - (line.rfind('\n') == std::string::npos ? 0 : line.rfind('\n'));
    if (!first) {
      line += width + pin.size() + value.size() > widest_call
                  ? ",\n" + std::string(indentation.size() + first_column, ' ')
                  : ", ";
    }
    append(line, pin, " := ", value);
    first = false;
  };
  for (std::uint32_t i = 0; i < statement.argument_count; ++i) {
    const CallArgument& one = routine.arguments[statement.first_argument + i];
    argument(printer_.pin_name(block.pin(one.pin).name), printer_.text(one.value));
  }
  if (!block.states.empty()) {
    argument("RESET", reset ? "TRUE" : "FALSE");
  }
  append(text, line, ");\n");
}

void StWriter::heading(const Node& node, std::string& text) {
  if (node.path.empty() || !layout_.instances.empty()) {
    return;  // a block of the library, as its own head says; or one that is called, as its call says
  }
  append(text, "\n", indentation, "(* ", node.path, " : ", node.block->about.name, " *)\n");
}

void StWriter::begin_rate(const Rate& rate, std::string& text) {
  text += "IF ";
  printer_.print_cell(routine.counter, text);
  append(text, fmt::format(" MOD {} = {} THEN\n", rate.every, rate.phase));
}

void StWriter::assign(std::string_view target, ValueId value, std::string& text) {
  append(text, target, " := ");
  printer_.print(value, text);
  text += ";\n";
}

void StWriter::set_output(std::uint32_t output, ValueId value, std::string& text) {
  printer_.print_variable(layout_.outputs[output], text);
  assign("", value, text);
}

void StWriter::set_cell(std::uint32_t cell, ValueId value, std::string& text) {
  printer_.print_cell(cell, text);
  assign("", value, text);
}

void StWriter::set_element(std::uint32_t cell, ValueId index, ValueId value, std::string& text) {
  printer_.print_cell(cell, text);
  printer_.print_place(index, routine.cells[cell].field.length, text);
  assign("", value, text);
}

void StWriter::fill_cell(std::uint32_t cell, ValueId value, std::string& text) {
  uses_place = true;
  append(text, fmt::format("FOR {} := 0 TO {} DO ", place_, routine.cells[cell].field.length - 1));
  printer_.print_cell(cell, text);
  append(text, "[", place_, "] := ");
  printer_.print(value, text);
  text += "; END_FOR;\n";
}

LoopWords StWriter::loop_words() {
  term_name = identifiers_.make({"TERM"});
  sum_ = identifiers_.make({"SUM"});
  term_.clear();
  printer_.print_variable(term_name, term_);
  return {.places = {.row = place_, .column = term_}, .sums = {sum_}, .assign = " := "};
}

void StWriter::begin_loop(std::string_view place, std::size_t first, std::size_t end, std::size_t /*step*/,
                          std::string& text) {
  (place == place_ ? uses_place : uses_term) = true;
  append(text, fmt::format("FOR {} := {} TO {} DO\n", place, first, end - 1));
}

void StWriter::declare_array(std::string_view name, Type type, std::size_t length, std::string& /*text*/) {
  locals.push_back({name, type, static_cast<std::uint32_t>(length)});
}

void StWriter::begin_variable(std::string_view name, SumVariable variable, std::string& text) {
  if (!variable.is_known && std::ranges::find(locals, name, &StLocal::name) == locals.end()) {
    locals.push_back({name, Type::Real});
  }
  printer_.print_variable(name, text);
}

void StWriter::set_local(std::string_view element, ValueId value, std::string& text) {
  std::string target;
  printer_.print_variable(element, target);
  if (expressions.is_named(value)) {
    return assign(target, value, text);
  }
  set_variable(target, value, text);
}

// --- values that have a name ---

void StWriter::line(std::string_view words, std::string& text) const {
  append(text, indentation, words, "\n");
}

void StWriter::define(ValueId id, std::string_view name, std::string& text) {
  const Value& value = routine.tape[id];
  if (!is_output(id)) {
    locals.push_back({name, value.type});
  }
  std::string target;
  printer_.print_variable(name, target);
  set_variable(target, id, text);
}

void StWriter::set_variable(const std::string& target, ValueId id, std::string& text) {
  const Value& value = routine.tape[id];
  const Guards& guards = printer_.guards();
  if (value.op == Op::Divide && !guards.is_plain_divisor(value.args[1])) {
    return define_quotient(value, target, text);
  }
  if ((value.op == Op::IntDivide || value.op == Op::IntModulo) && !guards.is_safe_divisor(value.args[1])) {
    return define_integer_quotient(value, target, text);
  }
  if (value.op == Op::Power && guards.power_form(value) >= PowerForm::NonZero) {
    return define_power(value, target, text);
  }
  if (value.op == Op::ToInt) {
    return define_integer(value, target, text);
  }
  assign(target, id, text);
}

}  // namespace hysteron
