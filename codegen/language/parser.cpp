#include "codegen/language/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "codegen/language/body_parser.hpp"
#include "support/errors.hpp"
#include "support/utf8.hpp"

namespace hysteron::language {
namespace {

/// A text for a message: the beginning of it, on one line.
std::string excerpt(std::string_view text) {
  constexpr std::size_t most = 40;
  const auto line = text.substr(0, std::min(text.find_first_of("\r\n"), most));
  return printable(line) + (line.size() < text.size() ? "…" : "");
}

}  // namespace

Parser::Parser(SourceFile& file, Reporter& reporter)
    : file_(file), text_(*file.text), reporter_(reporter), lexer_(text_, Comments::Annotated, &reporter) {
  constexpr std::size_t most_reserved = std::size_t{1} << 20U;
  const auto likely = std::min(text_.size() / 20, most_reserved);
  file_.expressions.reserve(likely);
  heights_.reserve(likely);
  parts_ = parts_with_bodies(text_);
  if (!parts_.empty()) {
    lexer_.take_foreign();  // who writes bodies writes them as PLC compilers take them, and so the blocks beside them
  }
  for (auto& token : window_) {
    token = lexer_.next();
  }
}

void Parser::read_file() {
  const auto library = parts_.empty() ? nullptr : std::make_shared<body::Library>();
  file_.bodies = library;
  while (!is(Symbol::End)) {
    const auto part = std::ranges::find(parts_, now().offset, &TextPart::begin);
    if (part != parts_.end()) {
      part_with_body(*part, *library);
    } else if (is(Keyword::FunctionBlock)) {
      function_block();
    } else {
      outside();
    }
  }
  if (file_.blocks.empty() && reporter_.empty()) {
    error(error::no_function_block, {0, 0}, "There is no FUNCTION_BLOCK in this file.",
          "Write FUNCTION_BLOCK, a name, the declarations, the calls, and END_FUNCTION_BLOCK.");
  }
  // The window of tokens has read on into the parts with bodies: what stands in them is theirs.
  const auto within = [&](const Comment& comment) {
    return std::ranges::any_of(parts_, [&](const TextPart& part) {
      return (part.kind != TextPart::Kind::Block || part.sequential) && comment.span.offset >= part.begin &&
             comment.span.offset < part.end;
    });
  };
  std::vector<Comment> comments = lexer_.comments();
  std::erase_if(comments, within);
  comments.insert(comments.end(), bodies_comments_.begin(), bodies_comments_.end());
  if (!parts_.empty()) {
    std::erase_if(comments, [&](const Comment& comment) { return has_no_key_of_ours(text_, comment.span); });
  }
  attach_annotations(file_, comments, declarations_, reporter_);
}

void Parser::part_with_body(const TextPart& part, body::Library& library) {
  const auto index = file_.blocks.size();
  Reporter unheard;  // of a block that is a diagram, errors are told as those of one
  const bool diagram = part.kind == TextPart::Kind::Block && !part.sequential;
  BodyParser reader(file_, library, diagram ? unheard : reporter_, part.begin, part.end);
  if (part.kind == TextPart::Kind::Types) {
    reader.types();
  } else if (part.kind == TextPart::Kind::Globals) {
    reader.globals();
  } else if (part.kind == TextPart::Kind::Function) {
    library.units.push_back(reader.function());
  } else if (diagram) {
    FunctionBlock unused;
    std::vector<Declaration> none;
    library.units.push_back(reader.block(unused, index, none));
    function_block();
    file_.blocks[index].body = static_cast<std::uint32_t>(library.units.size() - 1);
    return;
  } else {
    FunctionBlock block{.body = static_cast<std::uint32_t>(library.units.size()), .sequential = true};
    library.units.push_back(reader.block(block, index, declarations_));
    file_.blocks.push_back(std::move(block));
  }
  bodies_comments_.insert(bodies_comments_.end(), reader.comments().begin(), reader.comments().end());
  lexer_.go_to(part.end);
  for (auto& token : window_) {
    token = lexer_.next();
  }
  accept(Symbol::Semicolon);
}

void Parser::outside() {
  const bool unit = is(Keyword::Unit) || is(Keyword::UnitEnd);
  const bool is_program = unit && same_name(text_of(span_of(now())), "PROGRAM");
  const bool is_global = is(Keyword::RefusedSection) && same_name(text_of(span_of(now())), "VAR_GLOBAL");
  error(error::outside_function_block, span_of(now()),
        fmt::format("{} stands outside of a FUNCTION_BLOCK.", described(now())),
        is_global
            ? "Put its constants between VAR CONSTANT and END_VAR of the block; a sequential body takes them from here."
        : is_program ? "Make it a block with inputs and outputs: FUNCTION_BLOCK … END_FUNCTION_BLOCK."
        : unit       ? "A diagram file holds FUNCTION_BLOCKs only; move the rest into a file of its own."
                     : "Move it between FUNCTION_BLOCK and END_FUNCTION_BLOCK, or remove it.");
  while (!is(Symbol::End) && !is(Keyword::FunctionBlock)) {
    advance();
  }
}

void Parser::function_block() {
  const auto begin = now().offset;
  advance();
  const auto index = file_.blocks.size();
  auto& block = file_.blocks.emplace_back();
  expect_name(block.name, "the name of the FUNCTION_BLOCK");
  declarations_.push_back({.begin = begin, .end = last_.end(), .block = index, .is_head = true});
  while (!is(Keyword::EndFunctionBlock)) {
    if (ends_block()) {
      missing_end({begin, static_cast<std::uint32_t>(std::strlen("FUNCTION_BLOCK"))},
                  fmt::format("FUNCTION_BLOCK {} has no END_FUNCTION_BLOCK.", block.name.text),
                  "Write END_FUNCTION_BLOCK behind its last statement.");
      block.span = since(begin);
      return;
    }
    if (!starts_section()) {
      statement(block);
      continue;
    }
    if (!block.statements.empty()) {
      error(error::late_section, span_of(now()), "This section stands behind the statements.",
            "Move it up: all declarations stand before the first statement.");
    }
    section(block);
  }
  advance();
  block.span = since(begin);
}

void Parser::section(FunctionBlock& block) {
  const Token opening = now();
  const auto keyword = opening.keyword;
  Section kind = keyword == Keyword::VarInput    ? Section::Input
                 : keyword == Keyword::VarOutput ? Section::Output
                                                 : Section::Local;
  if (keyword == Keyword::RefusedSection) {
    error(error::refused_section, span_of(opening), fmt::format("A diagram has no {}.", described(opening)),
          "Use VAR_INPUT, VAR_OUTPUT, VAR or VAR CONSTANT; what goes in and out is wired through ports.");
  }
  advance();
  for (; is(Keyword::Constant) || is(Keyword::Qualifier); advance()) {
    if (is(Keyword::Constant) && keyword == Keyword::Var) {
      kind = Section::Constant;
    } else {
      error(error::refused_section, span_of(now()),
            fmt::format("{} does not go with {}.", described(now()), described(opening)),
            is(Keyword::Constant) ? "Put constants into a section VAR CONSTANT of their own."
                                  : "Remove it; what outlives a restart is said in the parameter file.");
    }
  }
  while (!is(Keyword::EndVar)) {
    const auto second = ahead(1).symbol;
    const bool is_statement = is(Symbol::Identifier) && (second == Symbol::LeftParenthesis || second == Symbol::Dot);
    if (is_statement || ends_block() || is(Keyword::EndFunctionBlock) || starts_section()) {
      missing_end(span_of(opening), fmt::format("The section {} has no END_VAR.", described(opening)),
                  "Write END_VAR behind its last declaration.");
      return;
    }
    declaration(block, kind);
  }
  advance();
}

void Parser::declaration(FunctionBlock& block, Section section) {
  const auto begin = now().offset;
  const auto first = block.variables.size();
  Variable variable{.section = section};
  const bool understood = declared_names() && expect(Symbol::Colon, "`:` and a type") && declared_type(variable) &&
                          (!accept(Symbol::Assign) || initial_value(variable.initial, variable.settings)) &&
                          expect_semicolon();
  if (understood) {
    for (std::size_t i = 0; i + 1 < names_.size(); ++i) {
      block.variables.push_back(variable);
      block.variables.back().name = names_[i];
    }
    variable.name = names_.back();
    block.variables.push_back(std::move(variable));
  } else {
    recover();
  }
  declarations_.push_back({.begin = begin,
                           .end = last_.end(),
                           .block = file_.blocks.size() - 1,
                           .first_variable = first,
                           .variable_count = block.variables.size() - first});
}

bool Parser::declared_names() {
  names_.clear();
  do {
    if (!expect_name(names_.emplace_back(), "the name of a variable")) {
      return false;
    }
  } while (accept(Symbol::Comma));
  if (is(Keyword::At)) {
    error(error::direct_address, span_of(now()), "AT binds the diagram to an address of one machine.",
          "Make it a VAR_INPUT or VAR_OUTPUT; addresses stand in the parameter file beside the diagram.");
    return false;
  }
  return true;
}

bool Parser::declared_type(Variable& variable) {
  if (is(Keyword::Derived) && same_name(text_of(span_of(now())), "ARRAY")) {
    return vector_type(variable);
  }
  if (is(Keyword::Derived) || (is(Symbol::Identifier) && is_refused_type(text_of(span_of(now()))))) {
    error(error::refused_type, span_of(now()), fmt::format("A diagram has no {}.", described(now())),
          is(Keyword::Derived) ? "Declare LREAL, BOOL, DINT, WORD, a vector of these, ARRAY[0..3] OF LREAL, or a block."
                               : "Write LREAL for numbers and times in seconds, BOOL, DINT or WORD.");
    return false;
  }
  return expect_name(variable.type, "a type: LREAL, BOOL, DINT, WORD or the name of a block");
}

/// ARRAY[0..N - 1] OF LREAL: the bounds are checked where the names in them are known.
bool Parser::vector_type(Variable& variable) {
  file_.has_vectors = true;
  advance();
  if (!expect(Symbol::LeftBracket, "`[`") || (variable.first = expression()) == no_expression ||
      !expect(Symbol::Dot, "`..` between the bounds")) {
    return false;
  }
  if (is(Symbol::Number) && text_of(span_of(now())).front() == '.') {
    ++window_[0].offset;  // the second point of 0..3 was taken for that of a number
    --window_[0].length;
  } else if (!expect(Symbol::Dot, "`..` between the bounds")) {
    return false;
  }
  variable.last = expression();
  if (variable.last == no_expression) {
    return false;
  }
  if (is(Symbol::Comma)) {
    error(error::refused_type, span_of(now()), "A diagram has vectors, and no arrays of several dimensions.",
          "Declare one vector for each row; a matrix is a parameter of HY_MATRIX_GAIN or HY_STATE_SPACE.");
    return false;
  }
  if (!expect(Symbol::RightBracket, "`]`")) {
    return false;
  }
  if (!same_name(text_of(span_of(now())), "OF")) {
    unexpected("`OF`", "Write ARRAY[0..3] OF LREAL.");
    return false;
  }
  advance();
  if (!is(Symbol::Identifier) || !is_elementary_type(text_of(span_of(now())))) {
    error(error::refused_type, span_of(now()), fmt::format("A diagram has no vector of {}.", described(now())),
          "Write ARRAY[0..3] OF LREAL, BOOL, DINT or WORD; declare an instance for each use of a block.");
    return false;
  }
  return expect_name(variable.type, "the type of the elements");
}

bool Parser::initial_value(ExpressionId& initial, std::vector<Argument>& settings) {
  const bool is_settings =
      is(Symbol::LeftParenthesis) && ahead(1).symbol == Symbol::Identifier && ahead(2).symbol == Symbol::Assign;
  if (is_settings) {
    advance();
    return arguments(settings);
  }
  initial = expression();
  return initial != no_expression;
}

void Parser::advance() {
  last_ = window_[0];
  window_[0] = window_[1];
  window_[1] = window_[2];
  window_[2] = reporter_.is_full() ? Token{.offset = static_cast<std::uint32_t>(text_.size())} : lexer_.next();
}

bool Parser::accept(Symbol symbol) {
  if (!is(symbol)) {
    return false;
  }
  advance();
  return true;
}

bool Parser::expect(Symbol symbol, std::string_view wanted) {
  if (accept(symbol)) {
    return true;
  }
  unexpected(wanted, fmt::format("Put {} here.", wanted));
  return false;
}

bool Parser::expect_name(Name& name, std::string_view wanted) {
  if (is(Symbol::Identifier)) {
    name = name_of(now());
    advance();
    return true;
  }
  if (!keyword_for_name(wanted)) {
    unexpected(wanted, fmt::format("Put {} here.", wanted));
  }
  return false;
}

/// A semicolon that is missing at the end of a line, or before an END, is reported where it belongs, and nothing is
/// skipped.
bool Parser::expect_semicolon() {
  if (accept(Symbol::Semicolon)) {
    return true;
  }
  const auto between = text_.substr(last_.end(), now().offset - last_.end());
  const bool line_ends = between.find('\n') != std::string_view::npos;
  const bool starts_anew = is(Symbol::Identifier) || is(Symbol::Keyword) || is(Symbol::End);
  const bool is_end = is(Keyword::EndVar) || is(Keyword::EndFunctionBlock) || is(Symbol::End);
  const bool is_next =
      is(Symbol::Identifier) && (ahead(1).symbol == Symbol::Assign || ahead(1).symbol == Symbol::LeftParenthesis ||
                                 ahead(1).symbol == Symbol::Colon);
  if (is_end || is_next || (line_ends && starts_anew)) {
    if (reporter_.has_error_within(last_.end(), now().offset)) {
      return line_ends;  // what was refused stands between: of this line nothing more is read
    }
    error(error::missing_semicolon, {last_.end(), 1},
          fmt::format("A semicolon is missing behind {}.", described(last_)), "Write ; here.");
    return true;
  }
  const auto decimals = is_decimal_comma() ? text_of(span_of(ahead(1))) : std::string_view();
  unexpected("`;`", !decimals.empty()
                        ? fmt::format("Write {}.{}: the decimal mark is a point.", text_of(span_of(last_)), decimals)
                    : is(Symbol::Arrow) ? "Write >= to compare."
                                        : "Put `;` here, or remove what is too much.");
  return false;
}

/// Whether now() is the comma of 1,5.
bool Parser::is_decimal_comma() {
  const auto are_digits = [](std::string_view text) {
    return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
  };
  return is(Symbol::Comma) && last_.symbol == Symbol::Number && last_.end() == now().offset &&
         ahead(1).symbol == Symbol::Number && ahead(1).offset == now().end() && are_digits(text_of(span_of(last_))) &&
         are_digits(text_of(span_of(ahead(1))));
}

/// Skips to behind the next semicolon, or to what ends or begins a part of a block.
void Parser::recover() {
  while (!is(Keyword::EndVar) && !is(Keyword::EndFunctionBlock) && !ends_block() && !starts_section()) {
    if (accept(Symbol::Semicolon)) {
      return;
    }
    advance();
  }
}

bool Parser::starts_section() const {
  return is(Keyword::Var) || is(Keyword::VarInput) || is(Keyword::VarOutput) || is(Keyword::RefusedSection);
}

bool Parser::ends_block() const {
  const bool starts_unit = is(Keyword::Unit) && ahead(1).symbol == Symbol::Identifier;
  return is(Symbol::End) || is(Keyword::FunctionBlock) || starts_unit;
}

std::string Parser::described(const Token& token) const {
  return token.symbol == Symbol::End ? "the end of the file" : fmt::format("`{}`", excerpt(text_of(span_of(token))));
}

/// Where something was refused just before, what is missing is that, and it has been said.
void Parser::unexpected(std::string_view wanted, std::string mend) {
  if (reporter_.has_error_within(last_.end(), now().offset)) {
    return;
  }
  error(error::unexpected_symbol, span_of(now()),
        fmt::format("{} stands where {} is expected.", described(now()), wanted), std::move(mend));
}

/// Where a comment without an end took the rest of the file along, that has been said.
void Parser::missing_end(Span opening, std::string cause, std::string mend) {
  if (!reporter_.has_error_within(last_.end(), now().end())) {
    error(error::missing_end, opening, std::move(cause), std::move(mend));
  }
}

/// Reports and passes over a keyword that is used like a name, unless it rather begins or ends a part of a block.
bool Parser::keyword_for_name(std::string_view wanted) {
  if (!is(Symbol::Keyword) || ends_block() || starts_section() || is(Keyword::EndVar) ||
      is(Keyword::EndFunctionBlock)) {
    return false;
  }
  error(error::keyword_as_name, span_of(now()),
        fmt::format("{} is a keyword of the language and cannot be {}.", described(now()), wanted),
        "Choose another name.");
  advance();
  return true;
}

void Parser::error(int number, Span span, std::string cause, std::string mend) {
  if (cause[0] >= 'a' && cause[0] <= 'z') {
    cause[0] = static_cast<char>(cause[0] - 'a' + 'A');
  }
  reporter_.error(number, span, std::move(cause), std::move(mend));
}

SourceFile parse(std::string path, std::string text, Diagnostics& diagnostics) {
  constexpr std::size_t largest = std::size_t{1} << 30U;
  SourceFile file;
  file.path = std::move(path);
  if (text.size() > largest) {
    diagnostics.error(error::unreadable_file, {.file = file.path}, "The file is larger than 1 GiB.",
                      "Split the diagram into several files.");
    text.clear();
    file.text = std::make_shared<const std::string>();
    return file;
  }
  file.text = std::make_shared<const std::string>(std::move(text));
  const auto& all = *file.text;
  file.line_starts.push_back(0);
  for (auto end = all.find('\n'); end != std::string::npos; end = all.find('\n', end + 1)) {
    file.line_starts.push_back(static_cast<std::uint32_t>(end) + 1);
  }
  Reporter reporter;
  Parser(file, reporter).read_file();
  file.valid = reporter.empty();
  reporter.publish(file, diagnostics);
  return file;
}

}  // namespace hysteron::language
