#include "support/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "support/utf8.hpp"
#include "support/wrapped.hpp"

namespace hysteron {
namespace {

constexpr double drawing_interval = 0.1;  // s
constexpr std::size_t bar_length = 20;

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(std::clamp(seconds, 0.0, 1e9)));
  if (whole < 100) {
    return fmt::format("{} s", whole);
  }
  return whole < 6000 ? fmt::format("{} min", (whole + 59) / 60) : fmt::format("{} h", (whole + 3599) / 3600);
}

std::size_t width_of(std::FILE* stream) {
  const std::size_t width = terminal_width(stream);
  return width > 0 ? width : 80;
}

bool silenced = false;

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::string progress_line(std::string_view title, double fraction, std::optional<double> seconds_left,
                          std::string_view text, std::size_t width) {
  const double share = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const auto full = static_cast<std::size_t>(share * static_cast<double>(bar_length));
  std::string bar(full, '#');
  for (std::size_t i = full; i < bar_length; ++i) {
    bar += "·";
  }
  std::string line = fmt::format("{}  [{}] {:3.0f} %", printable(title), bar, std::floor(share * 100.0));
  if (seconds_left) {
    line += fmt::format("  {} left", duration_text(*seconds_left));
  }
  if (!text.empty()) {
    line += "  " + printable(text);
  }
  // Cut at a character, not at a byte. A line that wraps could not be redrawn in place.
  std::string_view rest = line;
  for (std::size_t shown = 0; shown < width && !rest.empty(); ++shown) {
    rest.remove_prefix(utf8_length(rest));
  }
  line.resize(line.size() - rest.size());
  return line;
}

Progress::Progress(std::string title, std::FILE* stream, std::function<double()> clock)
    : title_(std::move(title)),
      stream_(!silenced && stream != nullptr && isatty(fileno(stream)) == 1 ? stream : nullptr),
      clock_(clock ? std::move(clock) : steady_seconds),
      begun_(clock_()),
      next_drawing_(begun_ + drawing_interval) {}

void Progress::silence() {
  silenced = true;
}

void Progress::update(double fraction, std::string_view text) {
  if (stream_ == nullptr) {
    return;
  }
  const double now = clock_();
  if (now < next_drawing_) {
    return;
  }
  next_drawing_ = now + drawing_interval;
  std::optional<double> left;
  if (const double elapsed = now - begun_; fraction > 0.01 && elapsed > 1.0) {
    left = elapsed * (1.0 - fraction) / fraction;
  }
  const auto line = progress_line(title_, fraction, left, text, width_of(stream_) - 1);
  std::fputs(("\r\033[K" + line).c_str(), stream_);
  std::fflush(stream_);
  drawn_ = true;
}

void Progress::finish() {
  if (drawn_) {
    std::fputs("\r\033[K", stream_);
    std::fflush(stream_);
    drawn_ = false;
  }
}

}  // namespace hysteron
