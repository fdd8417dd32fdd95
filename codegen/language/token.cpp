// The words with a meaning of their own.
#include "codegen/language/token.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hysteron::language {
namespace {

struct Word {
  std::string_view text;
  Keyword keyword;
};

constexpr std::array words{
    Word{"ACTION", Keyword::Unit},
    Word{"AND", Keyword::And},
    Word{"ARRAY", Keyword::Derived},
    Word{"AT", Keyword::At},
    Word{"BY", Keyword::Control},
    Word{"CASE", Keyword::ControlBegin},
    Word{"CLASS", Keyword::Unit},
    Word{"CONFIGURATION", Keyword::Unit},
    Word{"CONSTANT", Keyword::Constant},
    Word{"CONTINUE", Keyword::Control},
    Word{"DO", Keyword::Control},
    Word{"ELSE", Keyword::Control},
    Word{"ELSIF", Keyword::Control},
    Word{"END_ACTION", Keyword::UnitEnd},
    Word{"END_CASE", Keyword::ControlEnd},
    Word{"END_CLASS", Keyword::UnitEnd},
    Word{"END_CONFIGURATION", Keyword::UnitEnd},
    Word{"END_FOR", Keyword::ControlEnd},
    Word{"END_FUNCTION", Keyword::UnitEnd},
    Word{"END_FUNCTION_BLOCK", Keyword::EndFunctionBlock},
    Word{"END_IF", Keyword::ControlEnd},
    Word{"END_INTERFACE", Keyword::UnitEnd},
    Word{"END_METHOD", Keyword::UnitEnd},
    Word{"END_NAMESPACE", Keyword::UnitEnd},
    Word{"END_PROGRAM", Keyword::UnitEnd},
    Word{"END_REPEAT", Keyword::ControlEnd},
    Word{"END_RESOURCE", Keyword::UnitEnd},
    Word{"END_STRUCT", Keyword::UnitEnd},
    Word{"END_TYPE", Keyword::UnitEnd},
    Word{"END_VAR", Keyword::EndVar},
    Word{"END_WHILE", Keyword::ControlEnd},
    Word{"EXIT", Keyword::Control},
    Word{"FALSE", Keyword::False},
    Word{"FOR", Keyword::ControlBegin},
    Word{"FUNCTION", Keyword::Unit},
    Word{"FUNCTION_BLOCK", Keyword::FunctionBlock},
    Word{"IF", Keyword::ControlBegin},
    Word{"INTERFACE", Keyword::Unit},
    Word{"METHOD", Keyword::Unit},
    Word{"MOD", Keyword::Mod},
    Word{"NAMESPACE", Keyword::Unit},
    Word{"NON_RETAIN", Keyword::Qualifier},
    Word{"NOT", Keyword::Not},
    Word{"OF", Keyword::Control},
    Word{"OR", Keyword::Or},
    Word{"PERSISTENT", Keyword::Qualifier},
    Word{"POINTER", Keyword::Derived},
    Word{"PROGRAM", Keyword::Unit},
    Word{"REF_TO", Keyword::Derived},
    Word{"REPEAT", Keyword::ControlBegin},
    Word{"RESOURCE", Keyword::Unit},
    Word{"RETAIN", Keyword::Qualifier},
    Word{"RETURN", Keyword::Control},
    Word{"STRUCT", Keyword::Derived},
    Word{"THEN", Keyword::Control},
    Word{"TO", Keyword::Control},
    Word{"TRUE", Keyword::True},
    Word{"TYPE", Keyword::Unit},
    Word{"UNTIL", Keyword::Control},
    Word{"VAR", Keyword::Var},
    Word{"VAR_ACCESS", Keyword::RefusedSection},
    Word{"VAR_CONFIG", Keyword::RefusedSection},
    Word{"VAR_EXTERNAL", Keyword::RefusedSection},
    Word{"VAR_GLOBAL", Keyword::RefusedSection},
    Word{"VAR_INPUT", Keyword::VarInput},
    Word{"VAR_IN_OUT", Keyword::RefusedSection},
    Word{"VAR_OUTPUT", Keyword::VarOutput},
    Word{"VAR_TEMP", Keyword::RefusedSection},
    Word{"WHILE", Keyword::ControlBegin},
    Word{"XOR", Keyword::Xor},
};

constexpr std::array<std::string_view, 25> refused_types{
    "BYTE", "CHAR",  "DATE", "DATE_AND_TIME", "DT",    "DWORD", "INT",    "LDATE", "LDT",
    "LINT", "LTIME", "LTOD", "LWORD",         "REAL",  "SINT",  "STRING", "TIME",  "TIME_OF_DAY",
    "TOD",  "UDINT", "UINT", "ULINT",         "USINT", "WCHAR", "WSTRING"};

constexpr bool words_are_sorted() {
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!(words[i - 1].text < words[i].text)) {
      return false;
    }
  }
  return true;
}
static_assert(words_are_sorted());

constexpr std::size_t longest = [] {
  std::size_t length = 0;
  for (const auto& word : words) {
    length = std::max(length, word.text.size());
  }
  return length;
}();

/// For each first letter, the lengths that a keyword may have: most names are told from keywords by this alone.
constexpr std::array<std::uint32_t, 26> lengths = [] {
  std::array<std::uint32_t, 26> table{};
  for (const auto& word : words) {
    table[static_cast<std::size_t>(word.text[0] - 'A')] |= std::uint32_t{1} << word.text.size();
  }
  return table;
}();

constexpr char to_upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool equal(std::string_view word, std::string_view upper_case) {
  return word.size() == upper_case.size() &&
         std::equal(word.begin(), word.end(), upper_case.begin(), [](char a, char b) { return to_upper(a) == b; });
}

}  // namespace

Keyword keyword_of(std::string_view word) {
  static_assert(longest < 32);
  if (word.empty() || word.size() > longest) {
    return Keyword::None;
  }
  const char first = to_upper(word[0]);
  if (first < 'A' || first > 'Z' ||
      (lengths[static_cast<std::size_t>(first - 'A')] >> word.size() & std::uint32_t{1}) == 0) {
    return Keyword::None;
  }
  std::array<char, longest> buffer{};
  std::transform(word.begin(), word.end(), buffer.begin(), to_upper);
  const std::string_view wanted(buffer.data(), word.size());
  const auto* const found = std::lower_bound(words.begin(), words.end(), wanted,
                                             [](const Word& a, std::string_view b) { return a.text < b; });
  return found != words.end() && found->text == wanted ? found->keyword : Keyword::None;
}

bool is_refused_type(std::string_view word) {
  return std::any_of(refused_types.begin(), refused_types.end(),
                     [word](std::string_view type) { return equal(word, type); });
}

bool is_elementary_type(std::string_view word) {
  return equal(word, "LREAL") || equal(word, "BOOL") || equal(word, "DINT") || equal(word, "WORD");
}

}  // namespace hysteron::language
