// The keys of a run file, declared once: what the reader accepts, and what docs/reference/run-file.md says.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace hysteron::runtime {

/// The lowest number where each above 0 will do.
inline constexpr double above_zero = std::numeric_limits<double>::min();

enum class KeyKind : std::uint8_t { flag, text, path, texts, number, whole, time, choice };

struct RunKey {
  std::string_view name;
  KeyKind kind = KeyKind::text;
  std::string_view otherwise{};  ///< what counts without the key: a value as in the file, or words in parentheses
  std::string_view meaning{};
  double low = -std::numeric_limits<double>::infinity();  ///< of numbers; of times, in nanoseconds
  double high = std::numeric_limits<double>::infinity();
  std::span<const std::string_view> words{};  ///< of a choice
  std::string_view also{};                    ///< what limits the value besides
};

struct RunTable {
  std::string_view name;  ///< as the heading shows it: [outputs.NAME]
  std::string_view meaning;
  std::span<const RunKey> keys;
};

/// In the order of the page.
[[nodiscard]] std::span<const RunTable> run_tables();
/// The tables as keys of the file itself.
[[nodiscard]] std::span<const RunKey> top_keys();
/// By the name without brackets and NAME: task, outputs.
[[nodiscard]] const RunTable& run_table(std::string_view name);

/// A length of time in the largest unit that it fills, whole days but for that: 50us, 1.5ms, 2s, 30d.
[[nodiscard]] std::string time_text(double nanoseconds);

/// The same to three digits, for what was measured: 831us.
[[nodiscard]] std::string short_time_text(double nanoseconds);

/// docs/reference/run-file.md.
[[nodiscard]] std::string run_file_page();

}  // namespace hysteron::runtime
