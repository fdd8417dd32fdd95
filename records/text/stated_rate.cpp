#include "records/text/stated_rate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "records/time/time_unit.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

struct Key {
  std::string_view text{};
  bool is_rate = false;
  bool is_of_rows = false;
};
/// The longest first, since the first that fits is taken.
constexpr auto keys = std::to_array<Key>(
    {{"sampling frequency", true}, {"sample frequency", true}, {"abtastfrequenz", true},   {"sampling rate", true},
     {"sample rate", true},        {"sample_rate", true},      {"samplerate", true},       {"abtastrate", true},
     {"sampling interval", false}, {"sample interval", false}, {"sampling period", false}, {"sample period", false},
     {"sampling time", false},     {"sample time", false},     {"sampletime", false},      {"abtastzeit", false},
     {"sample_time", false},       {"cycle time", false},      {"cycletime", false},       {"zykluszeit", false},
     {"hresolution", false, true},  // of Yokogawa
     {"delta_x", false, true},      // of LabVIEW
     {"interval=", false, true},    // of LabChart
     {"xinc:", false, true},        // of Keysight
     {"tinc", false, true}});       // of Rigol

constexpr std::string_view between = " \t\"'=:;,|";

/// 1 kHz, 1000, 1.0e-3 s, 0,001; the unit may stand in the next cell. In seconds a row; 0 where it is none.
double period_of(std::string_view text, bool is_rate) {
  text.remove_prefix(std::min(text.find_first_not_of(between), text.size()));
  std::string number(text.substr(0, text.find_first_not_of("+-0123456789.,eE")));
  // A comma ends the cell, unless digits alone stand round it: 0,001.
  if (const auto comma = number.find(','); comma != std::string::npos) {
    const bool decimal =
        number.find('.') == std::string::npos && comma + 1 < number.size() && number.front() == '0' && comma == 1;
    decimal ? void(number[comma] = '.') : number.resize(comma);
  }
  std::size_t read = number.size();
  ParsedNumber value = parse_number(number);
  while (read > 0 && value.status != NumberStatus::Finite) {  // "1e" of "1 even"
    value = parse_number(std::string_view(number).substr(0, --read));
  }
  if (read == 0 || !(value.value > 0.0)) {
    return 0.0;
  }
  text.remove_prefix(read);
  text.remove_prefix(std::min(text.find_first_not_of(between), text.size()));
  const std::string_view unit = text.substr(0, text.find_first_of(" \t\",;|)]"));
  constexpr auto rates = std::to_array<std::pair<std::string_view, double>>({{"MHz", 1e6},
                                                                             {"kHz", 1e3},
                                                                             {"Hz", 1.0},
                                                                             {"MSa/s", 1e6},
                                                                             {"kSa/s", 1e3},
                                                                             {"Sa/s", 1.0},
                                                                             {"MS/s", 1e6},
                                                                             {"kS/s", 1e3},
                                                                             {"S/s", 1.0}});
  const auto* const rate =
      std::ranges::find_if(rates, [&](const auto& one) { return equal_ignoring_case(one.first, unit); });
  if (rate != rates.end()) {
    return 1.0 / (value.value * rate->second);
  }
  if (const auto time = time_unit(unit)) {
    return time->seconds(value.value);
  }
  return is_rate ? 1.0 / value.value : value.value;
}

/// The unit behind the name, `Sample Period [ms]`, as a factor to seconds; 1 where there is none.
double factor_in_brackets(std::string_view& rest) {
  rest = trimmed(rest);
  if (rest.empty() || (rest.front() != '[' && rest.front() != '(')) {
    return 1.0;
  }
  const auto closing = rest.find_first_of("])");
  const auto unit = closing == std::string_view::npos ? std::nullopt : time_unit(rest.substr(1, closing - 1));
  rest.remove_prefix(std::min(closing == std::string_view::npos ? 1 : closing + 1, rest.size()));
  return unit ? unit->seconds(1.0) : 1.0;
}

/// t0 of `t0 =-5.0e-04, tInc = 1e-06`.
double begin_of(std::string_view line) {
  const auto at = line.find("t0");
  if (at == std::string_view::npos) {
    return 0.0;
  }
  std::string_view rest = line.substr(at + 2);
  rest.remove_prefix(std::min(rest.find_first_not_of(" ="), rest.size()));
  const ParsedNumber number = parse_number(rest.substr(0, rest.find_first_not_of("+-0123456789.eE")));
  return number.status == NumberStatus::Finite ? number.value : 0.0;
}

/// Whether the cells of a line state several numbers: signals at rates of their own.
bool has_several_numbers(std::string_view cells) {
  std::optional<double> first;
  while (!cells.empty()) {
    const auto end = std::min(cells.find_first_of(",;\t"), cells.size());
    const ParsedNumber number = parse_number(trimmed(cells.substr(0, end), " \"'"));
    if (number.status == NumberStatus::Finite) {
      if (first && *first != number.value) {
        return true;
      }
      first = number.value;
    }
    cells.remove_prefix(std::min(end + 1, cells.size()));
  }
  return false;
}

}  // namespace

std::optional<StatedRate> stated_rate(const std::vector<Line>& head, std::size_t first_row) {
  std::optional<StatedRate> result;
  for (std::size_t i = 0; i < first_row; ++i) {
    const std::string_view line = trimmed(head[i].text, " \t#%;/\"'");
    for (const Key& key : keys) {
      std::size_t at = 0;
      if (key.text == "tinc") {
        at = line.find("tInc");
      } else if (!equal_ignoring_case(line.substr(0, key.text.size()), key.text)) {
        continue;
      }
      if (at == std::string_view::npos) {
        continue;
      }
      std::string_view rest = line.substr(at + key.text.size());
      const double factor = factor_in_brackets(rest);
      const double period = factor * period_of(rest, key.is_rate);
      if (period > 0.0 && std::isfinite(period) && (!result || (key.is_of_rows && !result->is_of_rows))) {
        result = StatedRate{.period = period,
                            .begin = key.text == "tinc" ? begin_of(line) : 0.0,
                            .words = std::string(line.substr(0, 60)),
                            .differs = key.is_of_rows && key.text != "tinc" && has_several_numbers(rest),
                            .is_of_rows = key.is_of_rows};
      }
      break;
    }
  }
  return result;
}

}  // namespace hysteron::records
