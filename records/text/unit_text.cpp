#include "records/text/unit_text.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "records/text/cell_value.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

/// Take a prefix: mV, kHz, um.
constexpr auto with_prefix = std::to_array<std::string_view>(
    {"V",   "A", "W",   "Hz",  "N",    "Nm",  "m",   "g",        "Pa",           "bar",  "J",   "F",  "H",
     "T",   "s", "rad", "K",   "C",    "Ohm", "ohm", "\xCE\xA9", "\xE2\x84\xA6", "Wb",   "S",   "eV", "VA",
     "var", "l", "L",   "Vpp", "Vrms", "Vdc", "Vac", "VDC",      "VAC",          "Arms", "App", "B",  "dB"});
constexpr auto alone = std::to_array<std::string_view>({"%",
                                                        "\xC2\xB0",
                                                        "\xC2\xB0"
                                                        "C",
                                                        "\xC2\xB0"
                                                        "F",
                                                        "deg",
                                                        "degC",
                                                        "degF",
                                                        "rpm",
                                                        "RPM",
                                                        "1/min",
                                                        "U/min",
                                                        "sec",
                                                        "sek",
                                                        "Sec",
                                                        "min",
                                                        "h",
                                                        "d",
                                                        "psi",
                                                        "lb",
                                                        "lbf",
                                                        "inch",
                                                        "ft",
                                                        "counts",
                                                        "count",
                                                        "cnt",
                                                        "cts",
                                                        "inc",
                                                        "LSB",
                                                        "pu",
                                                        "p.u.",
                                                        "1",
                                                        "mmHg",
                                                        "mils"});
constexpr auto prefixes =
    std::to_array<std::string_view>({"p", "n", "u", "\xC2\xB5", "\xCE\xBC", "m", "c", "d", "k", "M", "G", "h"});

bool is_one(std::string_view text, const auto& list) {
  return std::ranges::find(list, text) != list.end();
}

/// m, s2, s^2, s-1
bool is_factor(std::string_view text) {
  const auto end = text.find_last_not_of("0123456789^-()");
  if (end == std::string_view::npos) {
    return text == "1";
  }
  text = text.substr(0, end + 1);
  if (is_one(text, with_prefix) || is_one(text, alone)) {
    return true;
  }
  return std::ranges::any_of(prefixes, [&](std::string_view prefix) {
    return text.starts_with(prefix) && is_one(text.substr(prefix.size()), with_prefix);
  });
}

struct Word {
  std::string_view word, unit;
};
/// Take a prefix, written out or not: millivolt, mVolt.
constexpr auto long_words = std::to_array<Word>({{"volt", "V"},
                                                 {"ampere", "A"},
                                                 {"amp", "A"},
                                                 {"watt", "W"},
                                                 {"metre", "m"},
                                                 {"meter", "m"},
                                                 {"newtonmetre", "Nm"},
                                                 {"newtonmeter", "Nm"},
                                                 {"newton", "N"},
                                                 {"gramm", "g"},
                                                 {"gram", "g"},
                                                 {"pascal", "Pa"},
                                                 {"hertz", "Hz"},
                                                 {"second", "s"},
                                                 {"sekunden", "s"},
                                                 {"sekunde", "s"},
                                                 {"radian", "rad"},
                                                 {"kelvin", "K"},
                                                 {"ohm", "Ohm"}});
constexpr auto long_prefixes = std::to_array<Word>({{"milli", "m"},
                                                    {"micro", "u"},
                                                    {"mikro", "u"},
                                                    {"nano", "n"},
                                                    {"kilo", "k"},
                                                    {"mega", "M"},
                                                    {"centi", "c"},
                                                    {"zenti", "c"}});

/// millivolts, mVolts, microns; nothing where it is none of these. A prefix of one letter keeps its case: M is not m.
std::optional<std::string> unit_of_long_word(std::string_view text) {
  const auto base = [](std::string_view word) -> std::optional<std::string_view> {
    const auto* const found = std::ranges::find_if(long_words, [&](const Word& one) {
      return equal_ignoring_case(one.word, word) || (word.size() > 1 && (word.back() == 's' || word.back() == 'S') &&
                                                     equal_ignoring_case(one.word, word.substr(0, word.size() - 1)));
    });
    return found == long_words.end() ? std::nullopt : std::optional(found->unit);
  };
  if (is_one_of(text, {"micron", "microns"})) {
    return "um";
  }
  if (const auto unit = base(text)) {
    return std::string(*unit);
  }
  for (const Word& prefix : long_prefixes) {
    const auto unit = equal_ignoring_case(text.substr(0, prefix.word.size()), prefix.word)
                          ? base(text.substr(prefix.word.size()))
                          : std::nullopt;
    if (unit) {
      return std::string(prefix.unit) + std::string(*unit);
    }
  }
  for (const std::string_view prefix : prefixes) {
    const auto unit = text.starts_with(prefix) ? base(text.substr(prefix.size())) : std::nullopt;
    if (unit) {
      return std::string(prefix) + std::string(*unit);
    }
  }
  return std::nullopt;
}

}  // namespace

std::string_view without_brackets(std::string_view text) {
  const bool bracketed =
      text.size() >= 2 && ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'));
  return bracketed ? text.substr(1, text.size() - 2) : text;
}

std::string unit_of_word(std::string_view text) {
  text = without_brackets(text);
  constexpr auto words = std::to_array<Word>({{"VDC", "V"},
                                              {"mVDC", "mV"},
                                              {"ADC", "A"},
                                              {"mADC", "mA"},
                                              {"Degree", "deg"},
                                              {"Degrees", "deg"},
                                              {"Grad", "deg"},
                                              {"U/min", "rpm"},
                                              {"Upm", "rpm"},
                                              {"Umdr/min", "rpm"},
                                              {"r/min", "rpm"},
                                              {"rev/min", "rpm"},
                                              {"RPM", "rpm"},
                                              {"percent", "%"},
                                              {"Prozent", "%"}});
  const auto found = std::ranges::find_if(words, [&](const Word& one) { return equal_ignoring_case(one.word, text); });
  return found != words.end() ? std::string(found->unit) : unit_of_long_word(text).value_or(std::string(text));
}

bool is_known_unit(std::string_view text) {
  text = trimmed(text);
  if (text.empty() || text.size() > 16) {
    return false;
  }
  if (is_one(text, alone)) {
    return true;
  }
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find_first_of("/*.", at), text.size());
    std::string_view factor = text.substr(at, end - at);
    constexpr std::string_view middle_dot = "\xC2\xB7";
    const auto dot = factor.find(middle_dot);
    if (!is_factor(factor.substr(0, dot)) ||
        (dot != std::string_view::npos && !is_factor(factor.substr(dot + middle_dot.size())))) {
      return false;
    }
    at = end + 1;
  }
  return true;
}

std::optional<ScaledUnit> scaled_unit(std::string_view text) {
  text = trimmed(text);
  const auto end = std::min(text.find_first_not_of("0123456789.,eE+-"), text.size());
  if (end == 0 || is_known_unit(text)) {
    return std::nullopt;
  }
  // The E of 10 EV belongs to the unit: the longest number that leaves one.
  for (std::size_t length = end; length > 0; --length) {
    const std::string_view digits = text.substr(0, length);
    const CellValue cell = cell_value(digits);
    const bool number = cell.kind == CellKind::Number && digits.back() >= '0' && digits.back() <= '9';
    std::string unit = unit_of_word(trimmed(text.substr(length)));
    if (number && cell.number > 0.0 && unit != "1" && is_known_unit(unit)) {
      return ScaledUnit{.factor = cell.number, .unit = std::move(unit)};
    }
  }
  return std::nullopt;
}

bool is_number_type(std::string_view text) {
  return is_one_of(
      text, {"f4",     "f8",     "i1",     "i2",      "i4",      "i8",   "u1",       "u2",     "u4",      "u8",
             "float",  "double", "single", "real",    "lreal",   "int",  "dint",     "uint",   "udint",   "sint",
             "usint",  "word",   "dword",  "byte",    "bool",    "int8", "int16",    "int32",  "int64",   "uint8",
             "uint16", "uint32", "uint64", "float32", "float64", "dbl",  "datetime", "string", "boolean", "integer"});
}

bool is_key_of_units(std::string_view text) {
  return is_one_of(
      text,
      {"unit",          "units",     "unit:",        "units:",        "einheit",    "einheiten", "einheit:",
       "y-unit",        "yunits",    "y unit",       "vertical unit", "eng. units", "eng units", "engineering units",
       "physical unit", "dimension", "unit\xC3\xA9", "unit\xC3\xA9s", "unidad",     "unidades"});
}

std::string_view without_unit_key(std::string_view text) {
  const auto colon = text.find(':');
  return colon != std::string_view::npos && is_key_of_units(text.substr(0, colon)) ? trimmed(text.substr(colon + 1))
                                                                                   : text;
}

}  // namespace hysteron::records
