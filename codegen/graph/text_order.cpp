#include "codegen/graph/text_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include "blocks/delay.hpp"
#include "blocks/delay_bool.hpp"
#include "blocks/delay_dint.hpp"
#include "blocks/delay_word.hpp"
#include "codegen/graph/components.hpp"
#include "codegen/graph/loop_cutter.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/graph/schedule.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

using language::upper;

/// On which side of a call or assignment a read has the same value here and in an IEC compiler.
enum class Side : std::uint8_t {
  Behind,        ///< depends on this step's inputs: before, an IEC compiler has last cycle's value, which is HY402
  RatherBehind,  ///< an output of a FUNCTION_BLOCK that memory alone decides: here it is this step's on both sides
  RatherBefore,  ///< the same of a block of the library, whose call moves its memory on
};

/// A read of a variable or of an instance's output in a statement.
struct Read {
  std::uint32_t statement = 0;
  std::uint32_t variable = 0;
  const language::Reference* reference = nullptr;
  Side side = Side::Behind;
  language::Span span{};
  std::string text{};
};

class Order {
 public:
  Order(const Definitions& definitions, std::uint32_t index, const Graph& graph)
      : definitions_(definitions), source_(*definitions.source), definition_(definitions.list[index]), graph_(graph) {
    for (std::uint32_t i = 0; i < graph.nodes.size(); ++i) {
      if (graph.nodes[i].block != nullptr) {
        nodes_.add(graph.nodes[i].path, i);
      }
    }
    const auto& statements = definition_.block->statements;
    writer_.assign(definition_.variables.size(), std::nullopt);
    for (std::uint32_t s = 0; s < statements.size(); ++s) {
      const auto* call = std::get_if<language::Call>(&statements[s]);
      const auto& name = call != nullptr ? call->instance : std::get<language::Assignment>(statements[s]).target;
      if (const std::uint32_t* const found = definition_.by_name.find(name.text)) {
        writer_[*found] = s;
      }
    }
    for (std::uint32_t s = 0; s < statements.size(); ++s) {
      if (const auto* call = std::get_if<language::Call>(&statements[s])) {
        for (const auto& argument : call->arguments) {
          collect(argument.value, s);
        }
      } else {
        collect(std::get<language::Assignment>(statements[s]).value, s);
      }
    }
  }

  void check(bool has_loops, Diagnostics& diagnostics) const {
    const std::vector<std::uint32_t> loop = has_loops ? circles(false) : std::vector<std::uint32_t>();
    std::optional<std::vector<std::uint32_t>> circle;  // looked for where something is told
    const auto in_circle = [&](std::uint32_t one, std::uint32_t other) {
      if (!circle) {
        circle = circles(true);
      }
      return (*circle)[one] == (*circle)[other];
    };
    std::set<std::pair<std::uint32_t, std::string>> told;  // X := X + (U - X) reads X twice, and is told once
    for (const Read& read : reads_) {
      const std::uint32_t writer = *writer_[read.variable];
      const bool before = read.statement <= writer;
      if (before == (read.side == Side::RatherBefore) ||
          (has_loops && !is_remembered(read) && loop[read.statement] == loop[writer])) {
        continue;
      }
      if (told.emplace(read.statement, upper(read.text)).second) {
        if (read.side == Side::Behind) {
          report_hidden_delay(read, writer, is_remembered(read) && in_circle(read.statement, writer), diagnostics);
        } else {
          report_other_meaning(read, writer, diagnostics);
        }
      }
    }
  }

  [[nodiscard]] std::unordered_set<const language::Reference*> remembered() const {
    std::unordered_set<const language::Reference*> list;
    for (const Read& read : reads_) {
      if (is_remembered(read)) {
        list.insert(read.reference);
      }
    }
    return list;
  }

  [[nodiscard]] std::vector<std::uint32_t> sorted() const {
    const std::size_t count = definition_.block->statements.size();
    // What a late output asks for must be; what an early one asks for is worth a warning, and yields where both cannot
    // be.
    std::vector<std::vector<std::pair<std::uint32_t, bool>>> after(count);
    std::vector<std::uint32_t> must(count, 0);
    std::vector<std::uint32_t> should(count, 0);
    for (const Read& read : reads_) {
      const std::uint32_t writer = *writer_[read.variable];
      if (writer == read.statement) {
        continue;
      }
      const auto [first, second] =
          read.side == Side::RatherBefore ? std::pair{read.statement, writer} : std::pair{writer, read.statement};
      const bool late = read.side == Side::Behind;
      after[first].emplace_back(second, late);
      ++(late ? must : should)[second];
    }
    using FirstInText = std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>>;
    FirstInText ready;
    FirstInText possible;  // all that must stand before them is placed
    std::vector<bool> placed(count, false);
    const auto release = [&](std::uint32_t s) {
      if (must[s] == 0) {
        (should[s] == 0 ? ready : possible).push(s);
      }
    };
    for (std::uint32_t s = 0; s < count; ++s) {
      release(s);
    }
    std::vector<std::uint32_t> order;
    std::uint32_t next = 0;
    while (order.size() < count) {
      // A ring of delays cannot be put in order: it is cut at the first statement in the text that may stand here, and
      // at the first of all where none may.
      while (ready.empty()) {
        if (!possible.empty()) {
          const std::uint32_t first = possible.top();
          possible.pop();
          if (!placed[first]) {
            ready.push(first);
          }
          continue;
        }
        if (!placed[next]) {
          ready.push(next);
        }
        ++next;
      }
      const std::uint32_t statement = ready.top();
      ready.pop();
      if (placed[statement]) {
        continue;
      }
      placed[statement] = true;
      order.push_back(statement);
      for (const auto& [other, late] : after[statement]) {
        --(late ? must : should)[other];
        release(other);
      }
    }
    return order;
  }

 private:
  [[nodiscard]] bool is_call(std::uint32_t statement) const {
    return std::holds_alternative<language::Call>(definition_.block->statements[statement]);
  }

  /// Whether an IEC compiler has last cycle's value of a variable there.
  [[nodiscard]] bool is_remembered(const Read& read) const {
    const std::uint32_t writer = *writer_[read.variable];
    return read.side == Side::Behind && read.statement <= writer && !is_call(writer);
  }

  /// By statement, a number that those have in common which need each other within a step, or, `with_memory`, from one
  /// step to the next by a variable.
  [[nodiscard]] std::vector<std::uint32_t> circles(bool with_memory) const {
    const auto count = static_cast<std::uint32_t>(definition_.block->statements.size());
    std::vector<std::vector<std::uint32_t>> needs(count);
    for (const Read& read : reads_) {
      if (read.side == Side::Behind && (with_memory || !is_remembered(read))) {
        needs[read.statement].push_back(*writer_[read.variable]);
      }
    }
    std::vector<std::uint32_t> circle(count);
    const auto components = components_of(count, [&](std::uint32_t statement) { return std::move(needs[statement]); });
    for (std::uint32_t number = 0; number < components.size(); ++number) {
      for (const std::uint32_t statement : components[number]) {
        circle[statement] = number;
      }
    }
    return circle;
  }

  /// A name for a delay that the block does not declare yet: LAST_BEFORE.
  [[nodiscard]] std::string delay_name(std::string_view variable) const {
    std::string name = fmt::format("{}_BEFORE", variable);
    for (int i = 2; definition_.by_name.contains(name); ++i) {
      name = fmt::format("{}_BEFORE_{}", variable, i);
    }
    return name;
  }

  void report_hidden_delay(const Read& read, std::uint32_t writer, bool in_circle, Diagnostics& diagnostics) const {
    const Declared& declared = definition_.variables[read.variable];
    const std::string name = delay_name(declared.field.name);
    const Type type = type_of(read);
    const std::string start =
        declared.has_preset ? fmt::format(" := (X0 := {})", literal_text(type, declared.field.preset)) : "";
    diagnostics.error(
        error::hidden_delay, source_.place(read.span),
        fmt::format("hidden delay: {} is read before it is {}", read.text, is_call(writer) ? "called" : "assigned"),
        fmt::format("An IEC compiler has last cycle's value here: memory. If that is meant, declare {0} : {1}{2}; call "
                    "{0}(XIN := {3}); and read {0}.XOUT here. {4}",
                    name, delay_of(type), start, read.text,
                    in_circle ? "Within one step a value cannot depend on itself."
                              : "If this step's value is meant, move this statement behind that one, as `hysteron fmt "
                                "--any-order` does."),
        {{source_.place(statement_span(writer)), is_call(writer) ? "called here" : "assigned here"}});
  }

  void report_other_meaning(const Read& read, std::uint32_t writer, Diagnostics& diagnostics) const {
    const std::vector<Note> notes{{source_.place(statement_span(writer)), "called here"}};
    if (read.side == Side::RatherBefore) {
      diagnostics.warning(
          error::read_after_call, source_.place(read.span),
          fmt::format("{} does not depend on this step's inputs, and is read after its call", read.text),
          "Here it is this step's value; an IEC compiler with the block library would give the next one. Move the "
          "reading statement before the call, as `hysteron fmt --any-order` does.",
          notes);
    } else {
      diagnostics.warning(
          error::read_after_call, source_.place(read.span),
          fmt::format("{} is known without this step's inputs, and is read before its call", read.text),
          fmt::format(
              "Here it is this step's value; an IEC compiler would give that of last cycle. Move the reading statement "
              "behind the call; in a loop, put the {} that is inside into this block.",
              loop_cutter),
          notes);
    }
  }

  /// The type of what is read.
  [[nodiscard]] Type type_of(const Read& read) const {
    const Declared& declared = definition_.variables[read.variable];
    const std::string_view pin =
        std::string_view(read.text).substr(std::min(read.text.size(), read.text.find('.') + 1));
    if (declared.kind == Declared::Kind::LibraryBlock) {
      for (const Field& output : declared.block->outputs) {
        if (language::same_name(output.name, pin)) {
          return output.type;
        }
      }
    } else if (declared.kind == Declared::Kind::UserBlock) {
      const Definition& inner = definitions_.list[declared.definition];
      if (const std::uint32_t* const output = inner.by_name.find(pin)) {
        return inner.variables[*output].field.type;
      }
    }
    return declared.field.type;
  }

  [[nodiscard]] language::Span statement_span(std::uint32_t statement) const {
    return std::visit([](const auto& one) { return one.span; }, definition_.block->statements[statement]);
  }

  void collect(language::ExpressionId id, std::uint32_t statement) {
    const auto& expression = source_.expressions[id];
    if (const auto* reference = std::get_if<language::Reference>(&expression.node)) {
      add(*reference, expression.span, statement);
    } else if (const auto* unary = std::get_if<language::Unary>(&expression.node)) {
      collect(unary->operand, statement);
    } else if (const auto* binary = std::get_if<language::Binary>(&expression.node)) {
      collect(binary->left, statement);
      collect(binary->right, statement);
    } else if (const auto* call = std::get_if<language::FunctionCall>(&expression.node)) {
      for (const auto& argument : call->arguments) {
        collect(argument.value, statement);
      }
    }
  }

  void add(const language::Reference& reference, language::Span span, std::uint32_t statement) {
    const std::uint32_t* const found = definition_.by_name.find(reference.name.text);
    if (found == nullptr || !writer_[*found]) {
      return;
    }
    const Declared& declared = definition_.variables[*found];
    Read read{.statement = statement,
              .variable = *found,
              .reference = &reference,
              .span = span,
              .text = std::string(source_.text_of(span))};
    if (declared.kind == Declared::Kind::LibraryBlock) {
      const std::uint32_t* const node = nodes_.find(declared.field.name);
      if (node == nullptr) {
        return;
      }
      for (std::size_t port = 0; port < declared.block->outputs.size(); ++port) {
        if (language::same_name(declared.block->outputs[port].name, reference.pin.text)) {
          if (!declared.block->states.empty() && !has_feedthrough(graph_, graph_.nodes[*node], port)) {
            read.side = has_memory(declared.block->trace, port) ? Side::RatherBefore : Side::RatherBehind;
          }
        }
      }
    } else if (declared.kind == Declared::Kind::UserBlock) {
      const Definition& inner = definitions_.list[declared.definition];
      const std::uint32_t* const output = inner.by_name.find(reference.pin.text);
      if (output != nullptr && *output < inner.late.size()) {
        read.side = inner.late[*output] ? Side::Behind : Side::RatherBehind;
      }
    }
    reads_.push_back(std::move(read));
  }

  const Definitions& definitions_;
  const language::SourceFile& source_;
  const Definition& definition_;
  const Graph& graph_;
  NameIndex nodes_;                                   ///< of library blocks, by path
  std::vector<std::optional<std::uint32_t>> writer_;  ///< by variable: the statement that calls or assigns it
  std::vector<Read> reads_;
};

}  // namespace

bool has_memory(const BlockTrace& trace, std::size_t output) {
  std::vector<ValueId> open{trace.outputs[output]};
  std::vector<bool> seen(trace.tape.size(), false);
  while (!open.empty()) {
    const ValueId id = open.back();
    open.pop_back();
    if (id == no_value || seen[id]) {
      continue;
    }
    seen[id] = true;
    const Value& value = trace.tape[id];
    if (value.op == Op::Cell) {
      return true;
    }
    open.insert(open.end(), value.args.begin(), value.args.end());
  }
  return false;
}

bool is_remembered(const Graph& graph, const Node& node, std::size_t output) {
  return node.block != nullptr && !has_feedthrough(graph, node, output) && has_memory(node.block->trace, output);
}

std::string_view delay_of(Type type) {
  switch (type) {
    case Type::Bool:
      return DelayBool::about.name;
    case Type::Int:
      return DelayInt::about.name;
    case Type::Word:
      return DelayWord::about.name;
    default:
      return Delay::about.name;
  }
}

std::unordered_set<const language::Reference*> remembered_reads(const Definitions& definitions,
                                                                std::uint32_t definition, const Graph& graph) {
  return Order(definitions, definition, graph).remembered();
}

void check_text_order(const Definitions& definitions, std::uint32_t definition, const Graph& graph, bool has_loops,
                      Diagnostics& diagnostics) {
  Order(definitions, definition, graph).check(has_loops, diagnostics);
}

std::vector<std::uint32_t> statement_order(const Definitions& definitions, std::uint32_t definition,
                                           const Graph& graph) {
  return Order(definitions, definition, graph).sorted();
}

}  // namespace hysteron
