#include "codegen/graph/portability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "codegen/graph/lowering.hpp"
#include "support/errors.hpp"
#include "support/single.hpp"

namespace hysteron {
namespace {

using language::ExpressionId;
using language::FunctionCall;
using language::Operator;

enum class Difference : std::uint8_t { OpenNumber, CrossedLimit, OutsideMux, Half, Exponent, NamedOrder, ZeroDivisor };

constexpr std::array<OtherMeaning, 7> meanings{{
    {.construct = "TRUNC(X) > 5, MAX(1, TRUNC(X))",
     .here = "a comparison of DINT",
     .elsewhere = "MATIEC infers ULINT: −1 is then above 5",
     .portable = "TRUNC(X) > DINT#5, MAX(DINT#1, TRUNC(X))"},
    {.construct = "LIMIT(5, N, 2)",
     .here = "the upper bound wins: 2",
     .elsewhere = "MATIEC and STruC++: the lower bound wins where N is below it: 5",
     .portable = "MIN(MAX(N, 5), 2), or bounds in their order"},
    {.construct = "MUX(K, A, B, C) with K outside of 0 … 2",
     .here = "the nearest end: A or C",
     .elsewhere = "MATIEC: 0 of the type; STruC++: C",
     .portable = "MUX(LIMIT(0, K, 2), A, B, C)"},
    {.construct = "LREAL_TO_DINT(2.5)",
     .here = "a half goes to the even number: 2",
     .elsewhere = "STruC++: away from zero: 3",
     .portable = "TRUNC(X + SEL(X < 0.0, 0.5, -0.5)): away from zero everywhere"},
    {.construct = "EXPT(X, 0.1), X ** 0.1",
     .here = "the exponent is an LREAL",
     .elsewhere = "MATIEC reads the literal as a REAL: 2e-9 off",
     .portable = "EXPT(X, E) with VAR CONSTANT E : LREAL := 0.1; END_VAR"},
    {.construct = "SEL(IN1 := A, IN0 := B, G := C)",
     .here = "arguments go by their names",
     .elsewhere = "STruC++: by their positions",
     .portable = "SEL(G := C, IN0 := B, IN1 := A)"},
    {.construct = "N MOD M, N / M with M = 0",
     .here = "0",
     .elsewhere = "MATIEC: 0; STruC++ and many PLCs: the program stops",
     .portable = "SEL(M = 0, N MOD SEL(M = 0, M, 1), 0)"},
}};

class Check {
 public:
  Check(const Definitions& definitions, std::uint32_t index, Diagnostics& diagnostics)
      : definitions_(definitions),
        source_(*definitions.source),
        definition_(definitions.list[index]),
        diagnostics_(diagnostics) {}

  void run() {
    for (const auto& statement : definition_.block->statements) {
      if (const auto* call = std::get_if<language::Call>(&statement)) {
        for (const auto& argument : call->arguments) {
          visit(argument.value);
        }
      } else {
        visit(std::get<language::Assignment>(statement).value);
      }
    }
  }

 private:
  /// Whether the type of an integer is left to the compiler: of a literal without a type, of TRUNC, and of what is made
  /// of them alone.
  struct Openness {
    bool open = false;
    bool of_trunc = false;
    std::string literal{};  ///< the first one without a type
    void join(const Openness& other) {
      open = open && other.open;
      of_trunc = of_trunc || other.of_trunc;
      literal = literal.empty() ? other.literal : literal;
    }
  };

  Openness visit(ExpressionId id) {
    const auto& written = source_.expressions[id];
    if (std::holds_alternative<language::IntLiteral>(written.node)) {
      const std::string text = text_of(id);
      const bool typed = std::isalpha(static_cast<unsigned char>(text.front())) != 0;
      return {.open = !typed, .literal = typed ? "" : text};
    }
    if (const auto* unary = std::get_if<language::Unary>(&written.node)) {
      Openness operand = visit(unary->operand);
      operand.literal =
          operand.literal.empty() || unary->op != Operator::Negate ? operand.literal : "-" + operand.literal;
      return operand;
    }
    if (const auto* binary = std::get_if<language::Binary>(&written.node)) {
      return visit_binary(*binary, id);
    }
    if (const auto* call = std::get_if<FunctionCall>(&written.node)) {
      return visit_call(*call, id);
    }
    return {};
  }

  Openness visit_binary(const language::Binary& binary, ExpressionId id) {
    Openness both = visit(binary.left);
    both.join(visit(binary.right));
    switch (binary.op) {
      case Operator::Less:
      case Operator::LessEqual:
      case Operator::Greater:
      case Operator::GreaterEqual:
      case Operator::Equal:
      case Operator::NotEqual:
        warn_of_open(both, id);
        return {};
      case Operator::Power:
        check_exponent(binary.right);
        return {};
      case Operator::Divide:
      case Operator::Modulo:
        if (type_of(binary.left) == Type::Int) {
          check_divisor(binary.right, id);
        }
        return both;
      default:
        return both;
    }
  }

  Openness visit_call(const FunctionCall& call, ExpressionId id) {
    const std::string name = language::upper(call.function.text);
    Openness all{.open = true};
    for (const auto& argument : call.arguments) {
      all.join(visit(argument.value));
    }
    check_names(call, name, id);
    if (name == "TRUNC") {
      return {.open = true, .of_trunc = true};
    }
    if (name == "ABS") {
      return all;
    }
    if (name == "EXPT" && call.arguments.size() == 2) {
      check_exponent(value_of(call, name, 1));
    } else if (name == "MUX") {
      check_index(value_of(call, name, 0), call.arguments.size() - 1, id);
    } else if (name == "LREAL_TO_DINT" && may_be_half(call.arguments.front().value)) {
      warn(Difference::Half, id, "LREAL_TO_DINT takes a half to the even number",
           "Where halves can come, write TRUNC(X + SEL(X < 0.0, 0.5, -0.5)), which takes them away from zero.");
    } else if (name == "MIN" || name == "MAX") {
      warn_of_open(all, id);
    } else if (name == "LIMIT") {
      warn_of_open(all, id);
      check_limit(call, id);
    }
    return {};
  }

  void warn_of_open(const Openness& operands, ExpressionId id) {
    if (operands.open && operands.of_trunc) {
      warn(Difference::OpenNumber, id, "nothing here says that TRUNC gives a DINT",
           operands.literal.empty() ? "Give TRUNC(…) to a variable of type DINT first, and take that."
                                    : fmt::format("Write DINT#{}.", operands.literal));
    }
  }

  void check_limit(const FunctionCall& call, ExpressionId id) {
    const auto lower = constant_of(value_of(call, "LIMIT", 0));
    const auto upper = constant_of(value_of(call, "LIMIT", 2));
    if (lower && upper && *lower > *upper) {
      warn(Difference::CrossedLimit, id, "the lower bound of LIMIT is above the upper one",
           "Write the bounds in their order, or MIN(MAX(IN, MN), MX).");
    }
  }

  void check_index(ExpressionId index, std::size_t count, ExpressionId id) {
    const double last = static_cast<double>(count) - 1.0;
    const auto constant = constant_of(index);
    const bool inside = constant ? *constant >= 0.0 && *constant <= last
                                 : is_call(index, "BOOL_TO_DINT") || stays_within(index, 0.0, last);
    if (!inside) {
      warn(Difference::OutsideMux, id, fmt::format("the index of MUX may lie outside of 0 … {}", last),
           fmt::format("Write MUX(LIMIT(0, {}, {}), …), which is the nearest end everywhere.", text_of(index), last));
    }
  }

  void check_divisor(ExpressionId divisor, ExpressionId id) {
    const auto constant = constant_of(divisor);
    const bool never_zero = constant ? *constant != 0.0 : is_kept_from_zero(divisor);
    if (!never_zero) {
      const std::string text = text_of(divisor);
      warn(Difference::ZeroDivisor, id, constant ? "a DINT is divided by 0" : fmt::format("{} may be 0", text),
           fmt::format("Divide by SEL({0} = 0, {0}, 1), and choose what is to come of 0 by a further SEL.", text));
    }
  }

  /// A literal that a REAL holds to the digit is the same number however it is read.
  void check_exponent(ExpressionId exponent) {
    double value = 0.0;
    Type type = Type::Real;
    if (constant_value(source_, exponent, value, type) && type == Type::Real && nearest_single(value) != value) {
      warn(Difference::Exponent, exponent, fmt::format("the exponent {} has no type", text_of(exponent)),
           fmt::format("Name it: VAR CONSTANT EXPONENT : LREAL := {}; END_VAR.", text_of(exponent)));
    }
  }

  void check_names(const FunctionCall& call, const std::string& name, ExpressionId id) {
    const auto order = formal_arguments(name);
    for (std::size_t i = 0; i < call.arguments.size() && i < order.size(); ++i) {
      const std::string_view formal = call.arguments[i].formal.text;
      if (!formal.empty() && !language::same_name(formal, order[i])) {
        warn(Difference::NamedOrder, id, fmt::format("the arguments of {} are not in their order", name),
             fmt::format("Write them as {}({}).", name,
                         fmt::join(order.first(std::min(order.size(), call.arguments.size())), ", ")));
        return;
      }
    }
  }

  // --- what an expression is ---

  [[nodiscard]] bool is_call(ExpressionId id, std::string_view name) const {
    const auto* call = std::get_if<FunctionCall>(&source_.expressions[id].node);
    return call != nullptr && language::same_name(call->function.text, name);
  }

  [[nodiscard]] bool may_be_half(ExpressionId id) const {
    const auto constant = constant_of(id);
    return constant ? std::abs(*constant - std::trunc(*constant)) == 0.5 : !is_call(id, "DINT_TO_LREAL");
  }

  /// LIMIT(a, …, b) with constants between `low` and `high`.
  [[nodiscard]] bool stays_within(ExpressionId id, double low, double high) const {
    if (!is_call(id, "LIMIT")) {
      return false;
    }
    const auto& call = std::get<FunctionCall>(source_.expressions[id].node);
    const auto lower = constant_of(value_of(call, "LIMIT", 0));
    const auto upper = constant_of(value_of(call, "LIMIT", 2));
    return lower && upper && *lower >= low && *lower <= *upper && *upper <= high;
  }

  /// MAX(1, M), LIMIT(1, M, 9), SEL(M = 0, M, 1).
  [[nodiscard]] bool is_kept_from_zero(ExpressionId id) const {
    if (stays_within(id, 1.0, std::numeric_limits<double>::infinity())) {
      return true;
    }
    if (is_call(id, "MAX")) {
      const auto& call = std::get<FunctionCall>(source_.expressions[id].node);
      return std::ranges::any_of(
          call.arguments, [&](const auto& argument) { return constant_of(argument.value).value_or(0.0) >= 1.0; });
    }
    if (!is_call(id, "SEL")) {
      return false;
    }
    const auto& call = std::get<FunctionCall>(source_.expressions[id].node);
    const auto* test = std::get_if<language::Binary>(&source_.expressions[value_of(call, "SEL", 0)].node);
    return test != nullptr && test->op == Operator::Equal && constant_of(test->right) == 0.0 &&
           language::same_name(text_of(test->left), text_of(value_of(call, "SEL", 1))) &&
           constant_of(value_of(call, "SEL", 2)).value_or(0.0) != 0.0;
  }

  /// The argument at a place of the standard's order, however it is given.
  [[nodiscard]] static ExpressionId value_of(const FunctionCall& call, std::string_view name, std::size_t place) {
    for (const auto& argument : call.arguments) {
      if (language::same_name(argument.formal.text, formal_arguments(name)[place])) {
        return argument.value;
      }
    }
    return call.arguments[place].value;
  }

  [[nodiscard]] std::string text_of(ExpressionId id) const {
    return std::string(source_.text_of(source_.expressions[id].span));
  }

  /// Lowers an expression into a graph of its own, in which constants are literals and all else is an input.
  template <class Use>
  auto lowered(ExpressionId id, Use use) const {
    Graph graph;
    GraphBuilder builder(graph);
    Lowering lowering(
        builder, source_,
        [&](const language::Reference& reference, auto) {
          const Declared* declared = find(reference.name.text);
          if (declared != nullptr && declared->kind == Declared::Kind::Constant) {
            return builder.literal(declared->field.type, declared->field.preset);
          }
          return Wire{.from = Wire::From::Input, .type = type_of(declared, reference.pin.text)};
        },
        [](int, auto, auto, auto) {});
    return use(lowering.lower(id, ""), graph);
  }

  [[nodiscard]] std::optional<double> constant_of(ExpressionId id) const {
    return lowered(id, [](Wire wire, const Graph& graph) {
      return wire.from == Wire::From::Literal ? std::optional(graph.literals[wire.index]) : std::nullopt;
    });
  }

  [[nodiscard]] Type type_of(ExpressionId id) const {
    return lowered(id, [](Wire wire, const Graph& /*graph*/) { return wire.type; });
  }

  [[nodiscard]] const Declared* find(std::string_view name) const {
    const std::uint32_t* const found = definition_.by_name.find(name);
    return found == nullptr ? nullptr : &definition_.variables[*found];
  }

  [[nodiscard]] Type type_of(const Declared* declared, std::string_view pin) const {
    if (declared == nullptr) {
      return Type::Real;
    }
    if (declared->kind == Declared::Kind::LibraryBlock) {
      const auto& outputs = declared->block->outputs;
      const auto found =
          std::ranges::find_if(outputs, [&](const Field& one) { return language::same_name(one.name, pin); });
      return found == outputs.end() ? Type::Real : found->type;
    }
    if (declared->kind == Declared::Kind::UserBlock) {
      const Definition& inner = definitions_.list[declared->definition];
      const std::uint32_t* const found = inner.by_name.find(pin);
      return found == nullptr ? Type::Real : inner.variables[*found].field.type;
    }
    return declared->field.type;
  }

  void warn(Difference kind, ExpressionId id, const std::string& cause, const std::string& mend) {
    const OtherMeaning& meaning = meanings[static_cast<std::size_t>(kind)];
    diagnostics_.warning(
        error::other_meaning_elsewhere, source_.place(source_.expressions[id].span),
        fmt::format("other meaning elsewhere: {}. Here: {}. {}", cause, meaning.here, meaning.elsewhere), mend);
  }

  const Definitions& definitions_;
  const language::SourceFile& source_;
  const Definition& definition_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::span<const OtherMeaning> other_meanings() {
  return meanings;
}

void check_portability(const Definitions& definitions, std::uint32_t definition, Diagnostics& diagnostics) {
  Check(definitions, definition, diagnostics).run();
}

}  // namespace hysteron
