#include "support/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "support/render.hpp"
#include "support/trimmed.hpp"
#include "support/utf8.hpp"

namespace hysteron {
namespace {

/// Dots in one key. The library frees nested tables by recursion, so a key of 10^5 dots would overrun the stack.
constexpr int most_dots = 32;

void refuse_deep_keys(const std::string& file, std::string_view text, int number) {
  Place place{.file = file, .line = 1, .column = 1};
  int dots = 0;
  for (const char c : text) {
    if (c == '.') {
      ++dots;
    } else if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) {
      dots = 0;
    }
    if (dots > most_dots) {
      throw InputError(number, place, fmt::format("There are more than {} dots in a row.", most_dots),
                       "nest less deeply, or shorten the comment.");
    }
    place.line += c == '\n' ? 1 : 0;
    place.column = c == '\n' ? 1 : place.column + ((static_cast<unsigned char>(c) & 0xC0U) != 0x80 ? 1 : 0);
  }
}

struct KnownMistake {
  std::string_view said;  ///< part of what the library says
  std::string_view mend;
  std::string_view shown{};  ///< an example, where the line itself can be mended
};

/// What those who come from Structured Text or a spreadsheet write.
constexpr std::array known_mistakes{
    KnownMistake{"expected a comment or whitespace, saw ','", "write a decimal point", "0.5"},
    KnownMistake{"expected 'true', saw 'T'", "write true in small letters."},
    KnownMistake{"expected 'false', saw 'F'", "write false in small letters."},
    KnownMistake{"parsing floating-point: expected decimal digit", "write digits on both sides of the point",
                 "0.5, 5.0"},
    KnownMistake{"could not be interpreted as a value", "write a number that LREAL can hold, up to about 1.8e308."},
    KnownMistake{"not representable in 64 bits",
                 "write a whole number of at most 18 digits, or a real number with a point."},
    KnownMistake{"utf-8", "save the file as UTF-8."},
    KnownMistake{"end-of-file", "complete the last line; the file may have been cut off."},
    KnownMistake{"saw ':'", "write an equals sign between name and value", "C1 = 0.05"},
};

/// K = 0,05 → K = 0.05; .5 → 0.5; 5. → 5.0; C1 := 2 and C1: 2 → C1 = 2: the line as it should be, where it holds one
/// of these. Empty where it does not.
std::string mended_line(std::string_view line) {
  line = trimmed(line.substr(0, line.find('#')));
  const auto is_digit = [&](std::size_t at) { return at < line.size() && line[at] >= '0' && line[at] <= '9'; };
  const auto sign = line.find_first_of(":=");
  if (sign == std::string_view::npos || sign == 0 || line.front() == '[') {
    return {};
  }
  const auto value = line.find_first_not_of(":= \t", sign);
  if (value == std::string_view::npos) {
    return {};
  }
  std::string result = std::string(trimmed(line.substr(0, sign))) + " = ";
  const bool list = line[value] == '[' || line[value] == '{' || line[value] == '"';
  for (std::size_t at = value; at < line.size(); ++at) {
    const bool comma = !list && line[at] == ',' && is_digit(at - 1) && is_digit(at + 1);
    const bool point = line[at] == '.' && line[value] != '"';
    result += point && !is_digit(at - 1) && is_digit(at + 1) ? "0" : "";
    result += comma ? '.' : line[at];
    result += point && is_digit(at - 1) && !is_digit(at + 1) ? "0" : "";
  }
  return result;
}

InputError translated(const std::string& file, std::string_view text, const TomlKind& kind,
                      const toml::parse_error& said) {
  Place place = place_of(file, said.source());
  const std::string description = printable(said.description());
  if (description.find("cannot redefine") != std::string::npos) {
    // The library points behind the key. The line as a whole is meant.
    Sources sources;
    sources.put(file, text);
    if (const auto line = sources.line(file, place.line)) {
      const auto begin = std::min(line->find_first_not_of(" \t"), line->size());
      place.column = static_cast<std::uint32_t>(begin) + 1;
      place.length = static_cast<std::uint32_t>(std::max<std::size_t>(1, character_count(line->substr(begin))));
    }
    return {kind.key_twice, place, "This key or table has been given before.",
            "keep one of the two; a table may be opened only once."};
  }
  const auto colon = description.find(": ");
  const bool prefixed = description.starts_with("Error while parsing ") && colon != std::string::npos;
  const auto reason = prefixed
                          ? fmt::format("{} ({})", description.substr(colon + 2), description.substr(20, colon - 20))
                          : description;
  const auto* const known =
      std::find_if(known_mistakes.begin(), known_mistakes.end(),
                   [&](const KnownMistake& mistake) { return description.find(mistake.said) != std::string::npos; });
  std::string mend = known != known_mistakes.end() ? std::string(known->mend)
                                                   : fmt::format("write {}; toml.io has the rules.", kind.looks);
  if (known != known_mistakes.end() && !known->shown.empty()) {
    Sources sources;
    sources.put(file, text);
    const std::string line = mended_line(sources.line(file, place.line).value_or(std::string_view()));
    mend = fmt::format("{}: {}.", known->mend, line.empty() ? std::string(known->shown) : line);
  }
  return {kind.no_toml, place, fmt::format("This is no TOML: {}.", reason), std::move(mend)};
}

}  // namespace

Place place_of(const std::string& file, const toml::source_region& region) {
  const bool one_line = region.end.line == region.begin.line && region.end.column > region.begin.column;
  return {.file = file,
          .line = region.begin.line,
          .column = region.begin.column,
          .length = one_line ? region.end.column - region.begin.column : 1};
}

toml::table parse_toml(const std::string& file, std::string_view text, const TomlKind& kind) {
  refuse_deep_keys(file, text, kind.no_toml);
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& said) {
    throw translated(file, text, kind, said);
  }
}

std::string_view toml_kind(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return node.as_array()->empty() ? "an empty list" : "a list";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

}  // namespace hysteron
