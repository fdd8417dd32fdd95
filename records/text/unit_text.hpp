// Units as the heads of records write them: which texts are units, and how tools spell them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hysteron::records {

/// V of [V] and (V); the text itself where no brackets stand round it.
[[nodiscard]] std::string_view without_brackets(std::string_view text);

/// V of Volt, Volts and VDC, as oscilloscopes write them; the text without brackets where it is no such word.
[[nodiscard]] std::string unit_of_word(std::string_view text);

/// Whether a text is a unit that measuring uses, with prefixes, powers and quotients: mV, um, N*m, rad/s, °C, %.
/// The diagram's units are another matter: this only tells names from units.
[[nodiscard]] bool is_known_unit(std::string_view text);

/// 0.1 and A of 0.1 A.
struct ScaledUnit {
  double factor = 1.0;
  std::string unit{};
};

/// A known unit with a number before it; nothing of 1/min, which is a unit.
[[nodiscard]] std::optional<ScaledUnit> scaled_unit(std::string_view text);

/// Whether a cell says that its row states units: unit, units, Einheit.
[[nodiscard]] bool is_key_of_units(std::string_view text);

/// V of "Unit: V".
[[nodiscard]] std::string_view without_unit_key(std::string_view text);

/// How a number was stored: f8, REAL, int16.
[[nodiscard]] bool is_number_type(std::string_view text);

}  // namespace hysteron::records
