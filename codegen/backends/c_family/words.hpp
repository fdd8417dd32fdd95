// Words that an identifier of generated C or C++ may not be: keywords, and the names that the generated text uses
// itself.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace hysteron {

/// Also restrict, which is one of C alone, and macros: errno, unix and linux; complex, imaginary and noreturn, where a
/// program includes the headers of C11 that define them before a generated one.
inline constexpr auto cpp_keywords = std::to_array<std::string_view>(
    {"alignas",     "alignof",   "and",        "and_eq",    "asm",      "auto",         "bitand",
     "bitor",       "bool",      "break",      "case",      "catch",    "char",         "char8_t",
     "char16_t",    "char32_t",  "class",      "compl",     "concept",  "const",        "consteval",
     "constexpr",   "constinit", "const_cast", "continue",  "co_await", "co_return",    "co_yield",
     "decltype",    "default",   "delete",     "do",        "double",   "dynamic_cast", "else",
     "enum",        "explicit",  "export",     "extern",    "false",    "float",        "for",
     "friend",      "goto",      "if",         "inline",    "int",      "long",         "mutable",
     "namespace",   "new",       "noexcept",   "not",       "not_eq",   "nullptr",      "operator",
     "or",          "or_eq",     "private",    "protected", "public",   "register",     "reinterpret_cast",
     "requires",    "return",    "short",      "signed",    "sizeof",   "static",       "static_assert",
     "static_cast", "struct",    "switch",     "template",  "this",     "thread_local", "throw",
     "true",        "try",       "typedef",    "typeid",    "typename", "union",        "unsigned",
     "using",       "virtual",   "void",       "volatile",  "wchar_t",  "while",        "xor",
     "xor_eq",      "errno",     "restrict",   "unix",      "linux",    "complex",      "imaginary",
     "noreturn"});

/// What the generated text calls its own.
inline constexpr auto cpp_own_words =
    std::to_array<std::string_view>({"std", "in", "out", "state", "params", "detail", "main"});

inline constexpr auto cpp_words = [] {
  std::array<std::string_view, cpp_keywords.size() + cpp_own_words.size()> words;
  std::ranges::copy(cpp_own_words, std::ranges::copy(cpp_keywords, words.begin()).out);
  return words;
}();

}  // namespace hysteron
