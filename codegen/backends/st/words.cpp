#include "codegen/backends/st/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_set>

#include "codegen/backends/st/c_names.hpp"
#include "codegen/graph/names.hpp"
#include "codegen/language/syntax.hpp"
#include "support/element_name.hpp"

namespace hysteron {
namespace {

/// Instruction list, whose operators are words in the same file.
constexpr auto instruction_words = std::to_array<std::string_view>({
    "LD",
    "LDN",
    "ST",
    "STN",
    "S",
    "R",
    "ANDN",
    "ORN",
    "XORN",
    "CAL",
    "CALC",
    "CALCN",
    "JMP",
    "JMPC",
    "JMPCN",
    "RET",
    "RETC",
    "RETCN",
});

/// Beside the names that the language refuses (is_reserved): what its compilers have of their own.
constexpr auto vendor_words = std::to_array<std::string_view>({
    // function blocks and functions of the standard that compilers declare in their libraries
    "DERIVATIVE",
    "INTEGRAL",
    "PID",
    "RAMP",
    "HYSTERESIS",
    "RTC",
    "SEMA",
    "DELAY",
    "AVERAGE",
    "CTU_DINT",
    "CTD_DINT",
    "CTUD_DINT",
    "ADD_TIME",
    "SUB_TIME",
    "MULTIME",
    "DIVTIME",
    "CONCAT_DATE_TOD",
    "SQR",
    "FRAC",
    "CEIL",
    "FLOOR",
    "NORM_X",
    "SCALE_X",
    "SWAP",
    "BCD_TO_INT",
    "TRUNC_INT",
    "TRUNC_DINT",
    // CODESYS and TwinCAT
    "ADR",
    "ADRINST",
    "BITADR",
    "SIZEOF",
    "XSIZEOF",
    "INDEXOF",
    "INI",
    "AND_THEN",
    "OR_ELSE",
    "BIT",
    "XINT",
    "UXINT",
    "XWORD",
    "PVOID",
    "POINTER",
    "REFERENCE",
    "REF",
    "PROPERTY",
    "END_PROPERTY",
    "GET",
    "SET",
    "VAR_STAT",
    "VAR_INST",
    "VAR_GENERIC",
    "PERSISTENT",
    "UNION",
    "END_UNION",
    "LIBRARY",
    "PARAMS",
    "IMPLEMENTATION",
    "END_IMPLEMENTATION",
    "TEST_AND_SET",
    "ANY",
    "ANY_BIT",
    "ANY_DATE",
    "ANY_INT",
    "ANY_NUM",
    "ANY_REAL",
    "ANY_STRING",
    "ANY_DERIVED",
    "ANY_ELEMENTARY",
    "ANY_MAGNITUDE",
    "CANCEL",
    "ASSERT",
    "LOWER_BOUND",
    "UPPER_BOUND",
    "LTIME_OF_DAY",
    "LDATE_AND_TIME",
    // MATIEC and STruC++, and the C that they make
    "DREF",
    "END_GET",
    "END_SET",
    "REFERENCE_TO",
    "FILE",
    "STRING_VAR",
    "WSTRING_VAR",
    "UNKNOWN_ENUM",
});

/// Functions of the standard that have a form for each type: ADD_INT, MAX_TIME, MUX_DINT_REAL.
constexpr auto typed_functions = std::to_array<std::string_view>({
    "ABS", "SQRT", "LN",   "LOG",   "EXP",  "SIN",    "COS",    "TAN",    "ASIN",    "ACOS", "ATAN",  "ADD",
    "SUB", "MUL",  "DIV",  "MOD",   "EXPT", "MOVE",   "SHL",    "SHR",    "ROL",     "ROR",  "AND",   "OR",
    "XOR", "NOT",  "SEL",  "MAX",   "MIN",  "LIMIT",  "MUX",    "GT",     "GE",      "EQ",   "LE",    "LT",
    "NE",  "LEN",  "LEFT", "RIGHT", "MID",  "CONCAT", "INSERT", "DELETE", "REPLACE", "FIND", "TRUNC",
});

constexpr auto typed_function_types = std::to_array<std::string_view>({
    "BOOL", "BYTE",  "WORD",  "DWORD", "LWORD", "SINT", "INT",  "DINT", "LINT", "USINT",
    "UINT", "UDINT", "ULINT", "REAL",  "LREAL", "TIME", "DATE", "TOD",  "DT",   "STRING",
});

/// Of TIA Portal.
constexpr auto scl_words = std::to_array<std::string_view>({
    "BEGIN",
    "BLOCK_DB",
    "BLOCK_FB",
    "BLOCK_FC",
    "BLOCK_SDB",
    "BLOCK_SFB",
    "BLOCK_SFC",
    "CONST",
    "END_CONST",
    "DATA_BLOCK",
    "END_DATA_BLOCK",
    "DB",
    "DI",
    "FB",
    "FC",
    "OB",
    "SDB",
    "SFB",
    "SFC",
    "UDT",
    "GOTO",
    "LABEL",
    "END_LABEL",
    "NETWORK",
    "ORGANIZATION_BLOCK",
    "END_ORGANIZATION_BLOCK",
    "S5TIME",
    "S5T",
    "TIMER",
    "COUNTER",
    "TITLE",
    "VERSION",
    "AUTHOR",
    "FAMILY",
    "NAME",
    "KNOW_HOW_PROTECT",
    "UNLINKED",
    "VOID",
    "REGION",
    "END_REGION",
    "VARIANT",
    "OK",
    "NIL",
    "DB_ANY",
    "HW_IO",
    "TIME_TCK",
    "RUNTIME",
    "PEEK",
    "POKE",
});

bool is_instruction(std::string_view upper) {
  return std::ranges::find(instruction_words, upper) != instruction_words.end();
}

/// LREAL_TO_DINT, BCD_TO_UINT and their like.
bool is_conversion(std::string_view name) {
  const auto middle = name.find("_TO_");
  const auto is_side = [](std::string_view side) { return side == "BCD" || is_reserved(side); };
  return middle != std::string_view::npos && is_side(name.substr(0, middle)) && is_side(name.substr(middle + 4));
}

/// A function with the types of its arguments behind it.
bool is_typed_function(std::string_view name) {
  std::size_t underscore = name.find('_');
  if (underscore == std::string_view::npos ||
      std::ranges::find(typed_functions, name.substr(0, underscore)) == typed_functions.end()) {
    return false;
  }
  while (underscore != std::string_view::npos) {
    const std::size_t begin = underscore + 1;
    underscore = name.find('_', begin);
    if (std::ranges::find(typed_function_types, name.substr(begin, underscore - begin)) == typed_function_types.end()) {
      return false;
    }
  }
  return true;
}

/// What the C is made of that some compilers make of Structured Text.
bool is_c_name(std::string_view name) {
  static const std::unordered_set<std::string_view> names = [] {
    std::unordered_set<std::string_view> list;
    for (std::string_view rest = c_names_in_capitals; !rest.empty();) {
      const auto length = std::min(rest.find_first_of(" \n"), rest.size());
      list.insert(rest.substr(0, length));
      rest.remove_prefix(std::min(length + 1, rest.size()));
    }
    list.erase("");
    return list;
  }();
  return names.contains(name);
}

}  // namespace

bool is_st_word(std::string_view name) {
  static const std::unordered_set<std::string_view> words(vendor_words.begin(), vendor_words.end());
  const std::string upper = language::upper(name);
  return words.contains(upper) || is_instruction(upper) || is_reserved(upper) || is_conversion(upper) ||
         is_typed_function(upper) || is_c_name(upper);
}

bool is_scl_word(std::string_view name) {
  static const std::unordered_set<std::string_view> words(scl_words.begin(), scl_words.end());
  return words.contains(language::upper(name)) || is_st_word(name);
}

std::string st_pin_name(std::string_view name, const StDialect& dialect) {
  const bool kept = dialect.shape == StDialect::Shape::OneFile || is_instruction(name) ||
                    !(dialect.shape == StDialect::Shape::Source ? is_scl_word(name) : is_st_word(name));
  if (const auto element = element_of(name)) {  // a pin for each element of a vector
    return flat_element_name(st_pin_name(element->vector, dialect), element->index);
  }
  return kept ? std::string(name) : std::string(name) + "_2";
}

}  // namespace hysteron
