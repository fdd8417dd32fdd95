// Raw numbers of random formats, there and back.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "runtime/modbus/point_format.hpp"
#include "tests/runtime/namespaces.hpp"

namespace hysteron::test {

struct RoundTrips {
  std::uint64_t formats = 0;
  std::uint64_t numbers = 0;
  std::uint64_t wrong = 0;    ///< raw numbers that came back as others
  std::uint64_t too_far = 0;  ///< values that came back further away than half a step
  std::uint64_t silent = 0;   ///< values beyond the format that were not said to be so, or wrapped
};

/// A thousand numbers of each format whose scale and offset are sound.
inline RoundTrips send_numbers_round(std::uint64_t count) {
  namespace modbus = runtime::modbus;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  RoundTrips result;
  while (result.numbers < count) {
    modbus::PointFormat format{.type = modbus::register_types[1 + random() % (modbus::register_types.size() - 1)]};
    if (modbus::is_real(format.type)) {
      continue;
    }
    format.scale = (random() % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, 12.0 * part(random) - 6.0);
    format.offset = random() % 3 == 0 ? 0.0 : format.scale * 1e6 * (part(random) - 0.5);
    if (!modbus::flaw_of(format).empty()) {
      continue;
    }
    ++result.formats;
    const auto [low, high] = modbus::limits_of(format);
    for (int i = 0; i < 1000; ++i, ++result.numbers) {
      const double value = low + (high - low) * part(random);
      const auto code = modbus::encoded(value, format);
      const auto back = code ? modbus::decoded(code->bits, format) : std::nullopt;
      // Of a double near the value: what arithmetic adds to half a step.
      const double room = 0.5 * std::abs(format.scale) + 4.0 * (std::abs(value) + std::abs(format.offset)) * 0x1p-52;
      result.too_far += !back || std::abs(*back - value) > room ? 1 : 0;
      const auto again = back ? modbus::encoded(*back, format) : std::nullopt;
      result.wrong += !again || again->bits != code->bits ? 1 : 0;
      const double beyond = high + std::abs(format.scale) * (2.0 + 1e6 * part(random));
      const auto saturated = modbus::encoded(beyond, format);
      const auto nearest = saturated ? modbus::decoded(saturated->bits, format) : std::nullopt;
      result.silent += nearest && *nearest == high && saturated->is_saturated ? 0 : 1;
    }
  }
  return result;
}

}  // namespace hysteron::test
