#include "codegen/backends/cpp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <unordered_map>

#include "codegen/backends/cpp_expression.hpp"
#include "codegen/backends/cpp_helpers.hpp"
#include "codegen/backends/cpp_host.hpp"
#include "codegen/backends/cpp_words.hpp"
#include "codegen/backends/identifiers.hpp"
#include "codegen/backends/routine.hpp"
#include "codegen/graph/sample_time.hpp"
#include "codegen/program_hash.hpp"
#include "support/name_table.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

/// Appends all parts. Text is written once, where it stays: a long diagram has some hundred megabytes of it.
template <class... Parts>
void append(std::string& text, const Parts&... parts) {
  (text.append(parts), ...);
}

/// A comment to the end of its line. A line break in the text would end it; a backslash at the end would draw the next
/// line into it.
void append_comment(std::string& text, std::string_view unit, std::string_view meaning) {
  const bool has_unit = !unit.empty() && unit.find('\'') == std::string_view::npos;
  if (has_unit) {
    append(text, "  // [", unit, "]", meaning.empty() ? "" : " ");
  } else if (!meaning.empty()) {
    append(text, "  // ");
  }
  const std::size_t begin = text.size();
  append(text, meaning);
  std::replace_if(
      text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(),
      [](char letter) { return letter == '\n' || letter == '\r'; }, ' ');
  const std::size_t last = text.find_last_not_of(' ');
  if (last >= begin && last < text.size() && text[last] == '\\') {
    text += '.';
  }
}

class CppHeader {
 public:
  CppHeader(const Program& program, const CppOptions& options)
      : program_(program),
        graph_(program.graph),
        routine_(make_routine(program)),
        expressions_(routine_, graph_.sample_time_ns, options.float32),
        options_(options),
        members_(cpp_words),
        locals_(cpp_words),
        input_names_(cpp_port_names(program.graph.inputs)),
        output_names_(cpp_port_names(program.graph.outputs)) {
    name_everything();
    own_definition_.assign(routine_.tape.size(), none);
    for (std::uint32_t i = 0; i < routine_.step.size(); ++i) {
      const Statement& one = routine_.step[i];
      if (one.kind == Statement::Kind::Define && one.always && own_definition_[one.value] == none) {
        own_definition_[one.value] = i;
      }
    }
  }

  std::vector<std::string> parameter_members() const {
    std::vector<std::string> members;
    for (const CppMember& member : expressions_.parameters) {
      members.push_back(std::string(member.group) + (member.group.empty() ? "" : ".") + std::string(member.name));
    }
    return members;
  }

  GeneratedFile run() {
    // What stands before the functions is written while they are: both only read what they share.
    auto before = std::async(std::launch::async, [this] { return declarations(); });
    std::string text = functions();
    text.insert(0, before.get());
    return {namespace_identifier(graph_.name) + ".hpp", std::move(text)};
  }

 private:
  static constexpr std::uint32_t none = no_value;

  // --- names ---

  void name_everything() {
    NameTable instances;
    std::vector<std::string_view> groups;  // by instance
    const auto group = [&](std::string_view instance) {
      const auto [number, is_new] = instances.add(language::upper(instance));
      if (is_new) {
        groups.push_back(members_.make({instance}));
      }
      return groups[number];
    };
    const auto field_name = [&](std::string_view name) { return fields_[fields_.add(field_identifier(name)).number]; };
    for (const Parameter& parameter : graph_.parameters) {
      const auto dot = parameter.path.rfind('.');
      if (dot == std::string::npos) {
        expressions_.parameters.push_back({.name = members_.make({parameter.path})});
      } else {
        expressions_.parameters.push_back({.group = group(std::string_view(parameter.path).substr(0, dot)),
                                           .name = field_name(parameter.field.name)});
      }
    }
    NameTable taken;
    std::string joined;
    for (const CellInfo& cell : routine_.cells) {
      CppMember member{.name = field_name(cell.field.name)};
      if (cell.instance.empty()) {
        member.name = members_.make({member.name});
      } else {
        member.group = group(cell.instance);
      }
      for (;;) {
        joined.assign(member.group).append(".").append(member.name);
        if (taken.add(joined).is_new) {
          break;
        }
        member.name = field_name("last_" + std::string(member.name));
      }
      expressions_.cells.push_back(member);
    }
    expressions_.inputs.assign(input_names_.begin(), input_names_.end());
  }

  // --- declarations ---

  std::string declarations() const {
    std::string text = banner();
    append(text, includes(), "namespace ", namespace_identifier(graph_.name),
           " {\n\nusing Real = ", options_.float32 ? "float" : "double",
           ";\n\ninline constexpr Real sample_time = ", expressions_.literal(Type::Real, graph_.sample_time()),
           ";  // s\n\n");
    append_structs(text);
    const bool stores = sets_elements(routine_.reset) || sets_elements(routine_.step);
    append(text, cpp_helper_functions(routine_.used_by_reset | routine_.used_by_step, stores));
    return text;
  }

  static bool sets_elements(const std::vector<Statement>& list) {
    return std::ranges::any_of(
        list, [](const Statement& one) { return one.kind == Statement::Kind::StoreCell && one.index != no_value; });
  }

  std::string banner() const {
    std::string text;
    const auto line = [&](std::string_view words) { text += fmt::format("//{}{}\n", words.empty() ? "" : " ", words); };
    line(fmt::format("{}: generated by Hysteron from a block diagram; edit the diagram, not this file.", graph_.name));
    line("");
    line(fmt::format(
        "Sample time {} s. State: {} bytes. Operations a step: {} (calls of exp, log, power and the like: {}).",
        number_text(graph_.sample_time()), state_bytes(), routine_.operations, routine_.function_calls));
    line(fmt::format("Hash of diagram and parameters: {}.", program_hash(program_)));
    line(fmt::format("Compile with {}: then a step has the bits that `hysteron run` shows.", cpp_numeric_flags));
    line("");
    text += schedule_lines();
    return text + "#pragma once\n\n";
  }

  [[nodiscard]] std::size_t state_bytes() const {
    std::size_t bytes = 0;
    for (const CellInfo& cell : routine_.cells) {
      const std::size_t one = cell.field.type == Type::Real   ? (options_.float32 ? 4 : 8)
                              : cell.field.type == Type::Bool ? 1
                              : cell.field.type == Type::Int  ? 4
                                                              : 2;
      bytes += one * cell.field.length;
    }
    return bytes;
  }

  std::string schedule_lines() const {
    std::string text = "// Schedule:";
    std::size_t width = text.size();
    std::size_t count = 0;
    for (const Action& action : program_.schedule.actions) {
      const Node& node = graph_.nodes[action.node];
      if (node.block == nullptr) {
        continue;
      }
      if (++count > 200) {  // a long diagram's schedule is its step itself
        text += " …";
        break;
      }
      const std::string entry = fmt::format(" {}{}", node.path,
                                            action.kind == Action::Kind::Output   ? " (output)"
                                            : action.kind == Action::Kind::Update ? " (update)"
                                                                                  : "");
      if (width + entry.size() > 116) {
        text += "\n//  ";
        width = 4;
      }
      text += entry + ",";
      width += entry.size() + 1;
    }
    if (text.ends_with(',')) {
      text.back() = '.';
    }
    return text + "\n";
  }

  std::string includes() const {
    std::string text;
    const bool arrays =
        std::ranges::any_of(routine_.cells, [](const CellInfo& cell) { return cell.field.length > 1; }) ||
        std::ranges::any_of(graph_.parameters, [](const Parameter& one) { return one.field.length > 1; });
    if (arrays) {
      text += "#include <array>\n";
    }
    text += "#include <cmath>\n#include <cstddef>\n#include <cstdint>\n";
    if (routine_.infinite_literals || uses(Op::ToInt) || has_infinite_parameter()) {
      text += "#include <limits>\n";
    }
    return text +
           "\n#if defined(__FAST_MATH__)\n#error \"compile without -ffast-math: it changes what a step "
           "computes\"\n#endif\n\n";
  }

  [[nodiscard]] bool uses(Op op) const {
    return (routine_.used_by_reset | routine_.used_by_step).test(static_cast<std::size_t>(op));
  }

  [[nodiscard]] bool has_infinite_parameter() const {
    return std::ranges::any_of(graph_.parameters, [](const Parameter& one) {
      return std::ranges::any_of(one.value, [](double value) { return !(value - value == 0.0); });
    });
  }

  /// A member with the values that it begins with: none for the members of the state, which reset gives theirs.
  void append_member(std::string& text, const Field& field, const CppMember& member,
                     const std::vector<double>* values) const {
    append(text, member.group.empty() ? "  " : "    ");
    if (field.length > 1) {
      append(text, "std::array<", cpp_type(field.type), ", ", std::to_string(field.length), "> ");
    } else {
      append(text, cpp_type(field.type), " ");
    }
    append(text, member.name);
    if (values == nullptr) {
      append(text, "{}");
    } else if (field.length > 1) {
      for (std::size_t i = 0; i < values->size(); ++i) {
        append(text, i == 0 ? "{" : ", ", expressions_.literal(field.type, (*values)[i]));
      }
      append(text, "}");
    } else {
      append(text, " = ", expressions_.literal(field.type, values->front()));
    }
    append(text, ";");
    append_comment(text, field.unit, field.meaning);
    append(text, "\n");
  }

  /// Members in the order of their first mention, those of one instance together.
  template <class Line>
  static void append_grouped(std::string& text, const std::vector<CppMember>& members, Line line) {
    // By identifier of a group, which stands but once in memory: its members so far.
    std::unordered_map<const char*, std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (!members[i].group.empty()) {
        groups[members[i].group.data()].push_back(i);
      }
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (members[i].group.empty()) {
        line(i);
        continue;
      }
      const std::vector<std::size_t>& group = groups[members[i].group.data()];
      if (group.front() == i) {
        append(text, "  struct {\n");
        std::ranges::for_each(group, line);
        append(text, "  } ", members[i].group, ";\n");
      }
    }
  }

  void append_structs(std::string& text) const {
    text.reserve(text.size() + 100 * (graph_.parameters.size() + routine_.cells.size()));
    append(text, "struct Params {\n");
    append_grouped(text, expressions_.parameters, [&](std::size_t i) {
      append_member(text, graph_.parameters[i].field, expressions_.parameters[i], &graph_.parameters[i].value);
    });
    text += "};\n\nstruct State {\n";
    append_grouped(text, expressions_.cells, [&](std::size_t i) {
      append_member(text, routine_.cells[i].field, expressions_.cells[i], nullptr);
    });
    text += "};\n\n";
    append_ports(text, "In", graph_.inputs, input_names_);
    append_ports(text, "Out", graph_.outputs, output_names_);
  }

  void append_ports(std::string& text, std::string_view name, const std::vector<Port>& ports,
                    const std::vector<std::string>& names) const {
    append(text, "struct ", name, " {\n");
    for (std::size_t i = 0; i < ports.size(); ++i) {
      append(text, "  ", cpp_type(ports[i].type), " ", names[i], " = ",
             expressions_.literal(ports[i].type, ports[i].preset), ";");
      append_comment(text, ports[i].unit, ports[i].meaning);
      append(text, "\n");
    }
    append(text, "};\n\n");
  }

  // --- functions ---

  std::string functions() {
    std::string text;
    text.reserve(100 * (routine_.step.size() + routine_.reset.size() + graph_.parameters.size() + 200));
    append(text, "/// Puts the state to its beginning.\ninline void reset(");
    append_arguments(text, routine_.reset, routine_.used_by_reset);
    append(text, ") noexcept {\n");
    for (const Statement& statement : routine_.reset) {
      write(statement, text);
    }
    append(text, "}\n\n/// One step: outputs from inputs and state, and the state moved on.\ninline Out step(");
    append_arguments(text, routine_.step, routine_.used_by_step);
    append(text, ", const In&", routine_.used_by_step.test(static_cast<std::size_t>(Op::Input)) ? " in" : "",
           ") noexcept {\n  Out out;\n");
    for (const Statement& statement : routine_.step) {
      write(statement, text);
    }
    if (routine_.longest_period > 1) {
      std::string counter;
      CppExpressions::print_cell(expressions_.cells[routine_.counter], counter);
      append(text, fmt::format("  {0} = {0} + 1 < {1} ? {0} + 1 : 0;\n", counter, routine_.longest_period));
    }
    append(text, "  return out;\n}\n\n}  // namespace ", namespace_identifier(graph_.name), "\n");
    return text;
  }

  /// Parameters of a function are named only where it uses them.
  static void append_arguments(std::string& text, const std::vector<Statement>& list, const Operations& used) {
    const bool state =
        used.test(static_cast<std::size_t>(Op::Cell)) || std::ranges::any_of(list, [](const Statement& one) {
          return one.kind == Statement::Kind::SetCell || one.kind == Statement::Kind::StoreCell ||
                 one.kind == Statement::Kind::BeginRate;
        });
    append(text, "const Params&", used.test(static_cast<std::size_t>(Op::Parameter)) ? " params" : "", ", State&",
           state ? " state" : "");
  }

  void write(const Statement& statement, std::string& text) {
    switch (statement.kind) {
      case Statement::Kind::Section:
        section_ = statement.target;
        section_begins_ = graph_.nodes[section_].block != nullptr;
        return;
      case Statement::Kind::BeginRate:
        append(text, indent_, "if (");
        CppExpressions::print_cell(expressions_.cells[routine_.counter], text);
        append(text, fmt::format(" % {} == {}) {{\n", statement.rate.every, statement.rate.phase));
        indent_ = "    ";
        return;
      case Statement::Kind::EndRate:
        indent_ = "  ";
        append(text, indent_, "}\n");
        return;
      case Statement::Kind::Define:
        if ((statement.always || routine_.uses[statement.value] > 1) && !expressions_.is_named(statement.value)) {
          write_shared(statement.value, false, text);
          write_definition(statement.value, name_of(statement), text);
        }
        return;
      default:
        break;
    }
    write_shared(statement.value, true, text);
    if (statement.index != no_value) {
      write_shared(statement.index, true, text);
    }
    begin_line(text);
    if (statement.kind == Statement::Kind::SetOutput) {
      append(text, "out.", output_names_[statement.target], " = ");
      expressions_.print(statement.value, text);
      append(text, ";\n");
    } else if (statement.kind == Statement::Kind::SetCell) {
      CppExpressions::print_cell(expressions_.cells[statement.target], text);
      append(text, " = ");
      expressions_.print(statement.value, text);
      append(text, ";\n");
    } else {
      append(text, statement.index == no_value ? "" : "detail::store(");
      CppExpressions::print_cell(expressions_.cells[statement.target], text);
      append(text, statement.index == no_value ? ".fill(" : ", ");
      if (statement.index != no_value) {
        expressions_.print(statement.index, text);
        append(text, ", ");
      }
      expressions_.print(statement.value, text);
      append(text, ");\n");
    }
  }

  /// The first line of a block stands behind its name.
  void begin_line(std::string& text) {
    if (section_begins_) {
      const Node& node = graph_.nodes[section_];
      append(text, "\n", indent_, "// ", node.path, " : ", node.block->about.name, "\n");
      section_begins_ = false;
    }
    append(text, indent_);
  }

  void write_definition(ValueId id, std::string_view name, std::string& text) {
    begin_line(text);
    append(text, "const ", cpp_type(routine_.tape[id].type), " ", name, " = ");
    expressions_.print(id, text);
    append(text, ";\n");
    expressions_.name(id, name);
  }

  std::string_view name_of(const Statement& definition) {
    return locals_.make({graph_.nodes[definition.target].owner(), definition.field, definition.what});
  }
  /// Defines every value below a root that is used more than once.
  void write_shared(ValueId root, bool with_root, std::string& text) {
    struct Visit {
      ValueId id;
      bool entered;
    };
    std::vector<Visit> stack{{root, false}};
    while (!stack.empty()) {
      const auto [id, entered] = stack.back();
      stack.pop_back();
      const Value& value = routine_.tape[id];
      if (is_leaf(value.op) || expressions_.is_named(id)) {
        continue;
      }
      if (entered) {
        const std::uint32_t own = own_definition_[id];
        if ((routine_.uses[id] > 1 || own != none) && (with_root || id != root)) {
          write_definition(
              id, own != none ? name_of(routine_.step[own]) : locals_.make({graph_.nodes[section_].owner(), "t"}),
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

  const Program& program_;
  const Graph& graph_;
  Routine routine_;
  CppExpressions expressions_;
  CppOptions options_;
  Identifiers members_;  ///< groups of Params and State, and what stands in them alone
  NameTable fields_;     ///< members of groups
  Identifiers locals_;
  std::vector<std::string> input_names_;
  std::vector<std::string> output_names_;
  std::vector<std::uint32_t> own_definition_;  ///< by value: where the step defines it by the name of a port or state
  std::string_view indent_ = "  ";
  std::uint32_t section_ = 0;  ///< the node to which the statement at hand belongs
  bool section_begins_ = false;
};

}  // namespace

GeneratedFile generate_cpp_header(const Program& program, const CppOptions& options) {
  require_sample_time(program.graph);
  return CppHeader(program, options).run();
}

std::vector<std::string> cpp_parameter_members(const Program& program) {
  require_sample_time(program.graph);
  return CppHeader(program, {}).parameter_members();
}

std::vector<GeneratedFile> generate_cpp(const Program& program, const CppOptions& options) {
  return {generate_cpp_header(program, options), cpp_host_main(program), cpp_host_cmake(program)};
}

}  // namespace hysteron
