// Values as they lie in registers: every raw number comes back as itself, a value within half a step, and what does not
// fit is saturated and said, never wrapped and never made up.
#include "runtime/modbus/point_format.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace hysteron::runtime::modbus {
namespace {

constexpr std::array<RegisterType, 8> integers{PointType::int16,          PointType::uint16,        PointType::int32,
                                               PointType::uint32,         PointType::int64,         PointType::uint64,
                                               {PointType::uint16, true}, {PointType::uint32, true}};

std::vector<PointFormat> formats_of(RegisterType type) {
  std::vector<PointFormat> formats{{.type = type}};
  for (const double scale : {1.0, 0.1, -0.01, 1.0 / 3.0, 1e-9, 12345.678, 1e300, 1e-300}) {
    for (const double offset : {0.0, -273.15, 1e-3, 1e6}) {
      const PointFormat format{.type = type, .scale = scale, .offset = offset};
      if (flaw_of(format).empty()) {
        formats.push_back(format);
      }
    }
  }
  return formats;
}

/// Whether bits are a raw number of the format: a decimal digit above 9, and what no double tells apart, is none.
bool comes_back(std::uint64_t bits, const PointFormat& format) {
  const auto value = decoded(bits, format);
  const auto again = value ? encoded(*value, format) : std::nullopt;
  return !value || (again && again->bits == bits && !again->is_saturated);
}

TEST(PointFormat, EveryRawNumberOf16BitsComesBack) {
  for (const RegisterType type :
       {RegisterType(PointType::int16), RegisterType(PointType::uint16), RegisterType(PointType::uint16, true)}) {
    for (const PointFormat& format : formats_of(type)) {
      std::size_t sound = 0;
      for (std::uint64_t bits = 0; bits <= 0xFFFF; ++bits) {
        sound += decoded(bits, format) ? 1 : 0;
        ASSERT_TRUE(comes_back(bits, format))
            << name_of(type) << ' ' << format.scale << ' ' << format.offset << ' ' << bits;
      }
      EXPECT_EQ(sound, type.is_bcd ? 10'000U : 65'536U);
    }
  }
}

TEST(PointFormat, RawNumbersOf32And64BitsComeBack) {
  std::mt19937_64 random(1);
  for (const RegisterType type : integers) {
    const std::size_t width = 16 * registers_of(type);
    for (const PointFormat& format : formats_of(type)) {
      for (int i = 0; i < 20'000; ++i) {
        // Of all sizes, and from both ends.
        const std::uint64_t some = random() >> (64 - width) >> random() % width;
        const std::uint64_t all = width == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << width) - 1;
        ASSERT_TRUE(comes_back(some, format)) << name_of(type) << ' ' << format.scale << ' ' << some;
        ASSERT_TRUE(comes_back(all - some, format)) << name_of(type) << ' ' << format.scale << ' ' << all - some;
      }
    }
  }
}

TEST(PointFormat, EveryRawNumberOfARealComesBack) {
  std::mt19937_64 random(2);
  const PointFormat wide{.type = PointType::real64};
  for (int i = 0; i < 100'000; ++i) {
    const auto bits32 = static_cast<std::uint32_t>(random());
    const std::uint64_t bits64 = random();
    for (const double scale : {1.0, 1000.0, -0.001}) {
      const PointFormat narrow{.type = PointType::real32, .scale = scale};
      if (std::isfinite(std::bit_cast<float>(bits32))) {
        ASSERT_TRUE(comes_back(bits32, narrow)) << bits32 << ' ' << scale;
      }
    }
    ASSERT_TRUE(comes_back(bits64, wide)) << bits64;
  }
}

TEST(PointFormat, AValueComesBackWithinHalfAStepOrIsSaidToBeSaturated) {
  std::mt19937_64 random(3);
  for (const RegisterType type : integers) {
    for (const PointFormat& format : formats_of(type)) {
      const auto [low, high] = limits_of(format);
      std::uniform_real_distribution<double> around(-0.25, 1.25);
      for (int i = 0; i < 2'000; ++i) {
        const double value = low + around(random) * (high - low);
        const auto code = encoded(value, format);
        ASSERT_TRUE(code);
        const auto back = decoded(code->bits, format);
        if (!back) {
          continue;  // an unscaled integer beyond 2^53, which a double does not tell
        }
        const double step = std::abs(format.scale);
        const double nearest = std::min(std::max(value, low), high);
        EXPECT_LE(std::abs(*back - nearest), 0.5001 * step + std::abs(value) * 1e-15)
            << name_of(type) << ' ' << format.scale << ' ' << format.offset << ' ' << value;
        EXPECT_EQ(code->is_saturated, value < low - 0.5 * step || value > high + 0.5 * step)
            << name_of(type) << ' ' << format.scale << ' ' << value;
      }
    }
  }
}

TEST(PointFormat, WhatDoesNotFitIsSaturatedAndNeverWraps) {
  const auto code = [](double value, RegisterType type) { return encoded(value, {.type = type}); };
  const auto is = [](const std::optional<RawCode>& code, std::uint64_t bits, bool saturated) {
    return code && code->bits == bits && code->is_saturated == saturated;
  };
  EXPECT_TRUE(is(code(32767.4, PointType::int16), 0x7FFF, false));
  EXPECT_TRUE(is(code(32768.0, PointType::int16), 0x7FFF, true));
  EXPECT_TRUE(is(code(-1.0, PointType::uint16), 0, true));
  EXPECT_TRUE(is(code(1e300, PointType::int32), 0x7FFFFFFF, true));
  EXPECT_TRUE(is(code(HUGE_VAL, PointType::uint64), ~std::uint64_t{0}, true));
  EXPECT_TRUE(is(code(12345.0, RegisterType(PointType::uint16, true)), 0x9999, true));
  EXPECT_TRUE(is(code(-3.0, RegisterType(PointType::uint32, true)), 0, true));
  EXPECT_TRUE(is(code(1e300, PointType::real32), 0x7F7FFFFF, true)) << "the largest float, not infinity";
  EXPECT_TRUE(is(code(-HUGE_VAL, PointType::real32), 0xFF800000, false)) << "a real has infinity";
  const PointFormat fine{.type = PointType::int16, .scale = 0.001, .offset = 20.0};
  EXPECT_TRUE(is(encoded(60.0, fine), 0x7FFF, true));
  EXPECT_EQ(limits_of(fine).first, 20.0 - 32.768);
  EXPECT_EQ(limits_of(PointFormat{.type = PointType::int16, .scale = -1.0}).first, -32767.0) << "turned round";
}

TEST(PointFormat, WhatIsNotANumberHasNoIntegerAndADigitAboveNineIsNone) {
  for (const RegisterType type : register_types) {
    const auto code = encoded(std::nan(""), {.type = type});
    EXPECT_EQ(code.has_value(), is_real(type)) << name_of(type);
    EXPECT_TRUE(!code || std::isnan(*decoded(code->bits, {.type = type})));
  }
  const PointFormat digits{.type = {PointType::uint16, true}};
  EXPECT_EQ(decoded(0x1234, digits), 1234.0);
  EXPECT_EQ(encoded(1234.0, digits)->bits, 0x1234U);
  EXPECT_EQ(decoded(0x12A4, digits), std::nullopt);
  EXPECT_EQ(decoded(0xF000, digits), std::nullopt);
  EXPECT_EQ(decoded(0x98765432, {.type = {PointType::uint32, true}}), 98765432.0);
  EXPECT_EQ(taken(0x7FC00000, {.type = PointType::real32}, -1.0, 1.0), std::nullopt) << "a NaN is not taken";
}

TEST(PointFormat, ALimitIsAsTheFormatCanTellIt) {
  const PointFormat tenths{.type = PointType::int16, .scale = 0.1};
  EXPECT_EQ(decoded(3, tenths), 0.30000000000000004);
  EXPECT_EQ(taken(3, tenths, 0.0, 0.3), 0.3) << "the step is the limit, and no more than it";
  EXPECT_EQ(taken(4, tenths, 0.0, 0.3), std::nullopt);
  EXPECT_EQ(taken(3, tenths, 0.0, 0.25), std::nullopt) << "a limit between two steps is not reached";
  const PointFormat narrow{.type = PointType::real32};
  EXPECT_EQ(taken(std::bit_cast<std::uint32_t>(0.1F), narrow, 0.0, 0.1), 0.1);
  EXPECT_EQ(taken(std::bit_cast<std::uint32_t>(std::nextafter(0.1F, 1.0F)), narrow, 0.0, 0.1), std::nullopt);
  EXPECT_EQ(taken(std::bit_cast<std::uint64_t>(std::nextafter(0.1, 1.0)), {}, 0.0, 0.1), std::nullopt);
}

TEST(PointFormat, WhatWouldLoseRawNumbersIsRefused) {
  using Format = PointFormat;
  for (const Format& wrong :
       {Format{.type = PointType::int16, .scale = 0.0}, Format{.type = PointType::int16, .scale = std::nan("")},
        Format{.type = PointType::int16, .scale = 1e-310}, Format{.type = PointType::int16, .scale = HUGE_VAL},
        Format{.type = PointType::int32, .scale = 1e300, .offset = -HUGE_VAL},
        Format{.type = PointType::uint64, .scale = 1e305},
        Format{.type = PointType::int16, .scale = 1e-9, .offset = 1e9},
        Format{.type = PointType::boolean, .scale = 2.0}}) {
    EXPECT_NE(flaw_of(wrong), "") << name_of(wrong.type) << ' ' << wrong.scale << ' ' << wrong.offset;
  }
  EXPECT_EQ(flaw_of({.type = PointType::int16, .scale = -0.01, .offset = 20.0}), "");
}

TEST(PointFormat, ASafeValueStandsOnAStep) {
  const PointFormat hundredths{.type = PointType::int16, .scale = 0.01};
  EXPECT_TRUE(holds(hundredths, 0.07)) << "0.07/0.01 is 7.000000000000001";
  EXPECT_FALSE(holds(hundredths, 0.075));
  EXPECT_FALSE(holds(hundredths, 400.0));
  EXPECT_TRUE(holds(PointFormat{.type = PointType::real32}, 0.1));
  EXPECT_FALSE(holds(PointFormat{.type = PointType::real32}, 1e39));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
