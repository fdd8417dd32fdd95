// Tokens: the words and signs that a diagram is made of.
#pragma once

#include <cstdint>
#include <string_view>

namespace hysteron::language {

enum class Symbol : std::uint8_t {
  End,
  Identifier,
  Keyword,
  Number,   ///< 42, 16#FF, 1.5e-6, not yet checked
  Typed,    ///< LREAL#1.0, T#50us, not yet checked
  Refused,  ///< stands for a value that was refused when it was read, so that reading goes on
  LeftParenthesis,
  RightParenthesis,
  LeftBracket,
  RightBracket,
  Comma,
  Semicolon,
  Colon,
  Dot,
  Assign,  ///< :=
  Arrow,   ///< =>
  Plus,
  Minus,
  Star,
  Slash,
  Power,
  Less,
  LessEqual,
  Greater,
  GreaterEqual,
  Equal,
  NotEqual,
  Ampersand
};

/// The keywords that a diagram uses, and the kinds of those that it refuses.
enum class Keyword : std::uint8_t {
  None,
  FunctionBlock,
  EndFunctionBlock,
  Var,
  VarInput,
  VarOutput,
  Constant,
  EndVar,
  True,
  False,
  Not,
  And,
  Or,
  Xor,
  Mod,
  ControlBegin,    ///< IF CASE FOR WHILE REPEAT
  ControlEnd,      ///< END_IF …
  Control,         ///< THEN ELSE EXIT RETURN …
  RefusedSection,  ///< VAR_IN_OUT VAR_TEMP …
  Qualifier,       ///< RETAIN PERSISTENT …
  Unit,            ///< PROGRAM TYPE FUNCTION …
  UnitEnd,         ///< END_PROGRAM …
  Derived,         ///< ARRAY STRUCT POINTER …
  At
};

struct Token {
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
  Symbol symbol = Symbol::End;
  Keyword keyword = Keyword::None;

  [[nodiscard]] std::uint32_t end() const { return offset + length; }
};

/// The keyword that a word is, without regard to case.
Keyword keyword_of(std::string_view word);

/// Whether a word names an elementary type of IEC 61131-3 that a diagram does not have: REAL, INT, TIME, STRING …
bool is_refused_type(std::string_view word);

/// Whether a word names one of the four types of a diagram: LREAL, BOOL, DINT, WORD.
bool is_elementary_type(std::string_view word);

}  // namespace hysteron::language
