// How a value lies in registers: value = scale·raw + offset.
//
// The raw number has a type of its own (value_bits.hpp) and lies in the registers in a word order. Raw integers are the
// nearest to (value − offset)/scale, a half to even, so that a value comes back within half a step, which is the
// scale. What the type does not reach is saturated at its bounds, and said so; it never wraps. What is not a number has
// no raw integer at all. Every raw integer comes back as itself; `flaw_of` refuses the scales and offsets for which
// the arithmetic of doubles would not keep that. Both the server's points and the values on devices are described so.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "runtime/modbus/value_bits.hpp"
#include "runtime/modbus/word_order.hpp"

namespace hysteron::runtime::modbus {

struct PointFormat {
  RegisterType type{};
  double scale = 1.0;  ///< in the point's unit: the step of a raw integer
  double offset = 0.0;
  WordOrder order = WordOrder::abcd;
  friend bool operator==(const PointFormat&, const PointFormat&) = default;

  [[nodiscard]] bool is_scaled() const { return scale != 1.0 || offset != 0.0; }
};

/// As a run file has it: what it leaves out is the point's type, and the word order of the server or of the device.
struct GivenFormat {
  std::optional<RegisterType> type{};
  double scale = 1.0;
  double offset = 0.0;
  std::optional<WordOrder> order{};

  [[nodiscard]] PointFormat or_else(RegisterType otherwise, WordOrder usual) const {
    return {.type = type.value_or(otherwise), .scale = scale, .offset = offset, .order = order.value_or(usual)};
  }
};

/// Why a format does not serve, as the end of a sentence that begins with "it"; empty where it does.
[[nodiscard]] std::string flaw_of(const PointFormat& format);
/// The same of a word order that was given to what lies in one register.
[[nodiscard]] std::string order_flaw_of(const GivenFormat& given, RegisterType type);

/// The same of a format that does not hold what is declared between low and high, but for half a step; empty too where
/// no range is declared.
[[nodiscard]] std::string range_flaw_of(const PointFormat& format, double low, double high);

struct RawCode {
  std::uint64_t bits = 0;     ///< the low 16·registers_of(type) of them
  bool is_saturated = false;  ///< the value is beyond what the format reaches, by more than half a step
};

/// Nothing where the value is not a number and the type is no real.
[[nodiscard]] std::optional<RawCode> encoded(double value, const PointFormat& format);

/// Nothing where a decimal digit is above 9, or where a double does not hold the value exactly.
[[nodiscard]] std::optional<double> decoded(std::uint64_t bits, const PointFormat& format);

/// The value of bits as it may be taken: nothing where it is not finite or not within the limits as the format can tell
/// them. A limit of 0.1 is reached by the real32 nearest to it, and by one step of 0.1; the value is then the limit.
[[nodiscard]] std::optional<double> taken(std::uint64_t bits, const PointFormat& format, double low, double high);

/// The lowest and the highest value that the format reaches.
[[nodiscard]] std::pair<double, double> limits_of(const PointFormat& format);

/// Whether the format has this value, but for rounding: on a step, or in reach of a real.
[[nodiscard]] bool holds(const PointFormat& format, double value);

}  // namespace hysteron::runtime::modbus
