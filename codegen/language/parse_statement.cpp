// Statements: calls of instances and assignments, and the advice for what else one might write there.
#include <fmt/format.h>

#include <algorithm>

#include "codegen/language/parser.hpp"
#include "support/errors.hpp"

namespace hysteron::language {

void Parser::statement(FunctionBlock& block) {
  if (is(Keyword::ControlBegin) || is(Keyword::ControlEnd) || is(Keyword::Control)) {
    control();
    return;
  }
  if (is(Symbol::Semicolon)) {
    error(error::unexpected_symbol, span_of(now()), "This semicolon ends no statement.", "Remove it.");
    advance();
    return;
  }
  if (is(Keyword::EndVar)) {
    error(error::unexpected_symbol, span_of(now()), "This END_VAR ends no section.",
          "Remove it, or write VAR before the declarations.");
    advance();
    return;
  }
  const auto before = now().offset;
  if (!named_statement(block)) {
    if (now().offset == before) {
      advance();
    }
    recover();
  }
}

bool Parser::named_statement(FunctionBlock& block) {
  if (is(Symbol::Keyword)) {
    error(error::unexpected_symbol, span_of(now()), fmt::format("A statement cannot begin with {}.", described(now())),
          "Write a call INSTANCE(PIN := value); or an assignment NAME := value;.");
    return false;
  }
  if (!is(Symbol::Identifier)) {
    unexpected("a statement", "Write a call INSTANCE(PIN := value); or an assignment NAME := value;.");
    return false;
  }
  switch (ahead(1).symbol) {
    case Symbol::LeftParenthesis:
      return call(block);
    case Symbol::Assign:
      return assignment(block);
    case Symbol::Dot:
      return pin_assignment(block);
    case Symbol::LeftBracket:
      return element_assignment(block);
    case Symbol::Number:
      if (text_of(span_of(ahead(1))).starts_with('.')) {
        return bit_assignment();
      }
      break;
    case Symbol::Equal:
      advance();
      unexpected("`:=`", "Write := to assign; = compares.");
      return false;
    case Symbol::Colon:
    case Symbol::Comma:
      advance();
      error(error::unexpected_symbol, span_of(now()), "This declaration stands outside of a section.",
            "Move it between VAR and END_VAR, before the first statement.");
      return false;
    default:
      break;
  }
  advance();
  unexpected("`(` or `:=`", "Write a call INSTANCE(PIN := value); or an assignment NAME := value;.");
  return false;
}

bool Parser::call(FunctionBlock& block) {
  const auto begin = now().offset;
  Call call{.instance = name_of(now())};
  advance();
  advance();
  if (!accept(Symbol::RightParenthesis) && !arguments(call.arguments)) {
    return false;
  }
  if (!expect_semicolon()) {
    return false;
  }
  call.span = since(begin);
  block.statements.emplace_back(std::move(call));
  return true;
}

bool Parser::assignment(FunctionBlock& block) {
  const auto begin = now().offset;
  Assignment assignment{.target = name_of(now())};
  advance();
  advance();
  return assigned_value(block, assignment, begin);
}

/// `Y[2] := value;`
bool Parser::element_assignment(FunctionBlock& block) {
  const auto begin = now().offset;
  Assignment assignment{.target = name_of(now())};
  advance();
  return index(assignment.index) && expect(Symbol::Assign, "`:=`") && assigned_value(block, assignment, begin);
}

bool Parser::assigned_value(FunctionBlock& block, Assignment assignment, std::uint32_t begin) {
  assignment.value = expression();
  if (assignment.value == no_expression || !expect_semicolon()) {
    return false;
  }
  assignment.span = since(begin);
  block.statements.emplace_back(assignment);
  return true;
}

/// `Z.3 := value;`: refused, since a diagram gives a variable its value once and whole.
bool Parser::bit_assignment() {
  const auto begin = now().offset;
  const std::string_view name = text_of(span_of(now()));
  advance();
  advance();
  refuse_bit_assignment(since(begin), name, text_of(span_of(last_)).substr(1));
  return false;
}

void Parser::refuse_bit_assignment(Span span, std::string_view name, std::string_view digits) {
  const int bit = bit_number(digits);
  error(error::pin_assignment, span, fmt::format("A bit of '{}' is assigned by itself.", name),
        bit < 0 ? fmt::format("Assign all of {} at once. Its bits are 0 to {}.", name, highest_bit)
                : fmt::format(
                      "Assign all of {0} at once, with a SEL for each bit: {0} := SEL(BIT{1}, WORD#0, WORD#16#{2:X}) "
                      "OR …; or say (* @body *) behind the name of the block: its statements then run one by "
                      "one.",
                      name, bit, 1U << static_cast<unsigned>(bit)));
}

bool Parser::pin_assignment(const FunctionBlock& block) {
  const auto instance = name_of(now());
  advance();
  advance();
  if (is(Symbol::Refused)) {
    return false;  // Z.%X3, told where it was read
  }
  const auto pin = is(Symbol::Identifier) ? now() : last_;
  const bool is_assignment = is(Symbol::Identifier) && ahead(1).symbol == Symbol::Assign;
  if (!is_assignment) {
    unexpected("a call or an assignment", "Write a call INSTANCE(PIN := value); or an assignment NAME := value;.");
    return false;
  }
  const auto name = name_of(pin);
  const Span span{instance.span.offset, pin.end() - instance.span.offset};
  const bool plain = std::ranges::any_of(block.variables, [&](const Variable& one) {
    return same_name(one.name.text, instance.text) && is_elementary_type(one.type.text);
  });
  if (plain && names_bit(name.text)) {
    refuse_bit_assignment(span, instance.text, name.text.substr(1));
    return false;
  }
  error(error::pin_assignment, span,
        fmt::format("The pin {}.{} is assigned outside of its call.", instance.text, name.text),
        plain ? fmt::format("'{0}' is a variable and has no pins: write {0} := …;", instance.text)
              : fmt::format("Wire it in the call: {}({} := …);", instance.text, name.text));
  return false;
}

/// The arguments behind an opening parenthesis, which stands before now(), up to the closing one.
bool Parser::arguments(std::vector<Argument>& list) {
  do {
    const auto second = ahead(1).symbol;
    if (is(Symbol::Identifier) && second == Symbol::Arrow) {
      error(error::argument_form, span_of(ahead(1)), "Outputs are not taken inside of a call.",
            fmt::format("Write NAME := INSTANCE.{}; as a statement of its own.", text_of(span_of(now()))));
      return false;
    }
    if (is(Symbol::Identifier) && second != Symbol::Assign) {
      const bool compares = second == Symbol::Equal || second == Symbol::Colon;
      const auto& place = compares ? ahead(1) : now();
      error(error::argument_form, span_of(place),
            compares ? fmt::format("{} does not wire a pin.", described(place))
                     : "This argument does not say which pin it is for.",
            compares ? fmt::format("Write {} := value.", text_of(span_of(now())))
                     : fmt::format("Write PIN := {}, with the name of the pin.", text_of(span_of(now()))));
      return false;
    }
    if (!is(Symbol::Identifier) && !is(Symbol::Keyword)) {
      const bool value = is(Symbol::Number) || is(Symbol::Typed) || is(Symbol::Minus) || is(Symbol::LeftParenthesis) ||
                         is(Symbol::LeftBracket);
      if (value) {
        error(error::argument_form, span_of(now()), "This argument does not say which pin it is for.",
              "Write PIN := value.");
        return false;
      }
    }
    Argument argument;
    if (!expect_name(argument.pin, "the name of a pin") || !expect(Symbol::Assign, "`:=`")) {
      return false;
    }
    argument.value = expression();
    if (argument.value == no_expression) {
      return false;
    }
    list.push_back(argument);
  } while (accept(Symbol::Comma));
  return expect(Symbol::RightParenthesis, "`,` or `)`");
}

/// Passes over a control statement with all that is in it.
void Parser::control() {
  error(error::control_statement, span_of(now()),
        fmt::format("{} is not part of a diagram: a diagram says what is wired to what, not what is done when.",
                    described(now())),
        "Choose between values with SEL(condition, value_if_false, value_if_true) or HY_SWITCH; repeat by one instance "
        "for each repetition.");
  std::size_t open = 0;
  while (!is(Keyword::EndFunctionBlock) && !is(Keyword::EndVar) && !ends_block() && !starts_section()) {
    if (is(Keyword::ControlBegin)) {
      ++open;
    } else if (is(Keyword::ControlEnd)) {
      open -= open > 0 ? 1 : 0;
    }
    advance();
    if (open == 0) {
      break;
    }
  }
  accept(Symbol::Semicolon);
}

}  // namespace hysteron::language
