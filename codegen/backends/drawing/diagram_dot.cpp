#include "codegen/backends/drawing/diagram_dot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/backends/drawing/body_text.hpp"
#include "codegen/backends/drawing/box_label.hpp"
#include "codegen/backends/drawing/dot_text.hpp"
#include "codegen/graph/definition.hpp"
#include "codegen/graph/units.hpp"
#include "codegen/language/references.hpp"

namespace hysteron {
namespace {

using language::ExpressionId;
using language::upper;

// Colours that differ in a grey copy too.
constexpr std::string_view port_fill = "#d5e8d4";
constexpr std::string_view parameter_fill = "#fff2cc";
constexpr std::string_view block_fill = "#dae8fc";
constexpr std::string_view expression_fill = "#f5f5f5";

/// Where a signal comes from: a box, its port where it has several, the type that it carries.
struct Source {
  std::string box{};
  std::string port{};
  Type type = Type::Real;
  std::string passed{};       ///< the variable that hands it on, to be written at the wire
  std::size_t statement = 0;  ///< that works it out, counted from 1; 0: an input
};

class Drawing {
 public:
  explicit Drawing(const Program& program) : definitions_(define(program.graph.source, diagnostics_)) {
    const units::Solution solution(program.graph, program.schedule);
    const auto outputs = solution.outputs();
    for (std::size_t i = 0; i < program.graph.nodes.size(); ++i) {
      const Node& node = program.graph.nodes[i];
      for (std::size_t port = 0; node.block != nullptr && port < node.block->outputs.size(); ++port) {
        units_[upper(fmt::format("{}.{}", node.path, node.block->outputs[port].name))] = outputs[i][port];
      }
    }
    name_ = program.graph.name;
    sample_time_ns_ = program.graph.sample_time_ns;
  }

  DiagramDot run() {
    const Definition& top = definitions_.list[definitions_.by_name.at(name_)];
    std::string title = fmt::format("<B>{}</B>", dot::escaped(name_));
    if (sample_time_ns_ > 0) {
      title += dot::small_text("  TS = " + dot::duration_of(sample_time_ns_));
    }
    for (const auto& annotation : top.block->annotations) {
      if (annotation.key == "doc") {
        title += "<BR/>" + dot::small_text(annotation.value);
      }
    }
    text_ = dot::opening(name_, title);
    draw(top, "", 1);
    text_ += "\n" + edges_ + "}\n";
    return {.text = std::move(text_), .boxes = boxes_};
  }

 private:
  /// What is known of one instance of a definition while it is drawn.
  struct Scope {
    const Definition* definition = nullptr;
    std::string prefix{};                            ///< "" at the top, else ending in a dot
    std::map<std::string, ExpressionId> assigned{};  ///< by variable
    std::map<std::string, std::size_t> statement{};  ///< by variable and instance: the one that works it out, from 1
    std::set<std::string> drawn{};                   ///< variables whose expression has a box
    std::size_t level = 0;
  };

  void line(std::size_t level, const std::string& text) { text_ += std::string(2 * level, ' ') + text + "\n"; }

  void box(std::size_t level, const std::string& name, const std::string& label, std::string_view fill,
           std::string_view more = "") {
    ++boxes_;
    line(level, fmt::format("{} [label=<{}>, fillcolor=\"{}\"{}];", dot::quoted(name), label, fill, more));
  }

  /// `reader` is the statement that reads it, from 1. What is read before it is worked out is feedback: it is written
  /// from its end to its beginning, so that Graphviz puts the reader at the left.
  void edge(const Source& from, const std::string& to, std::string_view port, std::size_t reader) {
    const auto end = [](const std::string& name, std::string_view pin, std::string_view side) {
      return pin.empty() ? dot::quoted(name) : fmt::format("{}:{}:{}", dot::quoted(name), dot::quoted(pin), side);
    };
    std::vector<std::string> style;
    if (!from.passed.empty()) {
      style.push_back(fmt::format("label=<{}>", dot::escaped(from.passed)));
    }
    if (from.type == Type::Bool) {
      style.emplace_back("style=dashed");
    } else if (from.type != Type::Real) {
      style.emplace_back("color=\"#1f4e9c\"");
    }
    const bool feedback = from.statement >= reader;
    if (feedback) {
      style.emplace_back("dir=back");
    }
    const std::string begin = end(from.box, from.port, "e");
    const std::string target = end(to, port, "w");
    edges_ += fmt::format("  {} -> {}{};\n", feedback ? target : begin, feedback ? begin : target,
                          style.empty() ? "" : fmt::format(" [{}]", fmt::join(style, ", ")));
  }

  // --- a block of the text: its ports, its instances, its expressions ---

  void draw(const Definition& definition, const std::string& prefix, std::size_t level) {
    Scope scope{.definition = &definition, .prefix = prefix, .level = level};
    const auto& statements = definition.block->statements;
    for (std::size_t i = 0; i < statements.size(); ++i) {
      if (const auto* assignment = std::get_if<language::Assignment>(&statements[i])) {
        scope.assigned[upper(assignment->target.text)] = assignment->value;
        scope.statement[upper(assignment->target.text)] = i + 1;
      } else {
        scope.statement[upper(std::get<language::Call>(statements[i]).instance.text)] = i + 1;
      }
    }
    draw_ports(scope, Declared::Kind::Input, "source");
    draw_ports(scope, Declared::Kind::Parameter, "source");
    for (const auto& statement : statements) {
      if (const auto* call = std::get_if<language::Call>(&statement)) {
        draw_instance(scope, *call);
      } else {
        const auto& assignment = std::get<language::Assignment>(statement);
        if (!is_reference(assignment.value)) {
          draw_expression(scope, prefix + std::string(assignment.target.text), assignment.value,
                          std::string(assignment.target.text) + " := ");
          scope.drawn.insert(upper(assignment.target.text));
        }
      }
    }
    draw_ports(scope, Declared::Kind::Output, "sink");
    if (definition.block->sequential) {
      return draw_body_by_itself(scope);
    }
    for (const Declared& declared : definition.variables) {
      if (declared.kind == Declared::Kind::Output) {
        if (auto from = source_of_variable(scope, declared)) {
          edge(*from, port_box(scope, declared), "", statements.size() + 1);
        }
      }
    }
    for (std::size_t i = 0; i < statements.size(); ++i) {
      if (const auto* call = std::get_if<language::Call>(&statements[i])) {
        connect(scope, *call, i + 1);
      } else if (const auto& assignment = std::get<language::Assignment>(statements[i]);
                 scope.drawn.contains(upper(assignment.target.text))) {
        connect_expression(scope, prefix + std::string(assignment.target.text), assignment.value, i + 1);
      }
    }
  }

  /// A port and an expression that is assigned to it are two boxes.
  static std::string port_box(const Scope& scope, const Declared& declared) {
    return fmt::format("{}{} (port)", scope.prefix, declared.field.name);
  }

  void draw_ports(const Scope& scope, Declared::Kind kind, std::string_view rank) {
    std::vector<const Declared*> ports;
    for (const Declared& declared : scope.definition->variables) {
      if (declared.kind == kind && (scope.level == 1 || kind == Declared::Kind::Output || is_driven(scope, declared))) {
        ports.push_back(&declared);
      }
    }
    if (ports.empty()) {
      return;
    }
    const bool at_border = scope.level == 1;  // ranks at the ends are those of the whole picture
    if (at_border) {
      line(scope.level, fmt::format("{{ rank={};", rank));
    }
    for (const Declared* const port : ports) {
      box(scope.level + (at_border ? 1 : 0), port_box(scope, *port), dot::with_unit(port->field.name, port->field.unit),
          kind == Declared::Kind::Parameter ? parameter_fill : port_fill,
          kind == Declared::Kind::Parameter ? ", style=\"rounded,filled,dashed\"" : ", style=filled");
    }
    if (at_border) {
      line(scope.level, "}");
    }
  }

  /// Whether a wire leads to an input of a nested block.
  [[nodiscard]] bool is_driven(const Scope& scope, const Declared& declared) const {
    return driven_.contains(upper(scope.prefix + std::string(declared.field.name)));
  }
  [[nodiscard]] bool is_reference(ExpressionId id) const {
    return std::holds_alternative<language::Reference>(expression(id).node);
  }
  [[nodiscard]] bool is_constant(const Scope& scope, ExpressionId id) const {
    bool constant = true;
    language::for_each_reference(*definitions_.source, id, [&](const language::Reference& reference) {
      const Declared* declared = find(*scope.definition, reference.name.text);
      constant = constant && declared != nullptr && declared->kind == Declared::Kind::Constant;
    });
    return constant;
  }

  void draw_expression(const Scope& scope, const std::string& name, ExpressionId id, const std::string& before = "") {
    box(scope.level, name, dot::broken(before + text_of(id)), expression_fill);
  }

  void draw_instance(const Scope& scope, const language::Call& call) {
    const Declared* const declared = find(*scope.definition, call.instance.text);
    const std::string path = scope.prefix + std::string(declared->field.name);
    for (const auto& argument : call.arguments) {
      if (!is_reference(argument.value) && !is_constant(scope, argument.value)) {
        draw_expression(scope, pin_box(path, argument), argument.value);
      }
      if (!is_constant(scope, argument.value)) {
        driven_.insert(upper(path + "." + std::string(argument.pin.text)));
      }
    }
    if (declared->kind == Declared::Kind::LibraryBlock) {
      return draw_library(scope, *declared, call, path);
    }
    const Definition& inner = definitions_.list[declared->definition];
    if (inner.block->sequential) {
      return draw_body(scope, *declared, call, path);
    }
    line(scope.level, fmt::format("subgraph {} {{", dot::quoted("cluster_" + path)));
    line(scope.level + 1,
         fmt::format("graph [label=<<B>{}</B> {}>, style=\"rounded\", color=\"{}\", fontsize=11, margin=12];",
                     dot::escaped(declared->field.name),
                     dot::small_text(fmt::format("{}  {}", inner.block->name.text,
                                                 fmt::join(settings_of(*declared, call, scope), ", "))),
                     dot::faint));
    draw(inner, path + ".", scope.level + 1);
    line(scope.level, "}");
  }

  static std::string pin_box(const std::string& path, const language::Argument& argument) {
    return fmt::format("{}.{} (expression)", path, argument.pin.text);
  }

  /// What the text sets, and how often the instance runs.
  [[nodiscard]] std::vector<std::string> settings_of(const Declared& declared, const language::Call& call,
                                                     const Scope& scope) const {
    std::vector<std::string> list;
    const auto add = [&](const language::Argument& one) {
      list.push_back(fmt::format("{} = {}", one.pin.text, text_of(one.value)));
    };
    std::ranges::for_each(declared.variable->settings, add);
    for (const auto& argument : call.arguments) {
      if (is_constant(scope, argument.value)) {
        add(argument);
      }
    }
    if (declared.rate.every > 1) {
      list.push_back(fmt::format("@every {}", declared.rate.every));
    }
    return list;
  }

  [[nodiscard]] bool is_wired(const Scope& scope, const language::Call& call, std::string_view pin) const {
    return std::ranges::any_of(call.arguments, [&](const language::Argument& argument) {
      return language::same_name(argument.pin.text, pin) && !is_constant(scope, argument.value);
    });
  }

  void draw_library(const Scope& scope, const Declared& declared, const language::Call& call, const std::string& path) {
    const BlockType& block = *declared.block;
    dot::BoxLabel label(declared.field.name, block.about.name, settings_of(declared, call, scope));
    for (std::size_t pin = 0; pin < block.pin_count(); ++pin) {
      const Field& field = block.pin(pin);
      if (is_wired(scope, call, field.name)) {
        label.add_input(field.name, field.unit.find('\'') == std::string_view::npos ? field.unit : "");
      }
    }
    for (const Field& output : block.outputs) {
      if (is_read(scope, declared, output.name)) {
        const auto unit = units_.find(upper(fmt::format("{}.{}", path, output.name)));
        label.add_output(output.name, unit == units_.end() ? "" : unit->second);
      }
    }
    box(scope.level, path, label.text(), block_fill);
  }

  // --- a block with a sequential body: a box with its statements ---

  /// The statements of a body; of several instances the first shows them.
  std::string body_of(const Definition& definition) {
    const auto& source = *definitions_.source;
    return shown_bodies_.insert(&definition).second
               ? dot::body_text(source, source.bodies->units[definition.block->body])
               : std::string();
  }

  void draw_body(const Scope& scope, const Declared& declared, const language::Call& call, const std::string& path) {
    const Definition& inner = definitions_.list[declared.definition];
    dot::BoxLabel label(declared.field.name, inner.block->name.text, settings_of(declared, call, scope));
    for (const Declared& one : inner.variables) {
      if (is_input(one) && is_wired(scope, call, one.field.name)) {
        label.add_input(one.field.name, one.field.unit);
      } else if (one.kind == Declared::Kind::Output && is_read(scope, declared, one.field.name)) {
        label.add_output(one.field.name, one.field.unit);
      }
    }
    label.add_body(body_of(inner));
    box(scope.level, path, label.text(), block_fill);
  }

  /// The block that is drawn is a body itself: its statements stand between its ports.
  void draw_body_by_itself(const Scope& scope) {
    const std::string path = "(body)";
    dot::BoxLabel label(name_, "", {});
    for (const Declared& one : scope.definition->variables) {
      if (is_input(one)) {
        label.add_input(one.field.name, "");
        edge({.box = port_box(scope, one), .type = one.field.type}, path, dot::pin_port(one.field.name), 1);
      } else if (one.kind == Declared::Kind::Output) {
        label.add_output(one.field.name, "");
        const std::string port = dot::output_port(one.field.name);
        edge({.box = path, .port = port, .type = one.field.type}, port_box(scope, one), "", 1);
      }
    }
    label.add_body(body_of(*scope.definition));
    box(scope.level, path, label.text(), block_fill);
  }

  static bool is_input(const Declared& declared) {
    return declared.kind == Declared::Kind::Input || declared.kind == Declared::Kind::Parameter;
  }

  /// Whether any statement of the scope reads an output.
  [[nodiscard]] bool is_read(const Scope& scope, const Declared& declared, std::string_view output) const {
    bool read = false;
    const auto look = [&](ExpressionId id) {
      language::for_each_reference(*definitions_.source, id, [&](const language::Reference& reference) {
        read = read || (language::same_name(reference.name.text, declared.field.name) &&
                        language::same_name(reference.pin.text, output));
      });
    };
    for (const auto& statement : scope.definition->block->statements) {
      if (const auto* call = std::get_if<language::Call>(&statement)) {
        std::ranges::for_each(call->arguments, [&](const auto& argument) { look(argument.value); });
      } else {
        look(std::get<language::Assignment>(statement).value);
      }
    }
    return read;
  }

  // --- wires ---

  void connect(const Scope& scope, const language::Call& call, std::size_t reader) {
    const Declared* const declared = find(*scope.definition, call.instance.text);
    const std::string path = scope.prefix + std::string(declared->field.name);
    for (const auto& argument : call.arguments) {
      if (is_constant(scope, argument.value)) {
        continue;
      }
      const bool own = declared->kind == Declared::Kind::UserBlock;
      const Definition* const inner = own ? &definitions_.list[declared->definition] : nullptr;
      const Declared* const port = own ? find(*inner, argument.pin.text) : nullptr;
      const bool framed = own && !inner->block->sequential;
      const std::string to = framed ? fmt::format("{}.{} (port)", path, port->field.name) : path;
      const std::string pin = framed ? std::string() : dot::pin_port(argument.pin.text);
      if (const auto* reference = std::get_if<language::Reference>(&expression(argument.value).node)) {
        if (auto from = source_of(scope, *reference)) {
          edge(*from, to, pin, reader);
        }
      } else {
        edge({.box = pin_box(path, argument), .type = own ? port->field.type : pin_type(*declared->block, argument)},
             to, pin, reader);
        connect_expression(scope, pin_box(path, argument), argument.value, reader);
      }
    }
  }

  static Type pin_type(const BlockType& block, const language::Argument& argument) {
    for (std::size_t pin = 0; pin < block.pin_count(); ++pin) {
      if (language::same_name(block.pin(pin).name, argument.pin.text)) {
        return block.pin(pin).type;
      }
    }
    return Type::Real;
  }

  void connect_expression(const Scope& scope, const std::string& name, ExpressionId id, std::size_t reader) {
    std::set<std::pair<std::string, std::string>> known;  // U * U reads U twice
    language::for_each_reference(*definitions_.source, id, [&](const language::Reference& reference) {
      if (auto from = source_of(scope, reference); from && known.emplace(from->box, from->port).second) {
        from->passed.clear();  // the expression names it
        edge(*from, name, "", reader);
      }
    });
  }

  /// What drives a name; nothing for a constant.
  [[nodiscard]] std::optional<Source> source_of(const Scope& scope, const language::Reference& reference) const {
    const Declared* const declared = find(*scope.definition, reference.name.text);
    if (declared->kind == Declared::Kind::LibraryBlock) {
      for (const Field& output : declared->block->outputs) {
        if (language::same_name(output.name, reference.pin.text)) {
          return Source{.box = scope.prefix + std::string(declared->field.name),
                        .port = dot::output_port(output.name),
                        .type = output.type,
                        .statement = statement_of(scope, reference.name.text)};
        }
      }
    }
    if (declared->kind == Declared::Kind::UserBlock) {
      const Definition& inner = definitions_.list[declared->definition];
      const Declared* const output = find(inner, reference.pin.text);
      if (inner.block->sequential) {
        return Source{.box = scope.prefix + std::string(declared->field.name),
                      .port = dot::output_port(output->field.name),
                      .type = output->field.type,
                      .statement = statement_of(scope, reference.name.text)};
      }
      return Source{.box = fmt::format("{}{}.{} (port)", scope.prefix, declared->field.name, output->field.name),
                    .type = output->field.type,
                    .statement = statement_of(scope, reference.name.text)};
    }
    return source_of_variable(scope, *declared);
  }

  static std::size_t statement_of(const Scope& scope, std::string_view name) {
    const auto found = scope.statement.find(upper(name));
    return found == scope.statement.end() ? 0 : found->second;
  }

  [[nodiscard]] std::optional<Source> source_of_variable(const Scope& scope, const Declared& declared) const {
    const Type type = declared.field.type;
    if (declared.kind == Declared::Kind::Input || declared.kind == Declared::Kind::Parameter) {
      return scope.level == 1 || is_driven(scope, declared)
                 ? std::optional(Source{.box = port_box(scope, declared), .type = type})
                 : std::nullopt;
    }
    const std::string name = upper(declared.field.name);
    if (scope.drawn.contains(name)) {
      return Source{
          .box = scope.prefix + std::string(declared.field.name), .type = type, .statement = statement_of(scope, name)};
    }
    const auto value = scope.assigned.find(name);
    if (value == scope.assigned.end() || !is_reference(value->second)) {
      return std::nullopt;
    }
    auto source = source_of(scope, std::get<language::Reference>(expression(value->second).node));
    if (source && declared.kind == Declared::Kind::Local) {
      source->passed = declared.field.name;
    }
    return source;
  }

  // --- the text ---

  [[nodiscard]] const language::Expression& expression(ExpressionId id) const {
    return definitions_.source->expressions[id];
  }

  /// On one line.
  [[nodiscard]] std::string text_of(ExpressionId id) const {
    std::string text;
    for (const char c : definitions_.source->text_of(expression(id).span)) {
      const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
      if (!space || (!text.empty() && text.back() != ' ')) {
        text += space ? ' ' : c;
      }
    }
    return text;
  }

  static const Declared* find(const Definition& definition, std::string_view name) {
    return &definition.variables[definition.by_name.at(name)];
  }

  Diagnostics diagnostics_;  ///< none: the text has been compiled
  Definitions definitions_;
  std::map<std::string, std::string> units_;  ///< by output of a library block, in upper case
  std::string name_;
  std::int64_t sample_time_ns_ = 0;
  std::set<const Definition*> shown_bodies_;
  std::set<std::string> driven_;  ///< pins that wires lead to, in upper case
  std::string text_;
  std::string edges_;
  std::size_t boxes_ = 0;
};

}  // namespace

DiagramDot diagram_dot(const Program& program) {
  return Drawing(program).run();
}

}  // namespace hysteron
