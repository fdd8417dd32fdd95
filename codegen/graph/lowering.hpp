// Lowering: from expressions of the text to operation nodes of a graph.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron {

/// Adds nodes, wires and literals to a graph that is being built.
class GraphBuilder {
 public:
  explicit GraphBuilder(Graph& graph) : graph_(graph) {}

  /// A literal, or with its unit a constant.
  Wire literal(Type type, double value, std::string_view unit = {});
  /// An operation on wires; folded where all are literals, unless their units do not agree: the check of units is to
  /// find it. `path` names the pin that the expression feeds.
  Wire operation(Op op, std::initializer_list<Wire> operands, const std::string& path, language::Span span);
  /// A block with all pins unconnected.
  std::uint32_t block(const BlockType& type, std::string path, Rate rate, language::Span span);

  Graph& graph() { return graph_; }
  [[nodiscard]] static bool is_literal(Wire wire) { return wire.from == Wire::From::Literal; }
  [[nodiscard]] double value(Wire wire) const { return graph_.literals[wire.index]; }
  /// Of a constant; empty for a plain number.
  [[nodiscard]] std::string_view unit(Wire wire) const {
    const auto found = units_.find(wire.index);
    return found == units_.end() ? std::string_view() : found->second;
  }

 private:
  Graph& graph_;
  std::unordered_map<std::uint32_t, std::string> units_;  ///< by literal
  std::string numbered_path_;
  std::uint32_t next_number_ = 0;
};

/// The names of a function's arguments in their order, by its name in upper case: G, IN0, IN1 of SEL.
std::span<const std::string_view> formal_arguments(std::string_view function);

/// How a value of one type becomes one of another, as the mend of an error says it.
[[nodiscard]] std::string conversion_in_words(Type wanted, Type given);

/// Lowers one expression. Names are resolved by a callback, which reports what it does not know.
class Lowering {
 public:
  using Resolve = std::function<Wire(const language::Reference&, language::Span)>;
  using Report = std::function<void(int, language::Span, std::string, std::string)>;

  Lowering(GraphBuilder& builder, const language::SourceFile& source, Resolve resolve, Report report)
      : builder_(builder), source_(source), resolve_(std::move(resolve)), report_(std::move(report)) {}

  /// LREAL_TO_DINT as operations of a graph.
  static Wire rounded(GraphBuilder& builder, Wire x, const std::string& path, language::Span span);

  /// The wire that carries the expression; From::Nothing where an error was reported. `path` names what it feeds.
  Wire lower(language::ExpressionId id, const std::string& path);

 private:
  Wire lower_unary(const language::Unary& unary, language::Span span);
  Wire lower_binary(const language::Binary& binary, language::Span span);
  /// A bit of a value: `W.3`.
  Wire lower_bit(const language::Binary& binary, language::Span span);
  Wire lower_call(const language::FunctionCall& call, language::Span span);
  /// AND, OR, XOR, = and <> of two WORDs; From::Nothing for another operator.
  Wire lower_words(language::Operator op, Wire left, Wire right, language::Span span);
  /// SHL, SHR, WORD_TO_DINT and DINT_TO_WORD; nothing where the function is another one.
  std::optional<Wire> lower_word_call(std::string_view name, const std::vector<Wire>& args, language::Span span);
  Wire round_to_int(Wire x, language::Span span);
  Wire angle_of(Wire y, Wire x, language::Span span);
  Wire expression(language::ExpressionId id);
  Wire apply(Op op, std::initializer_list<Wire> operands, language::Span span) {
    return builder_.operation(op, operands, path_, span);
  }
  /// Refuses the types of an operator that takes those of `taken`, both sides the same.
  Wire mismatch(language::Span span, std::string_view what, std::initializer_list<Type> given,
                const std::vector<Type>& taken, const std::string& hint = {});
  /// The mend for W AND 16#6F = 16#27, where the comparison is done first; empty where it is not that.
  [[nodiscard]] std::string meant_brackets(const language::Binary& binary, Type left, Type right) const;
  /// The mend for U * 1 and U * (1/2): the whole numbers of the one side as LREAL; empty where it is not that.
  [[nodiscard]] std::string meant_real(const language::Binary& binary, Type left, Type right) const;
  /// The literals of an expression of whole numbers alone, in the order of the text; false where it is none.
  [[nodiscard]] bool literals_alone(language::ExpressionId id, std::vector<language::Span>& literals,
                                    bool& divides) const;
  [[nodiscard]] language::Span span_of(language::ExpressionId id) const { return source_.expressions[id].span; }

  GraphBuilder& builder_;
  const language::SourceFile& source_;
  Resolve resolve_;
  Report report_;
  std::string path_{};
};

}  // namespace hysteron
