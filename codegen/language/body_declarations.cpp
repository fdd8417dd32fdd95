// Declarations of sequential bodies: sections, types and initial values.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "codegen/language/body_parser.hpp"
#include "codegen/language/refused_types.hpp"
#include "support/errors.hpp"

namespace hysteron::language {

using body::Role;

namespace {

/// What a subrange or an enumeration may be kept in.
bool is_whole_type(std::string_view name) {
  constexpr std::array<std::string_view, 9> types{"SINT",  "INT",  "DINT", "USINT", "UINT",
                                                  "UDINT", "BYTE", "WORD", "DWORD"};
  return std::ranges::any_of(types, [&](std::string_view type) { return same_name(type, name); });
}

}  // namespace

/// Upper and lower case do not differ.
void BodyParser::declared_once(const std::vector<body::Declaration>& list) {
  std::set<std::string> names;
  for (const body::Declaration& one : list) {
    if (!names.insert(upper(one.name.text)).second) {
      twice(one.name);
    }
  }
}

void BodyParser::twice(const Name& name) {
  reporter_.error(error::duplicate_name, name.span, fmt::format("'{}' is declared twice.", name.text),
                  "Rename one of the two, or remove it; upper and lower case do not differ.");
}

/// Of a TYPE and of a FUNCTION: both are found by name.
void BodyParser::defined_once(const Name& name) {
  const bool known =
      std::ranges::any_of(library_.types, [&](const auto& one) { return same_name(one.name.text, name.text); }) ||
      std::ranges::any_of(library_.units,
                          [&](const auto& one) { return one.function && same_name(one.name.text, name.text); });
  if (known && !name.text.empty()) {
    twice(name);
  }
}

bool BodyParser::starts_section() const {
  return now().keyword == Keyword::Var || now().keyword == Keyword::VarInput || now().keyword == Keyword::VarOutput ||
         now().keyword == Keyword::RefusedSection || is_shared_section();
}

bool BodyParser::is_shared_section() const {
  return is(Symbol::Identifier) && same_name(word(now()), "VAR_STAT");
}

void BodyParser::sections(body::Unit& unit, FunctionBlock* block, std::size_t index,
                          std::vector<Declaration>* declarations) {
  while (starts_section()) {
    section(unit, block, index, declarations);
  }
}

void BodyParser::section(body::Unit& unit, FunctionBlock* block, std::size_t index,
                         std::vector<Declaration>* declarations) {
  Role role = is("VAR_INPUT")    ? Role::Input
              : is("VAR_OUTPUT") ? Role::Output
              : is("VAR_IN_OUT") ? Role::InOut
              : is("VAR_TEMP")   ? Role::Temporary
                                 : Role::Local;
  if (is_shared_section()) {
    reporter_.error(error::refused_section, span_of(now()), "VAR_STAT is shared by all instances of the block.",
                    "Write VAR, which each instance has by itself, or put it into VAR_GLOBAL of this file.");
  }
  const bool external = is("VAR_EXTERNAL");
  auto& list = external ? unit.externals : unit.declarations;
  if (now().keyword == Keyword::RefusedSection && role == Role::Local && !external) {
    reporter_.error(error::refused_section, span_of(now()), fmt::format("{} reaches out of the block.", word(now())),
                    "Hand the variable over as VAR_INPUT, VAR_OUTPUT or VAR_IN_OUT.");
  }
  advance();
  while (now().keyword == Keyword::Constant || now().keyword == Keyword::Qualifier) {
    role = is("CONSTANT") && role == Role::Local ? Role::Constant : role;
    advance();
  }
  while (!is("END_VAR") && !is(Symbol::End) && !starts_section() && now().keyword != Keyword::EndFunctionBlock) {
    const auto begin = now().offset;
    const auto first = list.size();
    declaration_or_nothing(role, list);
    if (block == nullptr || external) {
      continue;
    }
    for (std::size_t i = first; i < unit.declarations.size(); ++i) {
      const Section section = role == Role::Input || role == Role::InOut ? Section::Input
                              : role == Role::Output                     ? Section::Output
                              : role == Role::Constant                   ? Section::Constant
                                                                         : Section::Local;
      block->variables.push_back(
          {.name = unit.declarations[i].name, .type = unit.declarations[i].type.name, .section = section});
    }
    declarations->push_back({.begin = begin,
                             .end = last_end_,
                             .block = index,
                             .first_variable = first,
                             .variable_count = unit.declarations.size() - first});
  }
  end_section();
  accept(Symbol::Semicolon);
}

void BodyParser::end_section() {
  if (!accept("END_VAR")) {
    reporter_.error(error::missing_end, span_of(now()), "This section has no END_VAR.",
                    "Write END_VAR behind its last declaration.");
  }
}

/// What cannot be read is passed over, up to the next one.
void BodyParser::declaration_or_nothing(Role role, std::vector<body::Declaration>& list) {
  const auto first = list.size();
  if (!declaration(role, list)) {
    list.resize(first);
    while (!is("END_VAR") && !is(Symbol::End) && !accept(Symbol::Semicolon)) {
      advance();
    }
  }
}

bool BodyParser::declaration(Role role, std::vector<body::Declaration>& list) {
  const auto first = list.size();
  do {
    auto& declared = list.emplace_back().name;
    const bool keyword = is(Symbol::Keyword) && (ahead().symbol == Symbol::Colon || ahead().symbol == Symbol::Comma);
    if (keyword) {
      reporter_.error(error::keyword_as_name, span_of(now()),
                      fmt::format("{} is a keyword of the language and cannot be the name of a variable.", word(now())),
                      "Choose another name.");
      declared = {word(now()), span_of(now())};
      advance();
    } else if (!name(declared, "the name of a variable")) {
      return false;
    }
  } while (accept(Symbol::Comma));
  if (is("AT")) {
    reporter_.error(error::direct_address, span_of(now()), "AT binds the block to an address of one machine.",
                    "Make it a VAR_INPUT or VAR_OUTPUT.");
    return false;
  }
  body::Declaration common{.role = role};
  if (!expect(Symbol::Colon, "`:` and a type") || !type(common.type)) {
    return false;
  }
  // MOTOR(SPEED := 1.0) sets up an instance as := ( … ) does.
  const bool setup = is(Symbol::LeftParenthesis) && ahead().symbol == Symbol::Identifier;
  if ((accept(Symbol::Assign) || setup) && !initial(common.initial)) {
    return false;
  }
  for (std::size_t i = first; i < list.size(); ++i) {
    const Name name = list[i].name;
    list[i] = common;
    list[i].name = name;
  }
  return expect(Symbol::Semicolon, "`;`");
}

/// 0..9
bool BodyParser::bounds(body::Label& one) {
  one.low = expression();
  return one.low != no_expression && expect(Symbol::Dot, "`..` between the bounds") && upper_bound(one);
}

/// Behind the first point of `0..9`.
bool BodyParser::upper_bound(body::Label& one) {
  if (is(Symbol::Number) && word(now()).front() == '.') {  // 0..9 is read as 0, . and .9
    one.high = number();
  } else {
    accept(Symbol::Dot);
    one.high = expression();
  }
  return one.high != no_expression;
}

bool BodyParser::array_type(body::TypeSpec& spec) {
  if (!expect(Symbol::LeftBracket, "`[` and the bounds")) {
    return false;
  }
  do {
    body::Label one;
    if (!bounds(one)) {
      return false;
    }
    spec.dimensions.emplace_back(one.low, one.high);
  } while (accept(Symbol::Comma));
  return expect(Symbol::RightBracket, "`]`") && expect("OF") && type(spec);
}

bool BodyParser::enumeration(body::TypeSpec& spec) {
  do {
    auto& [value, number] = spec.values.emplace_back(Name{}, no_expression);
    if (!name(value, "the name of a value")) {
      return false;
    }
    for (const auto& before : std::span(spec.values).first(spec.values.size() - 1)) {
      if (same_name(before.first.text, value.text)) {
        twice(value);
        break;
      }
    }
    if (accept(Symbol::Assign) && (number = expression()) == no_expression) {
      return false;
    }
  } while (accept(Symbol::Comma));
  if (!expect(Symbol::RightParenthesis, "`,` or `)`")) {
    return false;
  }
  if (is(Symbol::Identifier)) {  // (A, B) INT: what it is kept in
    spec.name = {word(now()), span_of(now())};
    advance();
  }
  return true;
}

bool BodyParser::structure(body::TypeSpec& spec) {
  while (!is("END_STRUCT") && !is(Symbol::End)) {
    if (!declaration(Role::Local, spec.fields)) {
      return false;
    }
  }
  declared_once(spec.fields);
  return expect("END_STRUCT");
}

bool BodyParser::type(body::TypeSpec& spec) {
  const auto place = span_of(now());
  if (accept("ARRAY")) {
    return array_type(spec);
  }
  if (accept("STRUCT")) {
    spec.name = {word({.offset = place.offset, .length = place.length}), place};
    return structure(spec);
  }
  if (accept(Symbol::LeftParenthesis)) {
    spec.name = {word({.offset = place.offset, .length = place.length}), place};
    return enumeration(spec);
  }
  if (is("POINTER") || is("REF_TO") || (is(Symbol::Identifier) && same_name(word(now()), "REFERENCE"))) {
    return refuse(place, fmt::format("A body has no {}.", word(now())),
                  "Hand the variable over as VAR_IN_OUT, or use an array and an index.");
  }
  if (!name(spec.name, "a type")) {
    return false;
  }
  if (is(Symbol::LeftParenthesis) && is_whole_type(spec.name.text)) {
    const bool values = ahead().symbol == Symbol::Identifier && ahead(2).symbol != Symbol::Dot;
    advance();
    return values ? enumeration(spec) : bounds(spec.subrange) && expect(Symbol::RightParenthesis, "`)`");
  }
  for (const auto* text : {"STRING", "WSTRING", "CHAR", "WCHAR"}) {
    if (same_name(spec.name.text, text)) {
      return refuse(place, fmt::format("A body has no {}.", spec.name.text),
                    "Take the text out: a block here computes with numbers and truth values.");
    }
  }
  if (const auto mend = in_place_of_type(spec.name.text); !mend.empty()) {
    return refuse(place, fmt::format("A body has no {}: its numbers have 32 bits, or are LREAL.", spec.name.text),
                  std::string(mend));
  }
  return true;
}

bool BodyParser::element(body::Initial& list) {
  auto& one = list.elements.emplace_back();
  const bool repeated = is(Symbol::Number) && ahead().symbol == Symbol::LeftParenthesis;
  if (repeated) {
    one.repeat = number();
    advance();
  }
  if (repeated && is(Symbol::RightParenthesis)) {
    advance();
    return true;
  }
  return initial(one) && (!repeated || expect(Symbol::RightParenthesis, "`)`"));
}

bool BodyParser::initial(body::Initial& value) {
  const auto begin = now().offset;
  bool right = true;
  if (accept(Symbol::LeftBracket)) {
    ++depth_;
    do {
      right = element(value);
    } while (right && accept(Symbol::Comma));
    --depth_;
    right = right && expect(Symbol::RightBracket, "`,` or `]`");
  } else if (is(Symbol::LeftParenthesis) && ahead().symbol == Symbol::Identifier && ahead(2).symbol == Symbol::Assign) {
    advance();
    ++depth_;
    do {
      auto& [member, inner] = value.members.emplace_back();
      right = name(member, "the name of a member") && expect(Symbol::Assign, "`:=`") && initial(inner);
    } while (right && accept(Symbol::Comma));
    --depth_;
    right = right && expect(Symbol::RightParenthesis, "`,` or `)`");
  } else {
    value.value = expression();
    right = value.value != no_expression;
    // The older form of a list: A : ARRAY[0..2] OF INT := 1, 2, 3;
    if (right && is(Symbol::Comma) && ahead(2).symbol != Symbol::Assign && depth_ == 0) {
      value.elements.emplace_back().value = std::exchange(value.value, no_expression);
      while (right && accept(Symbol::Comma)) {
        right = element(value);
      }
    }
  }
  value.span = since(begin);
  return right;
}

void BodyParser::globals() {
  advance();
  Role role = Role::Local;
  while (now().keyword == Keyword::Constant || now().keyword == Keyword::Qualifier) {
    role = is("CONSTANT") ? Role::Constant : role;
    advance();
  }
  while (!is("END_VAR") && !is(Symbol::End)) {
    declaration_or_nothing(role, library_.globals);
  }
  declared_once(library_.globals);
  end_section();
}

void BodyParser::types() {
  advance();
  while (!is("END_TYPE") && !is(Symbol::End)) {
    body::TypeDefinition one;
    if (name(one.name, "the name of a type") && expect(Symbol::Colon, "`:` and a type") && type(one.type) &&
        (!accept(Symbol::Assign) || initial(one.initial))) {
      accept(Symbol::Semicolon);
      defined_once(one.name);
      library_.types.push_back(std::move(one));
      continue;
    }
    while (!is("END_TYPE") && !is(Symbol::End) && !accept(Symbol::Semicolon)) {
      advance();
    }
  }
  if (!accept("END_TYPE")) {
    reporter_.error(error::missing_end, span_of(now()), "This TYPE has no END_TYPE.",
                    "Write END_TYPE behind the last type.");
  }
}

}  // namespace hysteron::language
