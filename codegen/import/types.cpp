#include "codegen/import/types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "codegen/graph/names.hpp"
#include "codegen/graph/vectors.hpp"
#include "codegen/language/time_literal.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/trimmed.hpp"
#include "support/whole_number.hpp"

namespace hysteron::import {
namespace {

struct TypeRow {
  std::string_view name;
  KnownType known;
};
constexpr std::string_view wider = "it has 64 bits here, and other last places";
constexpr std::string_view longer = "it is a DINT here, and wraps elsewhere";
constexpr std::array types{TypeRow{"LREAL", {Type::Real}},
                           TypeRow{"REAL", {Type::Real, wider}},
                           TypeRow{"BOOL", {Type::Bool}},
                           TypeRow{"DINT", {Type::Int}},
                           TypeRow{"INT", {Type::Int, longer}},
                           TypeRow{"SINT", {Type::Int, longer}},
                           TypeRow{"USINT", {Type::Int, longer}},
                           TypeRow{"UINT", {Type::Int, longer}},
                           TypeRow{"WORD", {Type::Word}},
                           TypeRow{"TIME", {Type::Real, "it is an LREAL in seconds here"}},
                           TypeRow{"LTIME", {Type::Real, "it is an LREAL in seconds here"}}};

struct Renamed {
  std::string_view name;
  std::string_view here;
};
constexpr std::array conversions{Renamed{"REAL_TO_LREAL", "MOVE"},
                                 Renamed{"LREAL_TO_REAL", "MOVE"},
                                 Renamed{"INT_TO_DINT", "MOVE"},
                                 Renamed{"INT_TO_REAL", "DINT_TO_LREAL"},
                                 Renamed{"INT_TO_LREAL", "DINT_TO_LREAL"},
                                 Renamed{"DINT_TO_REAL", "DINT_TO_LREAL"},
                                 Renamed{"REAL_TO_DINT", "LREAL_TO_DINT"},
                                 Renamed{"REAL_TO_INT", "LREAL_TO_DINT"},
                                 Renamed{"LREAL_TO_INT", "LREAL_TO_DINT"},
                                 Renamed{"BOOL_TO_INT", "BOOL_TO_DINT"},
                                 Renamed{"TIME_TO_LREAL", ""}};  // seconds in some compilers, milliseconds in others

constexpr std::array<std::string_view, 22> functions{
    "MOVE", "ABS",   "SQRT", "LN",  "LOG", "EXP",   "SIN", "COS", "TAN",           "ASIN",          "ACOS",
    "ATAN", "TRUNC", "EXPT", "MIN", "MAX", "LIMIT", "SEL", "MUX", "DINT_TO_LREAL", "LREAL_TO_DINT", "BOOL_TO_DINT"};

bool is_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

}  // namespace

std::optional<KnownType> known_type(std::string_view name) {
  constexpr std::string_view array = "ARRAY";
  constexpr std::string_view of = "] OF ";
  constexpr int most_places = 1'000'000;  // bounds lie within ± this
  if (equal_ignoring_case(name.substr(0, array.size()), array) && name.find('[') != std::string_view::npos) {
    const auto begin = name.find('[') + 1;
    const auto dots = name.find("..", begin);
    const auto end = in_capitals(name).find(of);
    if (dots == std::string_view::npos || end == std::string::npos || dots > end) {
      return std::nullopt;
    }
    const auto low = whole_number(trimmed(name.substr(begin, dots - begin)), -most_places, most_places);
    const auto high = whole_number(trimmed(name.substr(dots + 2, end - dots - 2)), -most_places, most_places);
    auto element = known_type(trimmed(name.substr(end + of.size())));
    if (!low || !high || *high < *low || *high - *low >= static_cast<int>(longest_vector) || !element ||
        element->carried.is_vector()) {
      return std::nullopt;
    }
    element->carried = {element->carried.type, *low, *high};
    return element;
  }
  const auto* const found =
      std::ranges::find_if(types, [&](const TypeRow& one) { return equal_ignoring_case(one.name, name); });
  return found == types.end() ? std::nullopt : std::optional(found->known);
}

std::string declared_text(const Carried& carried) {
  return carried.is_vector() ? fmt::format("ARRAY[{}..{}] OF {}", carried.low, carried.high, type_name(carried.type))
                             : std::string(type_name(carried.type));
}

std::string real_text(Type type, const std::string& literal) {
  const bool is_whole = type == Type::Real && !literal.empty() && literal.find_first_of(".#") == std::string::npos;
  return is_whole ? literal + ".0" : literal;
}

std::vector<std::string> elements_of_list(std::string_view text) {
  std::vector<std::string> list;
  if (!text.starts_with('[') || !text.ends_with(']')) {
    return list;
  }
  text = text.substr(1, text.size() - 2);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    list.emplace_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return list;
}

const BlockType* known_block(std::string_view name) {
  const BlockType* const own = find_block_type(name);
  return own != nullptr ? own : find_block_type(fmt::format("HY_{}", name));
}

std::string known_function(std::string_view name) {
  for (const Renamed& one : conversions) {
    if (equal_ignoring_case(one.name, name)) {
      return std::string(one.here);
    }
  }
  return is_one_of(name, functions) ? in_capitals(name) : "";
}

std::optional<double> seconds_of(std::string_view literal) {
  const auto mark = literal.find('#');
  if (mark == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string kind = in_capitals(literal.substr(0, mark));
  if (kind != "T" && kind != "TIME" && kind != "LT" && kind != "LTIME") {
    return std::nullopt;
  }
  // A division by a whole number is rounded once: 0.1 of T#100ms is that of the text.
  const std::optional<double> nanoseconds = language::nanoseconds_of_time(literal.substr(mark + 1));
  return nanoseconds ? std::optional(*nanoseconds / 1e9) : std::nullopt;
}

std::string with_known_literals(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (!is_letter(text[i])) {
      result += text[i++];
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && is_letter(text[end])) {
      ++end;
    }
    std::string word(text.substr(i, end - i));
    if (end < text.size() && text[end] == '#') {
      std::size_t stop = end + 1;
      while (stop < text.size() &&
             (is_letter(text[stop]) || text[stop] == '.' || (stop == end + 1 && text[stop] == '-'))) {
        ++stop;
      }
      if (const auto seconds = seconds_of(text.substr(i, stop - i))) {
        result += real_literal(*seconds);
        i = stop;
        continue;
      }
      const auto known = known_type(word);
      word = known && known->carried.type == Type::Real  ? "LREAL"
             : known && known->carried.type == Type::Int ? "DINT"
                                                         : word;
    }
    result += word;
    i = end;
  }
  return result;
}

}  // namespace hysteron::import
