// What a record calls its time, and a signal that has the same name: the T of a filter, or a temperature.
#pragma once

#include <string_view>

#include "support/names.hpp"

namespace hysteron {

/// Whether a signal is called `t`, as the time is in a record: names are compared without regard to case.
[[nodiscard]] inline bool is_called_t(std::string_view signal) {
  return equal_ignoring_case(signal, "t");
}

/// What the time is called in a record that is written: `t`, or `time` where a signal is called T.
[[nodiscard]] constexpr std::string_view time_heading(bool has_signal_t) {
  return has_signal_t ? "time" : "t";
}

/// What a signal is called there. A T is written so, however the diagram writes it: a `t` would be read as the time.
[[nodiscard]] inline std::string_view signal_heading(std::string_view signal) {
  return is_called_t(signal) ? "T" : signal;
}

}  // namespace hysteron
