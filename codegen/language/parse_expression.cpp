// Expressions by precedence climbing. From the strongest: parentheses and calls; - NOT; **; * / MOD; + -;
// < > <= >=; = <>; AND &; XOR; OR (IEC 61131-3, table 71). Equals are taken from left to right.
//
// The editions and the compilers differ on whether - or ** binds more strongly, so -A ** B is refused; so are two
// signs in a row, and the unary plus, which older compilers do not know.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "codegen/language/binary_sign.hpp"
#include "codegen/language/parser.hpp"
#include "support/errors.hpp"
#include "support/whole_number.hpp"

namespace hysteron::language {
namespace {

constexpr std::int64_t lowest_dint_magnitude = 2147483648;

bool is_unary_sign(const Token& token) {
  return token.symbol == Symbol::Minus || token.symbol == Symbol::Plus || token.keyword == Keyword::Not;
}

}  // namespace

ExpressionId Parser::make(Expression expression, std::uint32_t height, std::uint32_t chain) {
  if (too_deep(height, expression.span, chain)) {
    return no_expression;
  }
  file_.expressions.push_back(std::move(expression));
  heights_.push_back(static_cast<std::uint16_t>(height));
  return static_cast<ExpressionId>(file_.expressions.size() - 1);
}

bool Parser::too_deep(std::uint32_t depth, Span span, std::uint32_t chain) {
  if (depth <= deepest_expression) {
    return false;
  }
  if (chain > deepest_expression / 2) {
    error(error::nested_too_deeply, span,
          fmt::format("Each operator of a chain such as A + B + C counts as a level, and these are more than {}.",
                      deepest_expression),
          "Give a part of it to a variable of its own, or add many signals by several HY_SUM blocks.");
    return true;
  }
  error(error::nested_too_deeply, span,
        fmt::format("This expression is nested more than {} levels deep.", deepest_expression),
        "Give a part of it to a variable of its own.");
  return true;
}

ExpressionId Parser::binary(int weakest) {
  ExpressionId left = operand();
  std::uint32_t chain = 0;
  while (left != no_expression) {
    const auto sign = binary_sign(now());
    if (sign.strength < weakest) {
      break;
    }
    advance();
    const ExpressionId right = binary(sign.strength + 1);
    if (right == no_expression) {
      return no_expression;
    }
    const auto begin = file_.expressions[left].span.offset;
    const auto height = 1U + std::max(heights_[left], heights_[right]);
    left = make({.node = Binary{sign.op, left, right}, .span = since(begin)}, height, ++chain);
  }
  return left;
}

ExpressionId Parser::operand() {
  return is_unary_sign(now()) ? unary() : primary(false);
}

ExpressionId Parser::unary() {
  const Token sign = now();
  if (sign.symbol == Symbol::Plus) {
    error(error::ambiguous_sign, span_of(sign), "A plus before a value is not portable.", "Leave it out.");
  }
  advance();
  if (is_unary_sign(now())) {
    error(error::ambiguous_sign, span_of(now()),
          fmt::format("{} right behind {} is not portable.", described(now()), described(sign)),
          "Put the inner one and its value in parentheses.");
    while (is_unary_sign(now())) {
      advance();
    }
  }
  const ExpressionId value = primary(sign.symbol == Symbol::Minus);
  if (value == no_expression) {
    return no_expression;
  }
  if (is(Symbol::Power)) {
    error(error::ambiguous_sign, since(sign.offset),
          fmt::format("Compilers differ on whether {} or ** comes first.", described(sign)),
          fmt::format("Write {0}(A ** B) or ({0}A) ** B.", sign.keyword == Keyword::Not ? "NOT " : "-"));
  }
  if (sign.symbol == Symbol::Plus) {
    return value;
  }
  // DINT reaches one further below zero than above: -2147483648 is one literal.
  if (auto* lowest = std::get_if<IntLiteral>(&file_.expressions[value].node);
      lowest != nullptr && lowest->value == lowest_dint_magnitude) {
    lowest->value = -lowest_dint_magnitude;
    file_.expressions[value].span = since(sign.offset);
    return value;
  }
  const auto op = sign.symbol == Symbol::Minus ? Operator::Negate : Operator::Not;
  return make({.node = Unary{op, value}, .span = since(sign.offset)}, 1U + heights_[value]);
}

ExpressionId Parser::primary(bool behind_minus) {
  switch (now().symbol) {
    case Symbol::Number:
    case Symbol::Typed:
      return literal(behind_minus);
    case Symbol::Refused:
      advance();
      return make({.node = RealLiteral{}, .span = span_of(last_)}, 1);
    case Symbol::LeftParenthesis:
      return without_bit(parenthesized());
    case Symbol::LeftBracket:
      return array();
    case Symbol::Identifier:
      return ahead(1).symbol == Symbol::LeftParenthesis ? without_bit(function_call()) : reference();
    default:
      break;
  }
  if (is(Keyword::True) || is(Keyword::False)) {
    advance();
    return make({.node = BoolLiteral{last_.keyword == Keyword::True}, .span = span_of(last_)}, 1);
  }
  const bool is_sign = binary_sign(now()).strength >= 0 || is_unary_sign(now());
  if (!is_sign && keyword_for_name("a value")) {
    return no_expression;
  }
  const auto twice = [&](Symbol symbol) { return is(symbol) && last_.symbol == symbol && last_.end() == now().offset; };
  unexpected("a value", twice(Symbol::Equal)       ? "Write = to compare, once; := assigns."
                        : twice(Symbol::Ampersand) ? "Write AND, or & once."
                                                   : "Put a number, a name, INSTANCE.PIN or a function here.");
  return no_expression;
}

ExpressionId Parser::literal(bool behind_minus) {
  const auto span = span_of(now());
  const auto value = is(Symbol::Number) ? number_literal(text_of(span), behind_minus) : typed_literal(text_of(span));
  advance();
  if (const auto* problem = std::get_if<LiteralError>(&value)) {
    error(problem->number, span, problem->cause, problem->mend);
    return make({.node = RealLiteral{}, .span = span}, 1);
  }
  if (const auto* real = std::get_if<RealLiteral>(&value)) {
    return make({.node = *real, .span = span}, 1);
  }
  if (const auto* integer = std::get_if<IntLiteral>(&value)) {
    return make({.node = *integer, .span = span}, 1);
  }
  return make({.node = std::get<BoolLiteral>(value), .span = span}, 1);
}

ExpressionId Parser::parenthesized() {
  const auto begin = now().offset;
  if (too_deep(depth_ + 1, span_of(now()))) {
    return no_expression;
  }
  advance();
  ++depth_;
  const ExpressionId inner = expression();
  --depth_;
  if (inner == no_expression || !expect(Symbol::RightParenthesis, "`)`")) {
    return no_expression;
  }
  file_.expressions[inner].span = since(begin);
  return inner;
}

ExpressionId Parser::reference() {
  const auto begin = now().offset;
  Reference reference{.name = name_of(now())};
  advance();
  if (accept(Symbol::Dot)) {
    if (is(Symbol::Number)) {
      error(error::refused_access, span_of(now()), "The number of a bit stands close to its dot.",
            fmt::format("Write {}.{}.", reference.name.text, text_of(span_of(now()))));
      return no_expression;
    }
    if (is(Symbol::Refused)) {
      advance();
      return make({.node = RealLiteral{}, .span = since(begin)}, 1);
    }
    if (!expect_name(reference.pin, "the name of a pin")) {
      return no_expression;
    }
  }
  if (!index(reference.index)) {
    return no_expression;
  }
  if (is(Symbol::Dot) || is(Symbol::LeftBracket)) {
    error(error::refused_access, span_of(now()),
          is(Symbol::Dot) ? "Only the pins of an instance can be read, not what is inside of it."
                          : "A vector has one index: its elements are single values.",
          is(Symbol::Dot) ? "Give the inner block a VAR_OUTPUT for the value." : "Write one index, X[2].");
    return no_expression;
  }
  const auto height = reference.index == no_expression ? 1U : 1U + heights_[reference.index];
  const ExpressionId whole = make({.node = reference, .span = since(begin)}, height);
  return is_bit() ? bit_of(whole, begin) : whole;
}

bool Parser::is_bit() const {
  return is(Symbol::Number) && text_of(span_of(now())).front() == '.' && now().offset == last_.end();
}

/// The number behind the dot; -1 where it names no bit.
int Parser::bit_number(std::string_view digits) {
  return whole_number(digits, 0, highest_bit).value_or(-1);
}

/// A value that is no variable, whose bits have no numbers.
ExpressionId Parser::without_bit(ExpressionId value) {
  if (value == no_expression || !is_bit()) {
    return value;
  }
  const auto text = text_of(file_.expressions[value].span);
  const int bit = bit_number(text_of(span_of(now())).substr(1));
  const bool brackets = text.starts_with('(');
  error(error::refused_access, span_of(now()), "Only a variable has bits that are read by their number.",
        bit < 0 ? fmt::format("Give {} to a WORD of its own, and name a bit from 0 to {}: NAME.0.", text, highest_bit)
                : fmt::format("Write ({} AND 16#{:X}) <> 16#0, or give {} to a WORD of its own: NAME.{}.", text,
                              1U << static_cast<unsigned>(bit), brackets ? "the value" : text, bit));
  advance();
  return value;
}

/// `W.3` is (W AND 16#8) <> 16#0.
ExpressionId Parser::bit_of(ExpressionId word, std::uint32_t begin) {
  const auto span = span_of(now());
  const auto digits = text_of(span).substr(1);
  const int bit = bit_number(digits);
  advance();
  if (bit < 0) {
    const auto based = number_literal(digits, false);
    const auto* const number = std::get_if<IntLiteral>(&based);
    const bool is_one = digits.find('#') != std::string_view::npos && number != nullptr && number->value >= 0 &&
                        number->value <= highest_bit;
    error(error::refused_access, span,
          is_one ? "The number of a bit is decimal." : fmt::format("A WORD has no bit {}.", digits),
          is_one ? fmt::format("Write .{}.", number->value)
                 : fmt::format("Its bits are 0 to {}; bit 0 is the lowest.", highest_bit));
    return no_expression;
  }
  const auto literal = [&](std::int64_t value) {
    return make({.node = IntLiteral{.value = value, .is_word = true}, .span = span}, 1);
  };
  const auto joined = [&](Operator op, ExpressionId left, ExpressionId right, std::int8_t read) {
    return left == no_expression  // nested too deeply
               ? left
               : make({.node = Binary{op, left, right, read}, .span = since(begin)}, heights_[left] + 1);
  };
  const ExpressionId masked = joined(Operator::And, word, literal(std::int64_t{1} << bit), -1);
  return joined(Operator::NotEqual, masked, literal(0), static_cast<std::int8_t>(bit));
}

bool Parser::index(ExpressionId& index) {
  if (!is(Symbol::LeftBracket)) {
    return true;
  }
  file_.has_vectors = true;
  if (too_deep(depth_ + 1, span_of(now()))) {
    return false;
  }
  advance();
  ++depth_;
  index = expression();
  --depth_;
  return index != no_expression && expect(Symbol::RightBracket, "`]`");
}

ExpressionId Parser::function_call() {
  const auto begin = now().offset;
  FunctionCall call{.function = name_of(now())};
  if (too_deep(depth_ + 1, span_of(now()))) {
    return no_expression;
  }
  advance();
  advance();
  ++depth_;
  bool right = true;
  if (!is(Symbol::RightParenthesis)) {
    do {
      right = function_argument(call.arguments);
    } while (right && accept(Symbol::Comma));
  }
  --depth_;
  if (!right || !expect(Symbol::RightParenthesis, "`,` or `)`")) {
    return no_expression;
  }
  std::uint32_t height = 1;
  for (const auto& argument : call.arguments) {
    height = std::max(height, 1U + heights_[argument.value]);
  }
  return make({.node = std::move(call), .span = since(begin)}, height);
}

bool Parser::function_argument(std::vector<FunctionArgument>& list) {
  FunctionArgument argument;
  const auto start = now();
  if (is(Symbol::Identifier) && ahead(1).symbol == Symbol::Arrow) {
    error(error::argument_form, span_of(ahead(1)), "Outputs are not taken inside of a call.",
          "Use the value of the function itself.");
    return false;
  }
  const bool named = is(Symbol::Identifier) && ahead(1).symbol == Symbol::Assign;
  if (named) {
    argument.formal = name_of(now());
    advance();
    advance();
  }
  if (!list.empty() && named == list.front().formal.text.empty()) {
    error(error::argument_form, span_of(start), "Arguments with and without names are mixed.",
          "Name all arguments of this call, or none.");
  }
  argument.value = expression();
  if (argument.value == no_expression) {
    return false;
  }
  list.push_back(argument);
  return true;
}

ExpressionId Parser::array() {
  const auto begin = now().offset;
  ArrayLiteral array;
  if (too_deep(depth_ + 1, span_of(now()))) {
    return no_expression;
  }
  file_.has_vectors = true;
  advance();
  ++depth_;
  std::uint32_t height = 1;
  do {
    if (is(Symbol::LeftBracket)) {
      error(error::list_in_list, span_of(now()), "A list holds single values, and no list.",
            "Write a matrix row by row, in one list: [1.0, 2.0, 3.0, 4.0].");
      --depth_;
      return no_expression;
    }
    const ExpressionId element = expression();
    if (element == no_expression) {
      --depth_;
      return no_expression;
    }
    array.elements.push_back(element);
    height = std::max(height, 1U + heights_[element]);
  } while (accept(Symbol::Comma));
  --depth_;
  if (!expect(Symbol::RightBracket, "`,` or `]`")) {
    return no_expression;
  }
  return make({.node = std::move(array), .span = since(begin)}, height);
}

}  // namespace hysteron::language
