#include "codegen/backends/cpp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "codegen/backends/cpp_expression.hpp"
#include "codegen/backends/cpp_host.hpp"
#include "codegen/backends/cpp_words.hpp"
#include "codegen/backends/identifiers.hpp"
#include "codegen/backends/routine.hpp"
#include "codegen/program_hash.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

struct Helper {
  std::string_view name;
  std::string_view text;
};
constexpr std::array helpers{
    Helper{"detail::power(", R"(// base^exponent; the common exponents have a path of their own.
inline Real power(Real base, Real exponent) noexcept {
  if (exponent == Real(1)) {
    return base;
  }
  if (exponent == Real(0.5)) {
    return std::sqrt(base);
  }
  if (exponent == Real(2)) {
    return base * base;
  }
  if (exponent == Real(0)) {
    return Real(1);
  }
  return std::pow(base, exponent);
}
)"},
    Helper{"detail::min(", R"(template <class T>
T min(T a, T b) noexcept {
  return b < a ? b : a;
}
)"},
    Helper{"detail::max(", R"(template <class T>
T max(T a, T b) noexcept {
  return b > a ? b : a;
}
)"},
    Helper{"detail::to_int(", R"(// Towards zero; saturates at the ends, 0 for not-a-number.
inline std::int32_t to_int(Real x) noexcept {
  if (!(x > Real(-2147483648.0))) {
    return x != x ? 0 : std::numeric_limits<std::int32_t>::min();
  }
  return x < Real(2147483648.0) ? static_cast<std::int32_t>(x) : std::numeric_limits<std::int32_t>::max();
}
)"},
    Helper{"detail::at(", R"(template <std::size_t N>
const Real& at(const std::array<Real, N>& array, std::int32_t index) noexcept {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  return array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))];
}
)"},
    Helper{"detail::store(", R"(template <std::size_t N>
void store(std::array<Real, N>& array, std::int32_t index, Real value) noexcept {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))] = value;
}
)"},
    Helper{"detail::wrap(", R"(// DINT wraps at its ends; a division by zero gives 0.
inline std::int32_t wrap(std::int64_t x) noexcept { return static_cast<std::int32_t>(static_cast<std::uint32_t>(x)); }
)"},
    Helper{"detail::add(",
           "inline std::int32_t add(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} + b); }\n"},
    Helper{"detail::subtract(",
           "inline std::int32_t subtract(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} - b); "
           "}\n"},
    Helper{"detail::multiply(",
           "inline std::int32_t multiply(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} * b); "
           "}\n"},
    Helper{"detail::divide(",
           "inline std::int32_t divide(std::int32_t a, std::int32_t b) noexcept { return b == 0 ? 0 : "
           "wrap(std::int64_t{a} / b); }\n"},
    Helper{"detail::modulo(",
           "inline std::int32_t modulo(std::int32_t a, std::int32_t b) noexcept { return b == 0 ? 0 : "
           "wrap(std::int64_t{a} % b); }\n"},
    Helper{"detail::negate(",
           "inline std::int32_t negate(std::int32_t a) noexcept { return wrap(-std::int64_t{a}); }\n"},
};

std::string comment_of(const Field& field) {
  std::string text(field.meaning);
  if (!field.unit.empty() && field.unit.find('\'') == std::string_view::npos) {
    text = fmt::format("[{}]{}{}", field.unit, text.empty() ? "" : " ", text);
  }
  return text.empty() ? "" : "  // " + text;
}

class CppHeader {
 public:
  CppHeader(const Program& program, const CppOptions& options)
      : program_(program),
        graph_(program.graph),
        routine_(make_routine(program)),
        expressions_(routine_, options.float32),
        options_(options),
        locals_(cpp_words),
        input_names_(cpp_port_names(program.graph.inputs)),
        output_names_(cpp_port_names(program.graph.outputs)) {
    expressions_.base_ns = graph_.sample_time_ns;
    name_everything();
  }

  GeneratedFile run() {
    const std::string body = functions();
    std::string text = banner();
    text += includes(body);
    text += fmt::format("namespace {} {{\n\nusing Real = {};\n\n", lower_identifier(graph_.name),
                        options_.float32 ? "float" : "double");
    text += fmt::format("inline constexpr Real sample_time = {};  // s\n\n",
                        expressions_.literal(Type::Real, graph_.sample_time()));
    text += structs();
    text += helper_functions(body);
    text += body;
    text += fmt::format("}}  // namespace {}\n", lower_identifier(graph_.name));
    return {lower_identifier(graph_.name) + ".hpp", std::move(text)};
  }

 private:
  // --- names ---

  /// A member `instance.field` of Params or State; fields of the diagram itself stand alone.
  struct Member {
    std::string group{};
    std::string name{};
  };

  void name_everything() {
    Identifiers groups(cpp_words);
    std::map<std::string, std::string> group_of;
    const auto group = [&](const std::string& instance) {
      const auto [place, is_new] = group_of.try_emplace(language::upper(instance));
      if (is_new) {
        place->second = groups.make(instance);
      }
      return place->second;
    };
    for (const Parameter& parameter : graph_.parameters) {
      const auto dot = parameter.path.rfind('.');
      if (dot == std::string::npos) {
        parameter_members_.push_back({.name = groups.make(parameter.path)});
      } else {
        parameter_members_.push_back(
            {.group = group(parameter.path.substr(0, dot)), .name = lower_identifier(parameter.field.name)});
      }
      expressions_.parameters.push_back("params." + joined(parameter_members_.back()));
    }
    std::set<std::string> taken;
    for (const CellInfo& cell : routine_.cells) {
      Member member{.name = lower_identifier(cell.field.name)};
      if (cell.instance.empty()) {
        member.name = groups.make(member.name);
      } else {
        member.group = group(cell.instance);
      }
      while (!taken.insert(joined(member)).second) {
        member.name = "last_" + member.name;
      }
      expressions_.cells.push_back("state." + joined(member));
      cell_members_.push_back(std::move(member));
    }
    for (const std::string& input : input_names_) {
      expressions_.inputs.push_back("in." + input);
    }
  }

  static std::string joined(const Member& member) {
    return member.group.empty() ? member.name : member.group + "." + member.name;
  }

  // --- declarations ---

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

  std::string includes(const std::string& body) const {
    std::string text;
    const bool arrays =
        std::ranges::any_of(routine_.cells, [](const CellInfo& cell) { return cell.field.length > 1; }) ||
        std::ranges::any_of(graph_.parameters, [](const Parameter& one) { return one.field.length > 1; });
    if (arrays) {
      text += "#include <array>\n";
    }
    text += "#include <cmath>\n#include <cstddef>\n#include <cstdint>\n";
    if (body.find("numeric_limits") != std::string::npos || body.find("to_int") != std::string::npos ||
        has_infinite_parameter()) {
      text += "#include <limits>\n";
    }
    return text +
           "\n#if defined(__FAST_MATH__)\n#error \"compile without -ffast-math: it changes what a step "
           "computes\"\n#endif\n\n";
  }

  [[nodiscard]] bool has_infinite_parameter() const {
    return std::ranges::any_of(graph_.parameters, [](const Parameter& one) {
      return std::ranges::any_of(one.value, [](double value) { return !(value - value == 0.0); });
    });
  }

  std::string member_line(const Field& field, const std::string& name, const std::vector<double>& value,
                          std::string_view indent, bool with_value) const {
    std::string initial;
    if (field.length > 1) {
      if (with_value) {
        std::vector<std::string> elements;
        for (const double element : value) {
          elements.push_back(expressions_.literal(field.type, element));
        }
        initial = fmt::format("{{{}}}", fmt::join(elements, ", "));
      }
      return fmt::format("{}std::array<{}, {}> {}{};{}\n", indent, cpp_type(field.type), field.length, name,
                         with_value ? initial : "{}", comment_of(field));
    }
    if (with_value) {
      initial = " = " + expressions_.literal(field.type, value.front());
    }
    return fmt::format("{}{} {}{};{}\n", indent, cpp_type(field.type), name, with_value ? initial : "{}",
                       comment_of(field));
  }

  /// Members in the order of their first mention, those of one instance together.
  template <class Line>
  static std::string grouped(const std::vector<Member>& members, Line line) {
    std::string text;
    std::vector<bool> printed(members.size(), false);
    std::multimap<std::string, std::size_t> by_group;
    for (std::size_t i = 0; i < members.size(); ++i) {
      by_group.emplace(members[i].group, i);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (printed[i]) {
        continue;
      }
      if (members[i].group.empty()) {
        text += line(i, "  ");
        continue;
      }
      text += "  struct {\n";
      const auto [first, last] = by_group.equal_range(members[i].group);
      for (auto one = first; one != last; ++one) {
        printed[one->second] = true;
        text += line(one->second, "    ");
      }
      text += fmt::format("  }} {};\n", members[i].group);
    }
    return text;
  }

  std::string structs() const {
    std::string text = "struct Params {\n";
    text += grouped(parameter_members_, [&](std::size_t i, std::string_view indent) {
      return member_line(graph_.parameters[i].field, parameter_members_[i].name, graph_.parameters[i].value, indent,
                         true);
    });
    text += "};\n\nstruct State {\n";
    text += grouped(cell_members_, [&](std::size_t i, std::string_view indent) {
      return member_line(routine_.cells[i].field, cell_members_[i].name, {}, indent, false);
    });
    text += "};\n\n";
    text += port_struct("In", graph_.inputs, input_names_);
    text += port_struct("Out", graph_.outputs, output_names_);
    return text;
  }

  std::string port_struct(std::string_view name, const std::vector<Port>& ports,
                          const std::vector<std::string>& names) const {
    std::string text = fmt::format("struct {} {{\n", name);
    for (std::size_t i = 0; i < ports.size(); ++i) {
      Field field;
      field.unit = ports[i].unit;
      field.meaning = ports[i].meaning;
      text += fmt::format("  {} {} = {};{}\n", cpp_type(ports[i].type), names[i],
                          expressions_.literal(ports[i].type, ports[i].preset), comment_of(field));
    }
    return text + "};\n\n";
  }

  static std::string helper_functions(const std::string& body) {
    std::string text;
    const bool wraps = std::ranges::any_of(helpers,
                                           [&](const Helper& one) {
                                             return one.text.find("return wrap(") != std::string_view::npos &&
                                                    body.find(one.name) != std::string::npos;
                                           }) ||
                       body.find("detail::wrap(") != std::string::npos;
    for (const Helper& helper : helpers) {
      if (body.find(helper.name) != std::string::npos || (helper.name == "detail::wrap(" && wraps)) {
        text += std::string(helper.text) + "\n";
      }
    }
    return text.empty() ? text : "namespace detail {\n\n" + text + "}  // namespace detail\n\n";
  }

  // --- functions ---

  std::string functions() {
    std::string reset_body = statements(routine_.reset);
    std::string step_body = statements(routine_.step);
    if (routine_.longest_period > 1) {
      const std::string& counter = expressions_.cells[routine_.counter];
      step_body += fmt::format("  {0} = {0} + 1 < {1} ? {0} + 1 : 0;\n", counter, routine_.longest_period);
    }
    const auto used = [](const std::string& body, std::string_view prefix) {
      return body.find(prefix) != std::string::npos;
    };
    std::string text = "/// Puts the state to its beginning.\n";
    text += fmt::format("inline void reset(const Params&{}, State&{}) noexcept {{\n{}}}\n\n",
                        used(reset_body, "params.") ? " params" : "", used(reset_body, "state.") ? " state" : "",
                        reset_body);
    text += "/// One step: outputs from inputs and state, and the state moved on.\n";
    text += fmt::format(
        "inline Out step(const Params&{}, State&{}, const In&{}) noexcept {{\n  Out out;\n{}  return out;\n}}\n\n",
        used(step_body, "params.") ? " params" : "", used(step_body, "state.") ? " state" : "",
        used(step_body, "in.") ? " in" : "", step_body);
    return text;
  }

  std::string statements(const std::vector<Statement>& list) {
    const auto uses = count_uses(routine_.tape, list);
    own_names_.assign(routine_.tape.size(), {});
    for (const Statement& statement : list) {
      if (statement.kind == Statement::Kind::Define && statement.target == 1 && own_names_[statement.value].empty()) {
        own_names_[statement.value] = statement.name;
      }
    }
    std::string text;
    std::string indent = "  ";
    std::string section;
    std::uint32_t section_node = 0;
    for (const Statement& statement : list) {
      switch (statement.kind) {
        case Statement::Kind::Section:
          section_node = statement.target;
          section = section_comment(statement.target, indent);
          continue;
        case Statement::Kind::BeginRate:
          text += fmt::format("{}if ({} % {} == {}) {{\n", indent, expressions_.cells[routine_.counter],
                              statement.rate.every, statement.rate.phase);
          indent = "    ";
          continue;
        case Statement::Kind::EndRate:
          indent = "  ";
          text += indent + "}\n";
          continue;
        default:
          break;
      }
      std::string lines;
      const std::string_view owner =
          graph_.nodes.empty() ? std::string_view("step") : std::string_view(graph_.nodes[section_node].path);
      if (statement.kind == Statement::Kind::Define) {
        const bool worth_a_name = statement.target == 1 || uses[statement.value] > 1;
        if (!worth_a_name || expressions_.is_named(statement.value)) {
          continue;
        }
        name_shared(statement.value, uses, owner, indent, lines, false);
        const std::string expression = expressions_.text(statement.value);
        const std::string name = locals_.make(statement.name);
        lines += fmt::format("{}const {} {} = {};\n", indent, cpp_type(routine_.tape[statement.value].type), name,
                             expression);
        expressions_.name(statement.value, name);
      } else {
        name_shared(statement.value, uses, owner, indent, lines, true);
        if (statement.index != no_value) {
          name_shared(statement.index, uses, owner, indent, lines, true);
        }
        const std::string value = expressions_.text(statement.value);
        if (statement.kind == Statement::Kind::SetOutput) {
          lines += fmt::format("{}out.{} = {};\n", indent, output_names_[statement.target], value);
        } else if (statement.kind == Statement::Kind::SetCell) {
          lines += fmt::format("{}{} = {};\n", indent, expressions_.cells[statement.target], value);
        } else if (statement.index == no_value) {
          lines += fmt::format("{}{}.fill({});\n", indent, expressions_.cells[statement.target], value);
        } else {
          lines += fmt::format("{}detail::store({}, {}, {});\n", indent, expressions_.cells[statement.target],
                               expressions_.text(statement.index), value);
        }
      }
      text += section + lines;
      section.clear();
    }
    return text;
  }

  std::string section_comment(std::uint32_t index, std::string_view indent) const {
    const Node& node = graph_.nodes[index];
    return node.block != nullptr ? fmt::format("\n{}// {} : {}\n", indent, node.path, node.block->about.name)
                                 : std::string();
  }

  /// Gives a name to every value below a root that is used more than once.
  void name_shared(ValueId root, const std::vector<std::uint32_t>& uses, std::string_view owner,
                   std::string_view indent, std::string& lines, bool with_root) {
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
        const std::string_view own = own_names_[id];
        if ((uses[id] > 1 || !own.empty()) && (with_root || id != root)) {
          const std::string expression = expressions_.text(id);
          const std::string name =
              locals_.make(own.empty() ? fmt::format("{}_t", owner.substr(0, owner.find('#'))) : std::string(own));
          lines += fmt::format("{}const {} {} = {};\n", indent, cpp_type(value.type), name, expression);
          expressions_.name(id, name);
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
  Identifiers locals_;
  std::vector<std::string> input_names_;
  std::vector<std::string> output_names_;
  std::vector<Member> parameter_members_;
  std::vector<Member> cell_members_;
  std::vector<std::string_view> own_names_;  ///< by value: the output or next state that it is
};

void require_sample_time(const Graph& graph) {
  if (graph.sample_time_ns <= 0) {
    throw InputError(error::missing_sample_time, {.file = graph.source ? graph.source->path : std::string()},
                     "the diagram states no sample time",
                     fmt::format("Write it behind the name: FUNCTION_BLOCK {} (* @ts 1ms *).", graph.name));
  }
}

}  // namespace

GeneratedFile generate_cpp_header(const Program& program, const CppOptions& options) {
  require_sample_time(program.graph);
  return CppHeader(program, options).run();
}

std::vector<GeneratedFile> generate_cpp(const Program& program, const CppOptions& options) {
  return {generate_cpp_header(program, options), cpp_host_main(program), cpp_host_cmake(program)};
}

}  // namespace hysteron
