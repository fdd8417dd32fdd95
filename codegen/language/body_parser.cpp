#include "codegen/language/body_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "codegen/language/parser.hpp"
#include "support/errors.hpp"

namespace hysteron::language {

using body::Statements;

BodyParser::BodyParser(const SourceFile& file, body::Library& library, Reporter& reporter, std::uint32_t begin,
                       std::uint32_t end)
    : text_(*file.text),
      library_(library),
      reporter_(reporter),
      lexer_(text_.substr(0, end), Comments::Annotated, &reporter),
      end_(end) {
  lexer_.take_foreign();
  lexer_.go_to(begin);
  for (auto& token : window_) {
    token = lexer_.next();
  }
}

void BodyParser::advance() {
  last_end_ = now().end();
  std::shift_left(window_.begin(), window_.end(), 1);
  window_.back() = reporter_.is_full() ? Token{.offset = end_} : lexer_.next();
}

bool BodyParser::is(std::string_view keyword) const {
  return now().symbol == Symbol::Keyword && same_name(word(now()), keyword);
}

bool BodyParser::accept(Symbol symbol) {
  if (is(symbol)) {
    advance();
    return true;
  }
  return false;
}

bool BodyParser::accept(std::string_view keyword) {
  if (is(keyword)) {
    advance();
    return true;
  }
  return false;
}

bool BodyParser::expect(Symbol symbol, std::string_view wanted) {
  return accept(symbol) || unexpected(wanted);
}

bool BodyParser::expect(std::string_view keyword) {
  return accept(keyword) || unexpected(keyword);
}

bool BodyParser::name(Name& name, std::string_view wanted) {
  if (!is(Symbol::Identifier)) {
    return unexpected(wanted);
  }
  name = {word(now()), span_of(now())};
  advance();
  return true;
}

bool BodyParser::unexpected(std::string_view wanted) {
  const auto found = is(Symbol::End) ? std::string("the end of the block") : fmt::format("`{}`", word(now()));
  if (!reporter_.has_error_within(last_end_, now().end())) {
    reporter_.error(error::unexpected_symbol, span_of(now()),
                    fmt::format("{} stands where {} is expected.", found, wanted), fmt::format("Put {} here.", wanted));
  }
  return false;
}

bool BodyParser::refuse(Span span, std::string cause, std::string mend) {
  reporter_.error(error::refused_in_body, span, std::move(cause), std::move(mend));
  return false;
}

body::Unit BodyParser::function() {
  body::Unit unit{.function = true};
  const auto begin = now().offset;
  advance();
  if (name(unit.name, "the name of the FUNCTION") && expect(Symbol::Colon, "`:` and the type of the result")) {
    type(unit.result);
  }
  accept(Symbol::Semicolon);
  sections(unit, nullptr, 0, nullptr);
  statements(unit.statements);
  finish(unit, "END_FUNCTION");
  defined_once(unit.name);
  declared_once(unit.declarations);
  for (const body::Declaration& one : unit.declarations) {
    if (same_name(one.name.text, unit.name.text)) {  // which is what it gives
      twice(one.name);
    }
  }
  unit.span = since(begin);
  return unit;
}

body::Unit BodyParser::block(FunctionBlock& block, std::size_t index, std::vector<Declaration>& declarations) {
  body::Unit unit;
  const auto begin = now().offset;
  advance();
  while (is(Symbol::Identifier) && ahead().symbol == Symbol::Identifier &&
         (same_name(word(now()), "PUBLIC") || same_name(word(now()), "INTERNAL") || same_name(word(now()), "FINAL") ||
          same_name(word(now()), "ABSTRACT"))) {
    if (same_name(word(now()), "ABSTRACT")) {
      refuse(span_of(now()), "A block without a body of its own is ABSTRACT.", "Bring in the blocks that extend it.");
    }
    advance();
  }
  name(unit.name, "the name of the FUNCTION_BLOCK");
  block.name = unit.name;
  declarations.push_back({.begin = begin, .end = last_end_, .block = index, .is_head = true});
  while (is(Symbol::Identifier) && (same_name(word(now()), "EXTENDS") || same_name(word(now()), "IMPLEMENTS"))) {
    refuse(span_of(now()), fmt::format("{} makes an object of the block.", word(now())),
           "Write out what is inherited; a block here has variables and one body.");
    do {
      advance();
    } while (accept(Symbol::Identifier) && is(Symbol::Comma));
  }
  accept(Symbol::Semicolon);
  sections(unit, &block, index, &declarations);
  statements(unit.statements);
  finish(unit, "END_FUNCTION_BLOCK");
  declared_once(unit.declarations);
  unit.span = since(begin);
  block.span = unit.span;
  return unit;
}

/// Behind the statements stand the end, or methods, which are refused one by one.
void BodyParser::finish(body::Unit& unit, std::string_view end) {
  while (!is(Symbol::End) && !is(end)) {
    if (is("METHOD") || is("ACTION") || (is(Symbol::Identifier) && same_name(word(now()), "PROPERTY"))) {
      const std::string closing = fmt::format("END_{}", upper(word(now())));
      refuse(span_of(now()), fmt::format("This {} is a second body of {}.", word(now()), unit.name.text),
             "Write it as a FUNCTION of its own, or into the body.");
      while (!is(Symbol::End) && !same_name(word(now()), closing)) {
        advance();
      }
      advance();
      accept(Symbol::Semicolon);
      statements(unit.statements);  // the standard has methods before the body
      continue;
    }
    unexpected(end);
    advance();
    Statements rest;
    rounds(rest);  // the end that has no beginning may be that of a loop around it
  }
  if (!accept(end)) {
    reporter_.error(error::missing_end, unit.name.span, fmt::format("{} has no {}.", unit.name.text, end),
                    fmt::format("Write {} behind its last statement.", end));
  }
}

bool BodyParser::ends_list() const {
  return is(Symbol::End) || now().keyword == Keyword::ControlEnd || now().keyword == Keyword::EndFunctionBlock ||
         now().keyword == Keyword::UnitEnd || now().keyword == Keyword::Unit ||
         (is(Symbol::Identifier) && same_name(word(now()), "PROPERTY") && ahead().symbol == Symbol::Identifier) ||
         is("ELSE") || is("ELSIF") || is("UNTIL");
}

void BodyParser::statements(Statements& list) {
  if (++depth_ > static_cast<int>(deepest_expression) / 4) {
    reporter_.error(error::nested_too_deeply, span_of(now()), "The statements are nested too deeply.",
                    "Put the inner ones into a FUNCTION or a block of their own.");
    while (!is(Symbol::End)) {
      advance();
    }
  }
  while (!ends_list() && !starts_label()) {
    statement(list);
  }
  --depth_;
}

/// What a loop repeats: EXIT and CONTINUE have a meaning there.
void BodyParser::rounds(Statements& list) {
  ++loops_;
  statements(list);
  --loops_;
}

/// `3:` or `A, B:` or `1..4:` or `MODE.AUTO:` begins an arm of a CASE; the only statement with a colon right behind its
/// first words.
bool BodyParser::starts_label() const {
  const bool value = is(Symbol::Number) || is(Symbol::Typed) || is(Symbol::Identifier) || is(Symbol::Minus);
  if (is(Symbol::Identifier) && ahead().symbol == Symbol::Dot) {
    const Symbol behind = ahead(3).symbol;
    return ahead(2).symbol == Symbol::Dot ||
           (ahead(2).symbol == Symbol::Identifier && (behind == Symbol::Colon || behind == Symbol::Comma ||
                                                      (behind == Symbol::Dot && ahead(4).symbol == Symbol::Dot)));
  }
  return value && (!is(Symbol::Identifier) || ahead().symbol == Symbol::Colon || ahead().symbol == Symbol::Comma);
}

void BodyParser::statement(Statements& list) {
  if (accept(Symbol::Semicolon)) {
    return;
  }
  body::Statement one;
  const auto begin = now().offset;
  bool right = false;
  if (accept("IF")) {
    right = if_statement(one.node.emplace<body::If>());
  } else if (accept("CASE")) {
    right = case_statement(one.node.emplace<body::Case>());
  } else if (accept("FOR")) {
    right = for_statement(one.node.emplace<body::For>());
  } else if (accept("WHILE")) {
    right = while_statement(one.node.emplace<body::Loop>());
  } else if (accept("REPEAT")) {
    right = repeat_statement(one.node.emplace<body::Loop>());
  } else if (is("RETURN") || is("EXIT") || is("CONTINUE")) {
    if (loops_ == 0 && !is("RETURN")) {
      refuse(span_of(now()), fmt::format("{} stands outside of any loop.", upper(word(now()))),
             "Write RETURN, which ends the body, or put it between FOR, WHILE or REPEAT and the end of that loop.");
    }
    one.node = is("RETURN") ? body::Jump::Return : (is("EXIT") ? body::Jump::Exit : body::Jump::Continue);
    advance();
    right = end_of_statement();
  } else {
    right = named(one);
  }
  if (!right) {
    skip_statement();
    return;
  }
  one.span = since(begin);
  list.push_back(std::move(one));
}

bool BodyParser::end_of_statement() {
  if (accept(Symbol::Semicolon) || ends_list()) {
    return true;
  }
  const auto between = text_.substr(last_end_, now().offset - last_end_);
  if (between.find('\n') != std::string_view::npos) {
    reporter_.error(error::missing_semicolon, {last_end_, 1}, "A semicolon is missing here.", "Write ; here.");
    return true;
  }
  return unexpected("`;`");
}

/// Behind an error, on to the next semicolon that is not within an inner statement.
void BodyParser::skip_statement() {
  while (!ends_list() && !accept(Symbol::Semicolon)) {
    advance();
  }
}

/// Passes over a refused statement with all that is in it, up to behind its end.
void BodyParser::skip_to(std::string_view closing) {
  int open = 1;
  const auto opening = closing.substr(4);
  while (!is(Symbol::End) && now().keyword != Keyword::EndFunctionBlock && now().keyword != Keyword::UnitEnd) {
    open += is(opening) ? 1 : (is(closing) ? -1 : 0);
    advance();
    if (open == 0) {
      break;
    }
  }
  accept(Symbol::Semicolon);
}

/// The end of a statement of several lines.
bool BodyParser::end_with(std::string_view closing) {
  const bool ended = expect(closing);
  accept(Symbol::Semicolon);  // which some leave out here
  return ended;
}

bool BodyParser::while_statement(body::Loop& node) {
  library_.has_open_loops = true;
  node.condition = expression();
  if (node.condition == no_expression || !expect("DO")) {
    skip_to("END_WHILE");
    return true;
  }
  rounds(node.statements);
  return end_with("END_WHILE");
}

bool BodyParser::repeat_statement(body::Loop& node) {
  library_.has_open_loops = true;
  node.tested_first = false;
  rounds(node.statements);
  if (!expect("UNTIL") || (node.condition = expression()) == no_expression) {
    skip_to("END_REPEAT");
    return true;
  }
  accept(Symbol::Semicolon);  // which some write here
  return end_with("END_REPEAT");
}

bool BodyParser::if_statement(body::If& node) {
  do {
    auto& branch = node.branches.emplace_back();
    branch.condition = expression();
    if (branch.condition == no_expression) {
      while (!is("THEN") && !is(Symbol::Semicolon) && !ends_list()) {
        advance();
      }
    }
    if (!expect("THEN")) {
      skip_to("END_IF");
      return true;
    }
    statements(branch.statements);
  } while (accept("ELSIF"));
  if (accept("ELSE")) {
    statements(node.otherwise);
  }
  return end_with("END_IF");
}

bool BodyParser::label(body::Label& one) {
  one.low = expression();
  if (one.low == no_expression) {
    return false;
  }
  return !accept(Symbol::Dot) || upper_bound(one);
}

bool BodyParser::case_statement(body::Case& node) {
  node.selector = expression();
  if (node.selector == no_expression || !expect("OF")) {
    skip_to("END_CASE");
    return true;
  }
  while (!ends_list()) {
    auto& arm = node.arms.emplace_back();
    bool right = true;
    do {
      right = right && label(arm.labels.emplace_back());
    } while (right && accept(Symbol::Comma));
    if (!right || !expect(Symbol::Colon, "`:` behind the values of this arm")) {
      skip_to("END_CASE");
      return true;
    }
    statements(arm.statements);
  }
  if (accept("ELSE")) {
    accept(Symbol::Colon);
    statements(node.otherwise);
  }
  return end_with("END_CASE");
}

bool BodyParser::for_statement(body::For& node) {
  const bool head = name(node.variable, "the variable that counts") && expect(Symbol::Assign, "`:=`") &&
                    (node.from = expression()) != no_expression && expect("TO") &&
                    (node.to = expression()) != no_expression &&
                    (!accept("BY") || (node.by = expression()) != no_expression) && expect("DO");
  if (!head) {
    skip_to("END_FOR");
    return true;
  }
  const auto is_literal = [&](ExpressionId id) {
    return std::holds_alternative<body::Literal>(library_.expressions[id].node);
  };
  library_.has_open_loops = library_.has_open_loops || !is_literal(node.from) || !is_literal(node.to);
  rounds(node.statements);
  return end_with("END_FOR");
}

/// An assignment or a call.
bool BodyParser::named(body::Statement& statement) {
  if (!is(Symbol::Identifier)) {
    return unexpected("a statement");
  }
  body::Access target;
  if (!access(target)) {
    return false;
  }
  if (accept(Symbol::LeftParenthesis)) {
    auto& call = statement.node.emplace<body::Invoke>();
    call.instance = std::move(target);
    return arguments(call.arguments) && end_of_statement();
  }
  if (is(Symbol::Identifier) && same_name(target.name.text, "GOTO")) {
    return refuse(target.name.span, "A body has no GOTO.", "Write IF around what it passes over, or a loop with EXIT.");
  }
  if (is(Symbol::Identifier) && (same_name(word(now()), "REF") || same_name(word(now()), "S"))) {
    return refuse(span_of(now()), fmt::format("`{}=` is no assignment of the standard.", word(now())), "Write :=.");
  }
  if (!expect(Symbol::Assign, "`:=` or `(`")) {
    return false;
  }
  auto& assign = statement.node.emplace<body::Assign>();
  assign.target = std::move(target);
  assign.value = expression();
  return assign.value != no_expression && end_of_statement();
}

}  // namespace hysteron::language
