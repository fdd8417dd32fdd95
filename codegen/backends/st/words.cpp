#include "codegen/backends/st/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <unordered_set>

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

/// LREAL_TO_DINT and its like.
bool is_conversion(std::string_view name) {
  const auto middle = name.find("_TO_");
  return middle != std::string_view::npos && is_reserved(name.substr(0, middle)) &&
         is_reserved(name.substr(middle + 4));
}

}  // namespace

bool is_st_word(std::string_view name) {
  static const std::unordered_set<std::string_view> words(vendor_words.begin(), vendor_words.end());
  const std::string upper = language::upper(name);
  return words.contains(upper) || is_instruction(upper) || is_reserved(upper) || is_conversion(upper);
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
