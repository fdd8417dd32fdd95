#include "codegen/backends/c_family/printer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "codegen/backends/shared/generated_file.hpp"
#include "support/numbers.hpp"

namespace hysteron {

std::string_view type_of(const DialectOfC& dialect, Type type) {
  switch (type) {
    case Type::Real:
      return dialect.real;
    case Type::Bool:
      return dialect.truth;
    case Type::Int:
      return dialect.integer;
    case Type::Word:
      return dialect.word;
  }
  return "";
}

namespace {

std::string digits_of(const DialectOfC& dialect, Type type, double value, bool float32) {
  switch (type) {
    case Type::Real:
      if (std::isnan(value)) {
        return std::string(dialect.not_a_number);
      }
      if (std::isinf(value)) {
        return (value > 0 ? "" : "-") + std::string(dialect.infinity);
      }
      return float32 ? real_literal(static_cast<float>(value)) + "F" : real_literal(value);
    case Type::Bool:
      return value != 0.0 ? "true" : "false";
    case Type::Int:
      return value == -2147483648.0 ? "(-2147483647 - 1)" : fmt::format("{}", static_cast<std::int64_t>(value));
    case Type::Word:
      return fmt::format("{}0x{:04X}{}", dialect.word_begin, static_cast<unsigned>(value), dialect.word_end);
  }
  return "";
}

}  // namespace

std::string literal_of(const DialectOfC& dialect, Type type, double value, bool float32) {
  std::string text(dialect.literal_begin);
  append(text, digits_of(dialect, type, value, float32), dialect.literal_end);
  return text;
}

void PrinterOfC::print_member(std::string_view object, const Member& member, std::string& out) {
  out += object;
  if (!member.group.empty()) {
    out += member.group;
    out += '.';
  }
  out += member.name;
}

void PrinterOfC::print_leaf(const Value& value, int outer, std::string& out) const {
  switch (value.op) {
    case Op::SampleTime:
      if (value.index == 1) {
        out += "sample_time";
      } else {
        out += literal(Type::Real, static_cast<double>(graph_.sample_time_ns * value.index) * 1e-9);
      }
      return;
    case Op::Input:
      out += dialect_.input;
      out += layout_.inputs[value.index];
      return;
    case Op::Parameter:
      return print_member(dialect_.parameters, layout_.parameters[value.index], out);
    case Op::Cell:
      return print_cell(value.index, out);
    case Op::Pin:  // of a block's own trace alone
      return;
    default: {
      const std::string text = literal(value.type, value.literal);
      const bool brackets = text.front() == '-' && outer >= Strength::Multiplicative;
      out += brackets ? "(" + text + ")" : text;
    }
  }
}

/// A place that is known is written as it stands; one that is computed may lie outside.
void PrinterOfC::print_element(const Value& value, std::string& out) const {
  const Value& array = tape()[value.args[0]];
  const Value& place = tape()[value.args[1]];
  const std::size_t length =
      array.op == Op::Cell ? length_of_cell(array.index) : graph_.parameters[array.index].field.length;
  if (place.op == Op::IntLiteral) {
    print(value.args[0], out);
    return append(out, "[", std::to_string(place_within(place.literal, length)), "]");
  }
  out += dialect_.read_begin;
  print(value.args[0], out);
  out += ", ";
  if (dialect_.passes_length) {
    append(out, std::to_string(length), ", ");
  }
  print(value.args[1], out);
  out += ')';
}

void PrinterOfC::print_special(const Value& value, int outer, std::string& out) const {
  if (value.op == Op::At) {
    return print_element(value, out);
  }
  out += outer > Strength::Loosest ? "(" : "";
  const int side = dialect_.careful ? Strength::Primary : Strength::LogicalOr;
  print(value.args[0], side, out);
  out += " ? ";
  print(value.args[1], side, out);
  out += " : ";
  print(value.args[2], dialect_.careful ? side : Strength::Loosest, out);
  out += outer > Strength::Loosest ? ")" : "";
}

/// The result is known, but for what is not a number; yet the side is mentioned, or a value would have a name for
/// nothing.
bool PrinterOfC::print_equal_sides(const Value& value, const std::string& side, std::string& out) const {
  switch (value.op) {
    case Op::Equal:
    case Op::LessEqual:
      append(out, "!isnan(", side, ")");
      return true;
    case Op::NotEqual:
      append(out, "isnan(", side, ")");
      return true;
    case Op::Less:
      append(out, "(isnan(", side, ") && !isnan(", side, "))");
      return true;
    case Op::IntEqual:
    case Op::IntLessEqual:
      append(out, "(0 * ", side, " == 0)");
      return true;
    case Op::Xor:
      append(out, "(", side, " && !", side, ")");
      return true;
    default:
      append(out, "(0 * ", side, " != 0)");
      return true;
  }
}

void WriterOfC::heading(const Node& node, std::string& text) {
  append(text, "\n", indentation, "// ", node.path, " : ", node.block->about.name, "\n");
}

void WriterOfC::begin_rate(const Rate& rate, std::string& text) {
  text += dialect_.careful ? "if ((" : "if (";
  printer_.print_cell(routine.counter, text);
  append(text, fmt::format(fmt::runtime(dialect_.careful ? " % {}) == {}) {{\n" : " % {} == {}) {{\n"), rate.every,
                           rate.phase));
}

LoopWords WriterOfC::loop_words() {
  return {.places = {.row = locals_.make({"i"}),
                     .column = locals_.make({"k"}),
                     .number_end = dialect_.careful ? "U" : "",
                     .brackets = dialect_.careful},
          .sums = {locals_.make({"sum"}), locals_.make({"sum"}), locals_.make({"sum"}), locals_.make({"sum"})},
          .assign = " = ",
          .several_at_once = true};
}

void WriterOfC::begin_loop(std::string_view place, std::size_t first, std::size_t end, std::size_t step,
                           std::string& text) {
  const std::string next = step == 1 ? fmt::format("++{}", place) : fmt::format("{} += {}U", place, step);
  append(text, fmt::format("for ({0} {1} = {2}U; {1} < {3}U; {4}) {{\n", dialect_.place, place, first, end, next));
}

void WriterOfC::declare_array(std::string_view name, Type type, std::size_t length, std::string& text) {
  append(text, indentation, type_of(dialect_, type), fmt::format(" {}[{}];\n", name, length));
}

void WriterOfC::begin_variable(std::string_view name, SumVariable variable, std::string& text) {
  if (!variable.is_known) {
    append(text, variable.changes ? "" : "const ", dialect_.real, " ");
  }
  text += name;
}

void WriterOfC::set_local(std::string_view element, ValueId value, std::string& text) {
  append(text, element, " = ");
  expressions.print(value, text);
  text += ";\n";
}

void WriterOfC::define(ValueId id, std::string_view name, std::string& text) {
  append(text, "const ", type_of(dialect_, routine.tape[id].type), " ", name, " = ");
  expressions.print(id, text);
  text += ";\n";
}

void WriterOfC::set_output(std::uint32_t output, ValueId value, std::string& text) {
  append(text, dialect_.output, layout_.outputs[output], " = ");
  expressions.print(value, text);
  text += ";\n";
}

void WriterOfC::set_cell(std::uint32_t cell, ValueId value, std::string& text) {
  printer_.print_cell(cell, text);
  text += " = ";
  expressions.print(value, text);
  text += ";\n";
}

void WriterOfC::set_element(std::uint32_t cell, ValueId index, ValueId value, std::string& text) {
  text += dialect_.element_begin;
  printer_.print_cell(cell, text);
  text += ", ";
  if (dialect_.passes_length) {
    append(text, std::to_string(printer_.length_of_cell(cell)), ", ");
  }
  expressions.print(index, text);
  text += ", ";
  expressions.print(value, text);
  text += ");\n";
}

void WriterOfC::write_counter(std::string& text) const {
  if (routine.longest_period > 1) {
    std::string counter;
    printer_.print_cell(routine.counter, counter);
    append(text, fmt::format(fmt::runtime(dialect_.careful ? "  {0} = (({0} + 1) < {1}) ? ({0} + 1) : 0;\n"
                                                           : "  {0} = {0} + 1 < {1} ? {0} + 1 : 0;\n"),
                             counter, routine.longest_period));
  }
}

bool touches_state(const std::vector<Statement>& list, const Operations& used) {
  return used.test(static_cast<std::size_t>(Op::Cell)) || std::ranges::any_of(list, [](const Statement& one) {
           return one.kind == Statement::Kind::SetCell || one.kind == Statement::Kind::StoreCell ||
                  one.kind == Statement::Kind::BeginRate;
         });
}

bool sets_elements(const std::vector<Statement>& list) {
  return std::ranges::any_of(
      list, [](const Statement& one) { return one.kind == Statement::Kind::StoreCell && one.index != no_value; });
}

void append_comment(std::string& text, std::string_view begin, std::string_view unit, std::string_view meaning,
                    std::string_view end) {
  const bool has_unit = !unit.empty() && unit.find('\'') == std::string_view::npos;
  if (!has_unit && meaning.empty()) {
    return;
  }
  append(text, begin);
  if (has_unit) {
    append(text, "[", unit, "]", meaning.empty() ? "" : " ");
  }
  const std::size_t from = text.size();
  append(text, meaning);
  // A line break in the text would end the comment; a backslash at the end would draw the next line into it.
  std::replace_if(
      text.begin() + static_cast<std::ptrdiff_t>(from), text.end(),
      [](char letter) { return letter == '\n' || letter == '\r'; }, ' ');
  const std::size_t last = text.find_last_not_of(' ');
  if (last >= from && last < text.size() && text[last] == '\\') {
    text += '.';
  }
  append(text, end);
}

}  // namespace hysteron
