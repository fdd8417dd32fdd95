#include "records/time/time_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

struct Spelling {
  std::string_view text{};
  TimeUnit unit{};
};

constexpr TimeUnit second{"s", 1, 1};
constexpr TimeUnit milli{"ms", 1, 1000};
constexpr TimeUnit micro{"us", 1, 1'000'000};
constexpr TimeUnit nano{"ns", 1, 1'000'000'000};
constexpr TimeUnit filetime{"100 ns", 1, 10'000'000};
constexpr TimeUnit day_millionth{"1e-6 d", 864, 10000};  // of WinCC
constexpr TimeUnit minute{"min", 60, 1};
constexpr TimeUnit hour{"h", 3600, 1};
constexpr TimeUnit day{"d", 86400, 1};

constexpr auto spellings = std::to_array<Spelling>({
    {"s", second},
    {"sec", second},
    {"secs", second},
    {"second", second},
    {"seconds", second},
    {"sek", second},
    {"sekunde", second},
    {"sekunden", second},
    {"\xE7\xA7\x92", second},              // of Japanese and Chinese
    {"\xD1\x81\xD0\xB5\xD0\xBA", second},  // of Russian
    {"ms", milli},
    {"msec", milli},
    {"msecs", milli},
    {"millis", milli},
    {"millitm", milli},  // of FactoryTalk
    {"millisecond", milli},
    {"milliseconds", milli},
    {"millisekunden", milli},
    {"us", micro},
    {"\xC2\xB5s", micro},  // µ, the micro sign
    {"\xCE\xBCs", micro},  // μ, the Greek letter
    {"usec", micro},
    {"\xC2\xB5sec", micro},
    {"\xCE\xBCsec", micro},
    {"usecs", micro},
    {"micros", micro},
    {"microsecond", micro},
    {"microseconds", micro},
    {"ns", nano},
    {"nsec", nano},
    {"nsecs", nano},
    {"nanos", nano},
    {"nanosec", nano},
    {"nanosecs", nano},
    {"nanosecond", nano},
    {"nanoseconds", nano},
    {"100ns", filetime},
    {"100 ns", filetime},
    {"ticks", filetime},
    {"filetime", filetime},
    {"1e-6 d", day_millionth},
    {"min", minute},
    {"mins", minute},
    {"minute", minute},
    {"minutes", minute},
    {"h", hour},
    {"hr", hour},
    {"hour", hour},
    {"hours", hour},
    {"d", day},
    {"day", day},
    {"days", day},
});

constexpr auto names = std::to_array<std::string_view>({
    "t",
    "time",
    "tout",
    "zeit",
    "uptime",
    "laufzeit",
    "timestamp",
    "time stamp",
    "time_stamp",
    "zeitstempel",
    "datetime",
    "date time",
    "date_time",
    "date",
    "datum",
    "clock",
    "x_value",
    "x-axis",
    "x axis",
    "elapsed",
    "elapsed time",
    "elapsed_time",
    "relative time",
    "relative_time",
    "rel_time",
    "rel. time",
    "time_rel",
    "temps",
    "tiempo",
    "tempo",
    "tijd",
    "czas",
    "tid",
    "aika",
    "timp",
    "zaman",
    "cas",
    "\xC4\x8D"
    "as",                                        // čas
    "id\xC5\x91",                                // idő
    "\xD0\x92\xD1\x80\xD0\xB5\xD0\xBC\xD1\x8F",  // Время
    "\xD0\xB2\xD1\x80\xD0\xB5\xD0\xBC\xD1\x8F",  // время
    "\xE6\x99\x82\xE9\x96\x93",                  // of Japanese
    "\xE6\x97\xB6\xE9\x97\xB4",                  // of Chinese
    "\xEC\x8B\x9C\xEA\xB0\x84",                  // of Korean
    "epoch",
    "_time",
    "__time",
    "sim_time",
    "simtime",
    "simulation time",
    "logtime",
    "log_time",
    "header.stamp",
    "stamp",
    "second",
    "seconds",
    "uhrzeit",
    "time of day",
    "local time",
    "unix time",
    "unix_time",
    "sample time",
    "recv_time",
    "time axis",
    "filetime",
    "timecode",
    "ts",
    "t_stamp",
    "created_at",
    "last_changed",
});

}  // namespace

std::optional<TimeUnit> time_unit(std::string_view text) {
  text = trimmed(text);
  // Of one letter the case counts: S is siemens, H henry, D no unit.
  const auto found = std::ranges::find_if(spellings, [&](const Spelling& one) {
    return one.text.size() == 1 ? one.text == text : equal_ignoring_case(one.text, text);
  });
  return found == spellings.end() ? std::nullopt : std::optional(found->unit);
}

bool is_zone_of_time(std::string_view text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, std::min(text.find_first_of("+- "), text.size()));
  return is_one_of(word, {"utc", "gmt", "local", "cet", "cest", "mez", "mesz", "est", "edt", "pst", "pdt", "jst"});
}

std::optional<TimeUnit> epoch_unit(std::int64_t number) {
  constexpr std::int64_t first = 1'000'000'000;  // September 2001, in seconds
  constexpr std::int64_t last = 9'999'999'999;
  // Of FILETIME those are the years 1985 to 2300; it lies between microseconds and nanoseconds.
  constexpr std::int64_t first_filetime = 121'000'000'000'000'000;
  constexpr std::int64_t last_filetime = 222'000'000'000'000'000;
  for (const TimeUnit& unit : {second, milli, micro, nano}) {
    if (number / unit.under >= first && number / unit.under <= last) {
      return unit;
    }
  }
  return number >= first_filetime && number <= last_filetime ? std::optional(filetime) : std::nullopt;
}

std::optional<MistakenUnit> mistaken_unit(double ratio) {
  struct Ratio {
    MistakenUnit unit{};
    double factor = 1.0;
  };
  constexpr std::array ratios{Ratio{{"milliseconds", "ms"}, 1e3}, Ratio{{"microseconds", "us"}, 1e6},
                              Ratio{{"nanoseconds", "ns"}, 1e9}, Ratio{{"minutes", "min"}, 1.0 / 60.0},
                              Ratio{{"days", "d"}, 1.0 / 86400.0}};
  const auto* const found =
      std::ranges::find_if(ratios, [&](const Ratio& one) { return std::abs(ratio / one.factor - 1.0) < 0.05; });
  return found == ratios.end() ? std::nullopt : std::optional(found->unit);
}

std::optional<TimeName> time_name(std::string_view name) {
  name = trimmed(name, " \t_");
  // Of Arduino's and others' functions, whose names say the unit.
  constexpr auto functions = std::to_array<std::string_view>(
      {"sec", "secs", "second", "seconds", "millis", "micros", "nanos", "millisecond", "milliseconds", "microsecond",
       "microseconds", "nanosecond", "nanoseconds", "msec", "usec", "nsec", "filetime"});
  if (is_one_of(name, functions)) {
    return TimeName{.unit = time_unit(name)};
  }
  if (is_one_of(name, {"tms", "tus", "tns"})) {
    return TimeName{.unit = time_unit(name.substr(1))};
  }
  if (is_one_of(name, names)) {
    return TimeName{};
  }
  // A unit behind the name: Time (s), t_ms, Zeit/ms, time in us, Time, s, timeMs.
  const auto with = [&](std::string_view base, std::string_view unit) -> std::optional<TimeName> {
    base = trimmed(base);
    const auto found = trimmed(unit) == "S" ? std::optional(second) : time_unit(unit);  // TIME_S; alone it is siemens
    // /cmd/header/stamp/sec: the path before the last two words says of what.
    const auto path = base.find_last_of("./");
    const std::string_view word = path == std::string_view::npos ? base : base.substr(path + 1);
    return found && (is_one_of(base, names) || is_one_of(word, names)) ? std::optional(TimeName{.unit = found})
                                                                       : std::nullopt;
  };
  if (name.ends_with(')') || name.ends_with(']')) {
    const auto open = name.find_last_of("([");
    if (open != std::string_view::npos && open > 0) {
      return with(name.substr(0, open), name.substr(open + 1, name.size() - open - 2));
    }
  }
  if (name.starts_with("in ") && time_unit(name.substr(3))) {  // of Rohde & Schwarz
    return TimeName{.unit = time_unit(name.substr(3))};
  }
  for (const std::string_view joint : {"_in_", " in ", "_", "/", ",", " ", "."}) {
    if (const auto at = name.rfind(joint); at != std::string_view::npos && at > 0) {
      if (const auto found = with(name.substr(0, at), name.substr(at + joint.size()))) {
        return found;
      }
    }
  }
  return std::nullopt;
}

std::optional<TimeUnit> unit_in_name(std::string_view name) {
  const auto unit = time_unit(last_word(name));
  return unit && unit->over == 1 ? unit : std::nullopt;
}

std::string_view last_word(std::string_view name) {
  name = trimmed(name);
  const auto joint = name.find_last_of("._/ ");
  return joint == std::string_view::npos ? name : name.substr(joint + 1);
}

std::string_view without_number(std::string_view name) {
  name = trimmed(name);
  const auto end = name.find_last_not_of("0123456789");
  return end == std::string_view::npos || end + 1 == name.size() ? name : trimmed(name.substr(0, end + 1), " _");
}

bool is_time_of(std::string_view name, std::string_view signal) {
  if (signal.empty() || name.size() < signal.size() + 2) {
    return false;
  }
  const auto is_joint = [](char c) { return c == '_' || c == ' ' || c == '.'; };
  const std::size_t rest = name.size() - signal.size() - 1;
  return (equal_ignoring_case(name.substr(rest + 1), signal) && is_joint(name[rest]) &&
          time_name(name.substr(0, rest))) ||
         (equal_ignoring_case(name.substr(0, signal.size()), signal) && is_joint(name[signal.size()]) &&
          time_name(name.substr(signal.size() + 1)));
}

}  // namespace hysteron::records
