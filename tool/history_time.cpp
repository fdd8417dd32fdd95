#include "tool/history_time.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <string_view>

#include "runtime/config/run_config.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/whole_number.hpp"

namespace hysteron::tool {
namespace {

/// Whole numbers with one sign between each and the next; nothing where the text has another shape. The last sign of
/// `signs` may be followed by nothing.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  std::optional<int> digits(std::size_t count) {
    const auto value = rest_.size() < count ? std::nullopt : whole_number(rest_.substr(0, count), 0);
    if (value) {
      rest_.remove_prefix(count);
    }
    return value;
  }
  bool sign(std::string_view any) {
    if (rest_.empty() || any.find(rest_.front()) == std::string_view::npos) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }
  /// Decimals, as thousandths.
  std::optional<int> thousandths() {
    int value = 0;
    int scale = 100;
    bool any = false;
    while (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
      value += (rest_.front() - '0') * scale;
      scale /= 10;
      rest_.remove_prefix(1);
      any = true;
    }
    return any ? std::optional(value) : std::nullopt;
  }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

std::optional<std::int64_t> moment(std::string_view text) {
  using namespace std::chrono;
  Reader reader(text);
  const auto year = reader.digits(4);
  const bool first = year && reader.sign("-");
  const auto month = first ? reader.digits(2) : std::nullopt;
  const bool second = month && reader.sign("-");
  const auto day = second ? reader.digits(2) : std::nullopt;
  if (!day) {
    return std::nullopt;
  }
  const year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                            std::chrono::day(static_cast<unsigned>(*day))};
  std::int64_t ms = 0;
  if (!reader.at_end() && !reader.sign("Z")) {
    const bool parted = reader.sign("T ");
    const auto hour = parted ? reader.digits(2) : std::nullopt;
    const auto minute = hour && reader.sign(":") ? reader.digits(2) : std::nullopt;
    if (!minute || *hour > 24 || *minute > 59) {
      return std::nullopt;
    }
    ms = (*hour * 60 + *minute) * 60'000LL;
    if (reader.sign(":")) {
      const auto whole = reader.digits(2);
      const auto part = whole && reader.sign(".") ? reader.thousandths() : std::optional(0);
      if (!whole || *whole > 60 || !part) {
        return std::nullopt;
      }
      ms += *whole * 1000 + *part;
    }
    (void)reader.sign("Z");
  }
  if (!reader.at_end() || !date.ok()) {
    return std::nullopt;
  }
  return duration_cast<milliseconds>(sys_days(date).time_since_epoch()).count() + ms;
}

}  // namespace

std::optional<std::int64_t> history_time(const std::string& text, const std::string& option, std::int64_t newest_ms) {
  if (text.empty()) {
    return std::nullopt;
  }
  if (const auto length = runtime::parse_duration(text)) {
    return newest_ms - *length / 1'000'000;
  }
  if (const auto found = moment(text)) {
    return found;
  }
  throw InputError(error::bad_usage, {}, fmt::format("{} is \"{}\", which is no time.", option, text),
                   "write a time in UTC as 2026-11-28T07:05, or a length of time as 2h, back from the newest row.");
}

}  // namespace hysteron::tool
