#include "codegen/backends/plcopen/network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "codegen/backends/plcopen/interface.hpp"
#include "codegen/backends/plcopen/known_values.hpp"
#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/st/printer.hpp"
#include "codegen/backends/st/words.hpp"
#include "codegen/graph/text_order.hpp"
#include "codegen/language/references.hpp"
#include "codegen/plcopen/functions.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::plcopen {
namespace {

using language::ExpressionId;
using language::upper;

constexpr std::size_t never = std::numeric_limits<std::size_t>::max();

/// A value on its way to its reader. Up to statement `until` it may be taken from the wire; then the block has moved
/// on.
struct Signal {
  Source source{};
  Type type = Type::Real;
  std::size_t until = never;
};

class NetworkBuilder {
 public:
  NetworkBuilder(const Definitions& definitions, std::uint32_t index, const KnownValues& values,
                 const NetworkOptions& options, Diagnostics& diagnostics)
      : definitions_(definitions),
        definition_(definitions.list[index]),
        index_(index),
        values_(values),
        options_(options),
        diagnostics_(diagnostics),
        graph_(elaborate(definitions, index, ignored_)) {}

  Network run() {
    network_.name = definition_.block->name.text;
    names_ = names_in(definition_, identifiers_);
    const auto& statements = definition_.block->statements;
    const std::vector<std::uint32_t> order = statement_order(definitions_, index_, graph_);
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (const auto* call = std::get_if<language::Call>(&statements[order[i]])) {
        call_at_[upper(call->instance.text)] = {
            .statement = i, .element = add({.kind = Element::Kind::Block, .instance = name_of(call->instance.text)})};
      }
    }
    remember_first(order);
    for (now_ = 0; now_ < order.size(); ++now_) {
      if (const auto* call = std::get_if<language::Call>(&statements[order[now_]])) {
        write_call(*call);
      } else {
        write_assignment(std::get<language::Assignment>(statements[order[now_]]));
      }
    }
    if (!started_.empty()) {
      assign(started_, {.source = literal(Type::Bool, 1.0)});
    }
    network_.sections = interface_of(definitions_, index_, values_, names_, options_);
    if (!added_.empty()) {
      network_.sections.push_back({.keyword = "VAR", .variables = std::move(added_)});
    }
    return std::move(network_);
  }

  /// Notes which outputs of the blocks of the library hand out memory alone here. A block is one POU for all instances,
  /// so they must be alike.
  void note_library(std::map<std::string_view, Networks::Used>& library) {
    for (const Declared& declared : definition_.variables) {
      const auto node = declared.kind == Declared::Kind::LibraryBlock ? node_of(declared) : std::nullopt;
      if (!node) {
        continue;
      }
      std::vector<bool> ahead;
      for (std::size_t output = 0; output < declared.block->outputs.size(); ++output) {
        ahead.push_back(is_remembered(graph_, graph_.nodes[*node], output));
      }
      const auto [known, added] =
          library.try_emplace(declared.block->about.name, Networks::Used{declared.block, ahead});
      if (!added && known->second.ahead != ahead) {
        refuse(
            declared.variable->name.span,
            fmt::format("{} is wired so that it hands out memory alone, and another {} is not, or the other way round",
                        declared.field.name, declared.block->about.name),
            "Wire the same pins of both, or generate with --body st.");
      }
    }
  }

 private:
  struct Called {
    std::size_t statement = 0;
    std::size_t element = 0;
  };

  void refuse(language::Span span, std::string cause, std::string mend) {
    diagnostics_.error(error::no_network, definitions_.source->place(span), std::move(cause), std::move(mend));
  }

  // --- names and declarations ---

  [[nodiscard]] std::string name_of(std::string_view variable) const { return names_.at(upper(variable)); }

  std::string new_variable(std::initializer_list<std::string_view> parts, Type type) {
    std::string name(identifiers_.make(parts));
    added_.push_back({.name = name, .type = std::string(st_type(type, options_.float32))});
    return name;
  }

  // --- elements ---

  std::size_t add(Element element) {
    network_.elements.push_back(std::move(element));
    return network_.elements.size() - 1;
  }

  [[nodiscard]] std::string plain(Type type, double value) const {
    return st_literal(type, value, {.float32 = options_.float32, .small_literals = options_.small_literals});
  }

  /// With its type, so that no compiler takes it for another.
  Source literal(Type type, double value) {
    std::string text = plain(type, value);
    if (type == Type::Real) {
      text = (options_.float32 ? "REAL#" : "LREAL#") + text;
    } else if (type == Type::Int) {
      text = "DINT#" + text;
    }
    return read(std::move(text));
  }

  Source read(std::string text) { return {.element = add({.kind = Element::Kind::Read, .text = std::move(text)})}; }

  /// A block that has not run yet is read by its name: editors run what a wire comes from before they assign.
  void assign(const std::string& target, const Signal& value) {
    Element element{.kind = Element::Kind::Assign, .text = target, .order = ++order_};
    const Element& from = network_.elements[value.source.element];
    const bool is_late = from.kind == Element::Kind::Block && from.order == 0;
    element.inputs.push_back(
        {.from = is_late ? read(fmt::format("{}.{}", from.instance, value.source.pin)) : value.source});
    add(std::move(element));
  }

  Signal function(std::string_view name, const std::vector<Signal>& arguments, Type type) {
    Element element{.kind = Element::Kind::Block, .text = std::string(name), .order = ++order_};
    Signal result{.type = type};
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      element.inputs.push_back({.pin = input_of(name, i), .from = arguments[i].source});
      result.until = std::min(result.until, arguments[i].until);
    }
    element.outputs.emplace_back(function_output);
    result.source = {.element = add(std::move(element)), .pin = std::string(function_output)};
    return result;
  }

  // --- what is remembered, and read behind the call ---

  /// An output of memory alone that is read behind the call gets a variable first: the call moves it on.
  void remember_first(const std::vector<std::uint32_t>& order) {
    for (now_ = 0; now_ < order.size(); ++now_) {
      const auto& statement = definition_.block->statements[order[now_]];
      const auto look = [&](ExpressionId id) {
        for_each_reference(*definitions_.source, id, [&](const language::Reference& reference) {
          const Declared& declared = find(reference.name.text);
          const auto node = declared.kind == Declared::Kind::LibraryBlock ? node_of(declared) : std::nullopt;
          if (!node || now_ <= call_at_.at(upper(declared.field.name)).statement) {
            return;
          }
          const std::size_t output = output_of(*declared.block, reference.pin.text);
          const std::string key = upper(fmt::format("{}.{}", declared.field.name, reference.pin.text));
          if (is_remembered(graph_, graph_.nodes[*node], output) && !kept_.contains(key)) {
            const Type type = declared.block->outputs[output].type;
            const std::string name = new_variable({declared.field.name, declared.block->outputs[output].name}, type);
            const std::size_t back = now_;
            now_ = 0;
            assign(name, remembered(declared, *node, output, reference.name.span));
            now_ = back;
            kept_[key] = name;
          }
        });
      };
      if (const auto* call = std::get_if<language::Call>(&statement)) {
        std::ranges::for_each(call->arguments, [&](const auto& argument) { look(argument.value); });
      } else {
        look(std::get<language::Assignment>(statement).value);
      }
    }
  }

  /// Read from the wire before the call. Before the very first call a PLC has 0 there, so another start is chosen.
  Signal remembered(const Declared& declared, std::uint32_t node, std::size_t output, language::Span span) {
    const Called& called = call_at_.at(upper(declared.field.name));
    const Field& field = declared.block->outputs[output];
    Signal signal{.source = {.element = called.element, .pin = std::string(field.name)},
                  .type = field.type,
                  .until = called.statement};
    const KnownValues::Answer start = values_.start(index_, graph_.nodes[node].path, output);
    if (!start.value) {
      refuse(span,
             fmt::format("instances of {} begin with different values of {}.{}", network_.name, declared.field.name,
                         field.name),
             "Generate with --body st.");
      return signal;
    }
    if (*start.value == 0.0) {
      return signal;
    }
    if (started_.empty()) {
      started_ = new_variable({"STARTED"}, Type::Bool);
    }
    return function("SEL", {{.source = read(started_)}, {.source = literal(field.type, *start.value)}, signal},
                    field.type);
  }

  // --- statements ---

  void write_assignment(const language::Assignment& assignment) {
    const Signal value = signal_of(assignment.value);
    assign(name_of(assignment.target.text), value);
    assigned_[upper(assignment.target.text)] = value;
  }

  void write_call(const language::Call& call) {
    const Declared& declared = find(call.instance.text);
    const std::size_t place = call_at_.at(upper(call.instance.text)).element;
    Element element{.kind = Element::Kind::Block, .instance = name_of(declared.field.name)};
    if (declared.rate.every != 1) {
      refuse(call.instance.span, fmt::format("{} runs in every {}th step", declared.field.name, declared.rate.every),
             "Generate with --body st, or give the slower part a task of its own.");
    }
    if (declared.kind == Declared::Kind::LibraryBlock) {
      write_library_call(declared, call, element);
    } else {
      const Definition& inner = definitions_.list[declared.definition];
      const auto names = names_inside(declared);
      element.text = inner.block->name.text;
      for (const Declared& pin : inner.variables) {
        const std::size_t before = element.inputs.size();
        if (pin.kind == Declared::Kind::Input || pin.kind == Declared::Kind::Parameter) {
          write_pin(declared, call, pin.field, pin.kind == Declared::Kind::Parameter, element);
        } else if (pin.kind == Declared::Kind::Output) {
          element.outputs.push_back(names.at(upper(pin.field.name)));
        }
        if (element.inputs.size() > before) {
          element.inputs.back().pin = names.at(upper(pin.field.name));
        }
      }
    }
    element.order = ++order_;
    network_.elements[place] = std::move(element);
  }

  void write_library_call(const Declared& declared, const language::Call& call, Element& element) {
    const BlockType& block = *declared.block;
    element.text = block.about.name;
    for (std::size_t pin = 0; pin < block.pin_count(); ++pin) {
      write_pin(declared, call, block.pin(pin), pin >= block.inputs.size(), element);
    }
    for (const Field& output : block.outputs) {
      element.outputs.emplace_back(output.name);
    }
  }

  /// A pin has the parameter's value where it is one, else what the call or the declaration gives it.
  void write_pin(const Declared& declared, const language::Call& call, const Field& field, bool is_parameter,
                 Element& element) {
    if (is_parameter) {
      const auto own = values_.parameter(index_, fmt::format("{}.{}", declared.field.name, field.name));
      if (own.known && !own.value) {
        const bool array = field.length > 1;
        refuse(call.instance.span,
               array ? fmt::format("{}.{} is an array, which no wire carries", declared.field.name, field.name)
                     : fmt::format("{}.{} has another value in each instance of {}", declared.field.name, field.name,
                                   network_.name),
               array ? "Generate with --body st." : "Make it an input of the block, or generate with --body st.");
        return;
      }
      if (own.known) {
        if (*own.value != field.preset) {
          element.inputs.push_back({.pin = std::string(field.name), .from = literal(field.type, *own.value)});
        }
        return;
      }
    }
    for (const auto* list : {&call.arguments, &declared.variable->settings}) {
      for (const language::Argument& argument : *list) {
        if (language::same_name(argument.pin.text, field.name)) {
          const Signal value = signal_of(argument.value);
          element.inputs.push_back({.pin = std::string(field.name), .from = value.source});
          return;
        }
      }
    }
  }

  // --- expressions ---

  Signal signal_of(ExpressionId id) {
    const auto& node = definitions_.source->expressions[id].node;
    double value = 0.0;
    if (Type type{}; constant_value(*definitions_.source, id, value, type)) {
      return {.source = literal(type, value), .type = type};
    }
    if (const auto* reference = std::get_if<language::Reference>(&node)) {
      return signal_of(*reference);
    }
    if (const auto* unary = std::get_if<language::Unary>(&node)) {
      const Signal operand = signal_of(unary->operand);
      if (unary->op == language::Operator::Not) {
        return function("NOT", {operand}, operand.type);
      }
      const Signal minus{.source = literal(operand.type, -1.0)};
      return function("MUL", {operand, minus}, operand.type);
    }
    if (const auto* binary = std::get_if<language::Binary>(&node)) {
      const OperatorFunction& own = function_of(binary->op);
      const Signal left = signal_of(binary->left);
      Signal right = signal_of(binary->right);
      if (binary->op == language::Operator::Power) {
        right = exponent(binary->right, right);
      }
      return function(own.name, {left, right}, own.is_comparison ? Type::Bool : left.type);
    }
    return signal_of(std::get<language::FunctionCall>(node), definitions_.source->expressions[id].span);
  }

  /// A whole exponent counts as a real one.
  Signal exponent(ExpressionId id, const Signal& written) {
    double value = 0.0;
    if (Type type{}; written.type == Type::Int && constant_value(*definitions_.source, id, value, type)) {
      network_.elements[written.source.element].text =
          (options_.float32 ? "REAL#" : "LREAL#") + plain(Type::Real, value);
      return {.source = written.source};
    }
    return written.type == Type::Int ? function("DINT_TO_LREAL", {written}, Type::Real) : written;
  }

  Signal signal_of(const language::FunctionCall& call, language::Span span) {
    const std::string name = upper(call.function.text);
    if (name == "ATAN2") {
      refuse(span, "ATAN2 is no function of IEC 61131-3", "Write it with ATAN, or generate with --body st.");
      return {.source = literal(Type::Real, 0.0)};  // so that the rest is looked through too
    }
    std::vector<Signal> arguments(call.arguments.size());
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      const auto& argument = call.arguments[i];
      const auto place = argument.formal.text.empty() ? std::optional(i) : place_of(name, argument.formal.text);
      arguments.at(place.value_or(i)) = signal_of(argument.value);
    }
    if (name == "EXPT") {
      arguments.at(1) = exponent(call.arguments.at(1).value, arguments.at(1));
    }
    return function(name, arguments, result_of(name, arguments));
  }

  [[nodiscard]] static Type result_of(std::string_view name, const std::vector<Signal>& arguments) {
    if (name == "TRUNC" || name.ends_with("_TO_DINT")) {
      return Type::Int;
    }
    return name.ends_with("_TO_LREAL") ? Type::Real : arguments.back().type;
  }

  Signal signal_of(const language::Reference& reference) {
    const Declared& declared = find(reference.name.text);
    if (declared.kind == Declared::Kind::LibraryBlock) {
      return output_signal(declared, reference);
    }
    if (declared.kind == Declared::Kind::UserBlock) {
      const Called& called = call_at_.at(upper(declared.field.name));
      const Definition& inner = definitions_.list[declared.definition];
      const Declared& output = inner.variables[inner.by_name.at(reference.pin.text)];
      if (now_ <= called.statement) {
        refuse(reference.name.span,
               fmt::format("{}.{} is read before {} is called, and an IEC compiler assigns it in the call",
                           declared.field.name, output.field.name, declared.field.name),
               "Put the delay that closes the loop outside of the block, or generate with --body st.");
      }
      return {.source = {.element = called.element, .pin = names_inside(declared).at(upper(output.field.name))},
              .type = output.field.type};
    }
    const auto value = assigned_.find(upper(declared.field.name));
    if (value != assigned_.end() && now_ <= value->second.until) {
      return value->second;
    }
    return {.source = read(name_of(declared.field.name)), .type = declared.field.type};
  }

  Signal output_signal(const Declared& declared, const language::Reference& reference) {
    const Called& called = call_at_.at(upper(declared.field.name));
    const std::size_t output = output_of(*declared.block, reference.pin.text);
    const Field& field = declared.block->outputs[output];
    const auto node = node_of(declared);
    if (node && is_remembered(graph_, graph_.nodes[*node], output)) {
      const auto kept = kept_.find(upper(fmt::format("{}.{}", declared.field.name, field.name)));
      return kept == kept_.end() ? remembered(declared, *node, output, reference.name.span)
                                 : Signal{.source = read(kept->second), .type = field.type};
    }
    return {.source = {.element = called.element, .pin = std::string(field.name)}, .type = field.type};
  }

  // --- looking things up ---

  [[nodiscard]] const Declared& find(std::string_view name) const {
    return definition_.variables[definition_.by_name.at(name)];
  }

  [[nodiscard]] std::map<std::string, std::string> names_inside(const Declared& declared) const {
    Identifiers identifiers(is_st_word, LetterCase::Upper);
    return names_in(definitions_.list[declared.definition], identifiers);
  }

  [[nodiscard]] std::optional<std::uint32_t> node_of(const Declared& declared) const {
    for (std::uint32_t i = 0; i < graph_.nodes.size(); ++i) {
      if (graph_.nodes[i].block != nullptr && language::same_name(graph_.nodes[i].path, declared.field.name)) {
        return i;
      }
    }
    return std::nullopt;
  }

  static std::size_t output_of(const BlockType& block, std::string_view name) {
    std::size_t output = 0;
    while (!language::same_name(block.outputs[output].name, name)) {
      ++output;
    }
    return output;
  }

  const Definitions& definitions_;
  const Definition& definition_;
  std::uint32_t index_;
  const KnownValues& values_;
  NetworkOptions options_;
  Diagnostics& diagnostics_;
  Diagnostics ignored_;  ///< none: the text has been compiled
  Graph graph_;
  Network network_;
  Identifiers identifiers_{is_st_word, LetterCase::Upper};
  std::map<std::string, std::string> names_;  ///< by variable, in upper case
  std::vector<StVariable> added_;
  std::map<std::string, Called> call_at_;    ///< by instance
  std::map<std::string, Signal> assigned_;   ///< by variable
  std::map<std::string, std::string> kept_;  ///< by output of memory that is read behind its call: the variable
  std::string started_;
  std::size_t now_ = 0;  ///< the statement at hand
  std::uint32_t order_ = 0;
};

}  // namespace

Networks make_networks(const Program& program, const NetworkOptions& options) {
  Diagnostics ignored;
  const Definitions definitions = define(program.graph.source, ignored);
  const KnownValues values(program, definitions);
  Networks made;
  Diagnostics diagnostics;
  std::map<std::string_view, Networks::Used> library;
  for (const std::uint32_t index : definitions.callees_first) {
    if (!values.is_used(index)) {
      continue;
    }
    NetworkBuilder builder(definitions, index, values, options, diagnostics);
    builder.note_library(library);
    made.list.push_back(builder.run());
  }
  if (diagnostics.has_errors()) {
    throw InputError(std::move(diagnostics));
  }
  for (auto& [name, used] : library) {
    made.library.push_back(std::move(used));
  }
  return made;
}

}  // namespace hysteron::plcopen
