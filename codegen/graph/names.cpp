#include "codegen/graph/names.hpp"

#include <fmt/format.h>

#include <unordered_set>

#include "codegen/language/syntax.hpp"

namespace hysteron {

bool elementary_type(std::string_view name, Type& type) {
  for (const Type candidate : {Type::Real, Type::Bool, Type::Int, Type::Word}) {
    if (language::same_name(name, type_name(candidate))) {
      type = candidate;
      return true;
    }
  }
  return false;
}

std::string_view type_name(Type type) {
  switch (type) {
    case Type::Real:
      return "LREAL";
    case Type::Bool:
      return "BOOL";
    case Type::Int:
      return "DINT";
    case Type::Word:
      return "WORD";
  }
  return "";
}

std::string literal_text(Type type, double value) {
  switch (type) {
    case Type::Real: {
      std::string text = fmt::format("{}", value);
      return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
    }
    case Type::Bool:
      return value != 0.0 ? "TRUE" : "FALSE";
    case Type::Int:
      return fmt::format("{}", static_cast<std::int64_t>(value));
    case Type::Word:
      return fmt::format("WORD#16#{:X}", static_cast<unsigned>(value));
  }
  return "";
}

bool is_reserved(std::string_view name) {
  static const std::unordered_set<std::string_view> reserved = [] {
    std::unordered_set<std::string_view> words;
    for (const std::string_view word : {"DT",
                                        "TOD",
                                        "DATE",
                                        "STEP",
                                        "TASK",
                                        "ON",
                                        "EN",
                                        "ENO",
                                        "TIME",
                                        "LTIME",
                                        "DATE_AND_TIME",
                                        "TIME_OF_DAY",
                                        "LIMIT",
                                        "MAX",
                                        "MIN",
                                        "ABS",
                                        "SEL",
                                        "MUX",
                                        "SQRT",
                                        "LN",
                                        "LOG",
                                        "EXP",
                                        "SIN",
                                        "COS",
                                        "TAN",
                                        "ASIN",
                                        "ACOS",
                                        "ATAN",
                                        "ATAN2",
                                        "EXPT",
                                        "TRUNC",
                                        "ROUND",
                                        "ADD",
                                        "SUB",
                                        "MUL",
                                        "DIV",
                                        "MOD",
                                        "MOVE",
                                        "SHL",
                                        "SHR",
                                        "ROL",
                                        "ROR",
                                        "AND",
                                        "OR",
                                        "XOR",
                                        "NOT",
                                        "GT",
                                        "GE",
                                        "EQ",
                                        "LE",
                                        "LT",
                                        "NE",
                                        "LEN",
                                        "LEFT",
                                        "RIGHT",
                                        "MID",
                                        "CONCAT",
                                        "INSERT",
                                        "DELETE",
                                        "REPLACE",
                                        "FIND",
                                        "BOOL",
                                        "BYTE",
                                        "WORD",
                                        "DWORD",
                                        "LWORD",
                                        "SINT",
                                        "INT",
                                        "DINT",
                                        "LINT",
                                        "USINT",
                                        "UINT",
                                        "UDINT",
                                        "ULINT",
                                        "REAL",
                                        "LREAL",
                                        "STRING",
                                        "WSTRING",
                                        "TRUE",
                                        "FALSE",
                                        "IF",
                                        "THEN",
                                        "ELSE",
                                        "ELSIF",
                                        "END_IF",
                                        "FOR",
                                        "TO",
                                        "BY",
                                        "DO",
                                        "END_FOR",
                                        "WHILE",
                                        "END_WHILE",
                                        "REPEAT",
                                        "UNTIL",
                                        "END_REPEAT",
                                        "CASE",
                                        "OF",
                                        "END_CASE",
                                        "EXIT",
                                        "RETURN",
                                        "CONTINUE",
                                        "VAR",
                                        "VAR_INPUT",
                                        "VAR_OUTPUT",
                                        "VAR_IN_OUT",
                                        "VAR_TEMP",
                                        "VAR_GLOBAL",
                                        "VAR_EXTERNAL",
                                        "VAR_ACCESS",
                                        "VAR_CONFIG",
                                        "CONSTANT",
                                        "RETAIN",
                                        "NON_RETAIN",
                                        "END_VAR",
                                        "FUNCTION",
                                        "END_FUNCTION",
                                        "FUNCTION_BLOCK",
                                        "END_FUNCTION_BLOCK",
                                        "PROGRAM",
                                        "END_PROGRAM",
                                        "CONFIGURATION",
                                        "END_CONFIGURATION",
                                        "RESOURCE",
                                        "END_RESOURCE",
                                        "TYPE",
                                        "END_TYPE",
                                        "STRUCT",
                                        "END_STRUCT",
                                        "ARRAY",
                                        "AT",
                                        "WITH",
                                        "PRIORITY",
                                        "SINGLE",
                                        "INTERVAL",
                                        "ACTION",
                                        "END_ACTION",
                                        "TRANSITION",
                                        "END_TRANSITION",
                                        "INITIAL_STEP",
                                        "END_STEP",
                                        "FROM",
                                        "READ_ONLY",
                                        "READ_WRITE",
                                        "F_EDGE",
                                        "R_EDGE",
                                        "SR",
                                        "RS",
                                        "R_TRIG",
                                        "F_TRIG",
                                        "CTU",
                                        "CTD",
                                        "CTUD",
                                        "TP",
                                        "TON",
                                        "TOF",
                                        "SUPER",
                                        "THIS",
                                        "METHOD",
                                        "END_METHOD",
                                        "CLASS",
                                        "END_CLASS",
                                        "INTERFACE",
                                        "END_INTERFACE",
                                        "NAMESPACE",
                                        "END_NAMESPACE",
                                        "USING",
                                        "EXTENDS",
                                        "IMPLEMENTS",
                                        "ABSTRACT",
                                        "FINAL",
                                        "OVERRIDE",
                                        "PUBLIC",
                                        "PRIVATE",
                                        "PROTECTED",
                                        "INTERNAL",
                                        "OVERLAP",
                                        "REF_TO",
                                        "NULL",
                                        "DEREF",
                                        "LDT",
                                        "LDATE",
                                        "LTOD",
                                        "CHAR",
                                        "WCHAR"}) {
      words.insert(word);
    }
    return words;
  }();
  return reserved.contains(language::upper(name));
}

}  // namespace hysteron
