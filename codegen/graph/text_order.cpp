#include "codegen/graph/text_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <queue>
#include <unordered_map>

#include "codegen/graph/schedule.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

using language::upper;

/// A read of a variable or of an instance's output in a statement.
struct Read {
  std::uint32_t statement = 0;
  std::uint32_t variable = 0;
  bool late = true;    ///< depends on this step's inputs: to be read after the call or assignment
  bool strict = true;  ///< early outputs of library blocks: elsewhere, only a read before the call is right
  language::Span span{};
  std::string text{};
};

class Order {
 public:
  Order(const Definitions& definitions, std::uint32_t index, const Graph& graph)
      : definitions_(definitions), source_(*definitions.source), definition_(definitions.list[index]), graph_(graph) {
    for (std::uint32_t i = 0; i < graph.nodes.size(); ++i) {
      if (graph.nodes[i].block != nullptr) {
        nodes_.emplace(upper(graph.nodes[i].path), i);
      }
    }
    const auto& statements = definition_.block->statements;
    writer_.assign(definition_.variables.size(), std::nullopt);
    for (std::uint32_t s = 0; s < statements.size(); ++s) {
      const auto* call = std::get_if<language::Call>(&statements[s]);
      const auto& name = call != nullptr ? call->instance : std::get<language::Assignment>(statements[s]).target;
      if (const auto found = definition_.by_name.find(upper(name.text)); found != definition_.by_name.end()) {
        writer_[found->second] = s;
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

  void check(Diagnostics& diagnostics) const {
    for (const Read& read : reads_) {
      const std::uint32_t writer = *writer_[read.variable];
      if (read.late && read.statement <= writer) {
        const bool call = std::holds_alternative<language::Call>(definition_.block->statements[writer]);
        diagnostics.error(
            error::hidden_delay, source_.place(read.span),
            fmt::format("hidden delay: {} is read before it is {}", read.text, call ? "called" : "assigned"),
            "In an IEC compiler this would be last cycle's value. Move this statement behind that one, as `hysteron "
            "fmt` does, or read it through a HY_DELAY.",
            {{source_.place(statement_span(writer)), call ? "called here" : "assigned here"}});
      } else if (!read.late && read.strict && read.statement > writer) {
        diagnostics.warning(
            error::read_after_call, source_.place(read.span),
            fmt::format("{} does not depend on this step's inputs, and is read after its call", read.text),
            "Here it is this step's value; an IEC compiler with the block library would give the next one. Move the "
            "reading statement before the call, as `hysteron fmt` does.",
            {{source_.place(statement_span(writer)), "called here"}});
      }
    }
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
      if (writer == read.statement || (!read.late && !read.strict)) {
        continue;
      }
      const auto [first, second] = read.late ? std::pair{writer, read.statement} : std::pair{read.statement, writer};
      after[first].emplace_back(second, read.late);
      ++(read.late ? must : should)[second];
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
    const auto found = definition_.by_name.find(upper(reference.name.text));
    if (found == definition_.by_name.end() || !writer_[found->second]) {
      return;
    }
    const Declared& declared = definition_.variables[found->second];
    Read read{.statement = statement,
              .variable = found->second,
              .span = span,
              .text = std::string(source_.text->substr(span.offset, span.length))};
    if (declared.kind == Declared::Kind::LibraryBlock) {
      const auto node = nodes_.find(upper(declared.field.name));
      if (node == nodes_.end()) {
        return;
      }
      for (std::size_t port = 0; port < declared.block->outputs.size(); ++port) {
        if (language::same_name(declared.block->outputs[port].name, reference.pin.text)) {
          read.late = declared.block->states.empty() || has_feedthrough(graph_, graph_.nodes[node->second], port);
        }
      }
    } else if (declared.kind == Declared::Kind::UserBlock) {
      const Definition& inner = definitions_.list[declared.definition];
      const auto output = inner.by_name.find(upper(reference.pin.text));
      if (output != inner.by_name.end() && output->second < inner.late.size()) {
        read.late = inner.late[output->second];
        read.strict = false;
      }
    }
    reads_.push_back(std::move(read));
  }

  const Definitions& definitions_;
  const language::SourceFile& source_;
  const Definition& definition_;
  const Graph& graph_;
  std::unordered_map<std::string, std::uint32_t> nodes_;
  std::vector<std::optional<std::uint32_t>> writer_;  ///< by variable: the statement that calls or assigns it
  std::vector<Read> reads_;
};

}  // namespace

void check_text_order(const Definitions& definitions, std::uint32_t definition, const Graph& graph,
                      Diagnostics& diagnostics) {
  Order(definitions, definition, graph).check(diagnostics);
}

std::vector<std::uint32_t> statement_order(const Definitions& definitions, std::uint32_t definition,
                                           const Graph& graph) {
  return Order(definitions, definition, graph).sorted();
}

}  // namespace hysteron
