// Expressions of sequential bodies. They bind as those of a diagram do; signs in a row, and a plus, are taken.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <utility>

#include "codegen/language/binary_sign.hpp"
#include "codegen/language/body_parser.hpp"
#include "codegen/language/parser.hpp"
#include "codegen/language/time_literal.hpp"
#include "support/errors.hpp"

namespace hysteron::language {
namespace {

std::string digits_alone(std::string_view text) {
  std::string digits;
  for (const char c : text) {
    digits += c == '_' ? std::string() : std::string(1, c);
  }
  return digits;
}

/// `42`, `1.5E-3`, `16#FF`; false where it is none.
bool value_of_number(std::string_view written, body::Literal& literal) {
  const std::string text = digits_alone(written);
  const char* const end = text.data() + text.size();
  if (const auto mark = text.find('#'); mark != std::string::npos) {
    const std::string base = text.substr(0, mark);
    std::uint64_t whole = 0;
    const auto [stop, problem] =
        std::from_chars(text.data() + mark + 1, end, whole, base == "2" ? 2 : (base == "8" ? 8 : 16));
    literal.value = static_cast<double>(whole);
    return (base == "2" || base == "8" || base == "16") && problem == std::errc{} && stop == end;
  }
  literal.kind =
      text.find_first_of(".eE") == std::string::npos ? body::Literal::Kind::Whole : body::Literal::Kind::Real;
  const auto [stop, problem] = std::from_chars(text.data(), end, literal.value);
  return problem == std::errc{} && stop == end;
}

}  // namespace

ExpressionId BodyParser::make(body::Expression expression) {
  library_.expressions.push_back(std::move(expression));
  return static_cast<ExpressionId>(library_.expressions.size() - 1);
}

/// AND_THEN and OR_ELSE are AND and OR: an operand changes nothing.
BinarySign BodyParser::sign_of(const Token& token) const {
  const bool word_sign = token.symbol == Symbol::Identifier;
  return word_sign && same_name(word(token), "AND_THEN")  ? BinarySign{Operator::And, 2}
         : word_sign && same_name(word(token), "OR_ELSE") ? BinarySign{Operator::Or, 0}
                                                          : binary_sign(token);
}

ExpressionId BodyParser::binary(int weakest) {
  ExpressionId left = unary();
  int chain = 0;
  while (left != no_expression) {
    const BinarySign sign = sign_of(now());
    if (sign.strength < weakest || sign.strength < 0) {
      return left;
    }
    if (++chain > static_cast<int>(deepest_expression)) {
      reporter_.error(error::nested_too_deeply, span_of(now()), "This expression is too long.",
                      "Give a part of it to a variable.");
      return no_expression;
    }
    advance();
    const ExpressionId right = binary(sign.strength + 1);
    if (right == no_expression) {
      return no_expression;
    }
    const auto begin = library_.expressions[left].span.offset;
    left = make({.node = body::Binary{sign.op, left, right}, .span = since(begin)});
  }
  return left;
}

ExpressionId BodyParser::unary() {
  const auto begin = now().offset;
  if (depth_ > static_cast<int>(deepest_expression)) {
    reporter_.error(error::nested_too_deeply, span_of(now()), "This expression is nested too deeply.",
                    "Give a part of it to a variable.");
    return no_expression;
  }
  if (is(Symbol::Plus) || is(Symbol::Minus) || now().keyword == Keyword::Not) {
    const bool plus = is(Symbol::Plus);
    const Operator op = now().keyword == Keyword::Not ? Operator::Not : Operator::Negate;
    advance();
    ++depth_;
    const ExpressionId operand = unary();
    --depth_;
    if (operand == no_expression || plus) {
      return operand;
    }
    if (is(Symbol::Power)) {
      reporter_.error(error::ambiguous_sign, since(begin), "Compilers differ on whether the sign or ** comes first.",
                      "Put one of the two into parentheses.");
    }
    return make({.node = body::Unary{op, operand}, .span = since(begin)});
  }
  return primary();
}

ExpressionId BodyParser::primary() {
  const auto begin = now().offset;
  if (is(Symbol::Number)) {
    return number();
  }
  if (is(Symbol::Typed)) {
    return typed();
  }
  if (is(Symbol::Refused)) {  // told by the lexer
    advance();
    return no_expression;
  }
  if (now().keyword == Keyword::True || now().keyword == Keyword::False) {
    const double value = now().keyword == Keyword::True ? 1.0 : 0.0;
    advance();
    return make({.node = body::Literal{body::Literal::Kind::Truth, value, {}}, .span = since(begin)});
  }
  if (accept(Symbol::LeftParenthesis)) {
    ++depth_;
    const ExpressionId inner = expression();
    --depth_;
    if (inner == no_expression || !expect(Symbol::RightParenthesis, "`)`")) {
      return no_expression;
    }
    library_.expressions[inner].span = since(begin);
    return inner;
  }
  // AND(A, B), NOT(A), MOD(A, B): an operator that is called like a function.
  const bool called =
      now().symbol == Symbol::Keyword && ahead().symbol == Symbol::LeftParenthesis && binary_sign(now()).strength >= 0;
  if (is(Symbol::Identifier) || called) {
    if (ahead().symbol == Symbol::LeftParenthesis) {
      body::Call call{.function = {word(now()), span_of(now())}};
      advance();
      advance();
      if (!arguments(call.arguments)) {
        return no_expression;
      }
      if (is(Symbol::LeftBracket) || (is(Symbol::Dot) && ahead().symbol == Symbol::Identifier)) {
        refuse(since(begin), fmt::format("A part is taken of what {} gives.", call.function.text),
               fmt::format("Assign all of it first: X := {}( … ), with X of the same type; then read the part of X.",
                           call.function.text));
        return no_expression;
      }
      return make({.node = std::move(call), .span = since(begin)});
    }
    body::Access read;
    if (!access(read)) {
      return no_expression;
    }
    if (is(Symbol::LeftParenthesis)) {
      refuse(read.span,
             fmt::format("{} is a method, or a call inside of an expression.", text_.substr(begin, read.span.length)),
             "Call the instance as a statement before, and read its output here.");
      return no_expression;
    }
    return make({.node = std::move(read), .span = since(begin)});
  }
  unexpected("a value");
  return no_expression;
}

ExpressionId BodyParser::number() {
  const auto span = span_of(now());
  auto text = word(now());
  text.remove_prefix(text.front() == '.' ? 1 : 0);  // the end of a range, 1..4
  body::Literal literal;
  advance();
  if (!value_of_number(text, literal)) {
    reporter_.error(error::malformed_number, span, fmt::format("`{}` is not a number.", text),
                    "Write digits, a point, an exponent, or a base of 2, 8 or 16 before #.");
    return no_expression;
  }
  return make({.node = literal, .span = span});
}

ExpressionId BodyParser::typed() {
  const auto span = span_of(now());
  const auto text = word(now());
  const auto mark = text.find('#');
  const auto type = text.substr(0, mark);
  const auto value = text.substr(mark + 1);
  advance();
  body::Literal literal{.type = type};
  if (same_name(type, "T") || same_name(type, "TIME")) {
    literal.kind = body::Literal::Kind::Time;
    literal.type = {};
    if (!milliseconds_of_time(value, literal.value)) {
      reporter_.error(error::malformed_number, span, fmt::format("`{}` is not a time.", text),
                      "Write parts with their units, the largest first: T#1m30s, T#5.5ms.");
      return no_expression;
    }
    return make({.node = literal, .span = span});
  }
  if (same_name(value, "TRUE") || same_name(value, "FALSE")) {
    literal = {body::Literal::Kind::Truth, same_name(value, "TRUE") ? 1.0 : 0.0, type};
    return make({.node = literal, .span = span});
  }
  if (!value.empty() && value.front() != '-' && value.front() != '+' && (value.front() < '0' || value.front() > '9')) {
    const Span place{static_cast<std::uint32_t>(span.offset + mark + 1), static_cast<std::uint32_t>(value.size())};
    return make({.node = body::Access{.name = {value, place}, .type = type, .span = span}, .span = span});
  }
  const bool negative = value.starts_with('-');
  if (!value_of_number(value.substr(negative || value.starts_with('+') ? 1 : 0), literal)) {
    reporter_.error(error::malformed_number, span, fmt::format("`{}` is not a number.", text),
                    fmt::format("Write a number right behind {}#.", type));
    return no_expression;
  }
  literal.value = negative ? -literal.value : literal.value;
  return make({.node = literal, .span = span});
}

bool BodyParser::access(body::Access& access) {
  const auto begin = now().offset;
  if (!name(access.name, "a name")) {
    return false;
  }
  const bool own = same_name(access.name.text, "THIS") || same_name(access.name.text, "SUPER");
  for (bool more = true; more;) {
    const auto place = now();
    if (is(Symbol::Dot) && ahead().symbol != Symbol::Dot) {
      advance();
      body::Step step;
      if (!name(step.member, "the name of a member")) {
        return false;
      }
      access.steps.push_back(std::move(step));
    } else if (is(Symbol::Number) && word(now()).front() == '.' && now().offset == last_end_) {
      body::Step step;
      const auto digits = word(now()).substr(1);
      std::from_chars(digits.data(), digits.data() + digits.size(), step.bit);
      access.steps.push_back(std::move(step));
      advance();
    } else if (accept(Symbol::LeftBracket)) {
      body::Step step;
      do {
        ++depth_;
        step.indexes.push_back(expression());
        --depth_;
        if (step.indexes.back() == no_expression) {
          return false;
        }
      } while (accept(Symbol::Comma));
      if (!expect(Symbol::RightBracket, "`]`")) {
        return false;
      }
      access.steps.push_back(std::move(step));
    } else {
      more = false;
      if (own || text_.substr(last_end_, 1) == "^") {
        return refuse(own ? access.name.span : span_of(place), "A body has no pointers.",
                      "Hand the variable over as VAR_IN_OUT, or use an array and an index.");
      }
    }
  }
  access.span = since(begin);
  return true;
}

/// The arguments behind an opening parenthesis, up to the closing one.
bool BodyParser::arguments(std::vector<body::Argument>& list) {
  if (accept(Symbol::RightParenthesis)) {
    return true;
  }
  if (depth_ > static_cast<int>(deepest_expression)) {
    reporter_.error(error::nested_too_deeply, span_of(now()), "Calls are nested too deeply.",
                    "Give a part to a variable.");
    return false;
  }
  ++depth_;
  bool right = true;
  do {
    body::Argument argument;
    if (is(Symbol::Identifier) && (ahead().symbol == Symbol::Assign || ahead().symbol == Symbol::Arrow)) {
      argument.formal = {word(now()), span_of(now())};
      argument.output = ahead().symbol == Symbol::Arrow;
      advance();
      advance();
    }
    if (argument.output && (is(Symbol::Comma) || is(Symbol::RightParenthesis))) {
      continue;  // an output that goes nowhere
    }
    argument.value = expression();
    right = argument.value != no_expression;
    list.push_back(argument);
  } while (right && accept(Symbol::Comma));
  --depth_;
  return right && expect(Symbol::RightParenthesis, "`,` or `)`");
}

}  // namespace hysteron::language
