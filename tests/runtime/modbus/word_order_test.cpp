#include "runtime/modbus/word_order.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "runtime/modbus/value_bits.hpp"

namespace hysteron::runtime::modbus {
namespace {

/// The bytes as they go over the wire.
std::string wire(std::uint64_t bits, std::size_t registers, WordOrder order) {
  std::vector<std::uint16_t> words(registers);
  to_registers(bits, order, words);
  std::string text;
  for (const std::uint16_t word : words) {
    text += static_cast<char>(word >> 8U);
    text += static_cast<char>(word & 0xFFU);
  }
  return text;
}

TEST(WordOrder, NamesSayWhereTheBytesGo) {
  constexpr std::uint64_t letters = 0x41424344;  // ABCD
  for (const WordOrder order : word_orders) {
    EXPECT_EQ(wire(letters, 2, order), name_of(order));
    EXPECT_EQ(word_order_named(name_of(order)), order);
  }
  EXPECT_EQ(word_order_named("abcd"), std::nullopt);
}

TEST(WordOrder, OfSixtyFourBits) {
  constexpr std::uint64_t letters = 0x4142434445464748;
  EXPECT_EQ(wire(letters, 4, WordOrder::abcd), "ABCDEFGH");
  EXPECT_EQ(wire(letters, 4, WordOrder::cdab), "GHEFCDAB");
  EXPECT_EQ(wire(letters, 4, WordOrder::badc), "BADCFEHG");
  EXPECT_EQ(wire(letters, 4, WordOrder::dcba), "HGFEDCBA");
}

TEST(WordOrder, ASingleRegisterHasNone) {
  for (const WordOrder order : word_orders) {
    EXPECT_EQ(wire(0x4142, 1, order), "AB");
  }
}

TEST(WordOrder, EveryPatternComesBack) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    for (const WordOrder order : word_orders) {
      for (const std::size_t count : {1U, 2U, 3U, 4U}) {
        std::array<std::uint16_t, 4> words{};
        const std::span<std::uint16_t> used(words.data(), count);
        to_registers(bits, order, used);
        ASSERT_EQ(from_registers(used, order), count == 4 ? bits : bits & ((std::uint64_t{1} << (16 * count)) - 1));
      }
    }
  }
}

TEST(WordOrder, KnownNumbers) {
  // 1.0 and -12345.625 as published in IEEE 754 tables.
  EXPECT_EQ(bits_of(1.0, PointType::real32), 0x3F800000U);
  EXPECT_EQ(bits_of(1.0, PointType::real64), 0x3FF0000000000000U);
  EXPECT_EQ(bits_of(-12345.625, PointType::real32), 0xC640E680U);
  EXPECT_EQ(bits_of(-2.0, PointType::int16), 0xFFFEU);
  EXPECT_EQ(bits_of(-2.0, PointType::int32), 0xFFFFFFFEU);
  EXPECT_EQ(bits_of(-2.0, PointType::int64), 0xFFFFFFFFFFFFFFFEU);
}

TEST(ValueBits, NotANumberKeepsItsPayload) {
  constexpr std::uint64_t signalling = 0x7FF0000000000ABC;
  EXPECT_EQ(bits_of(std::bit_cast<double>(signalling), PointType::real64), signalling);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(*value_of(signalling, PointType::real64)), signalling);
  EXPECT_TRUE(std::isnan(*value_of(bits_of(std::nan(""), PointType::real32), PointType::real32)));
  EXPECT_EQ(value_of(bits_of(-HUGE_VAL, PointType::real32), PointType::real32), -HUGE_VAL);
}

TEST(ValueBits, IntegersRoundAndSaturate) {
  EXPECT_EQ(bits_of(2.5, PointType::int16), 2U);  // half to even
  EXPECT_EQ(bits_of(3.5, PointType::int16), 4U);
  EXPECT_EQ(bits_of(1e300, PointType::int16), 0x7FFFU);
  EXPECT_EQ(bits_of(-1e300, PointType::int16), 0x8000U);
  EXPECT_EQ(bits_of(-1.0, PointType::uint16), 0U);
  EXPECT_EQ(bits_of(65535.4, PointType::uint16), 0xFFFFU);
  EXPECT_EQ(bits_of(65535.6, PointType::uint16), 0xFFFFU);
  EXPECT_EQ(bits_of(HUGE_VAL, PointType::uint64), 0xFFFFFFFFFFFFFFFFU);
  EXPECT_EQ(bits_of(-HUGE_VAL, PointType::int64), 0x8000000000000000U);
  for (const PointType type : {PointType::int16, PointType::uint16, PointType::int32, PointType::uint32,
                               PointType::int64, PointType::uint64, PointType::boolean}) {
    EXPECT_EQ(bits_of(std::nan(""), type), 0U) << name_of(type);
  }
}

TEST(ValueBits, WholeNumbersComeBackUpToTwoToThe53) {
  constexpr double limit = 9007199254740992.0;
  for (const double value : {0.0, 1.0, limit - 1.0, limit}) {
    EXPECT_EQ(value_of(bits_of(value, PointType::uint64), PointType::uint64), value);
    EXPECT_EQ(value_of(bits_of(value, PointType::int64), PointType::int64), value);
    EXPECT_EQ(value_of(bits_of(-value, PointType::int64), PointType::int64), -value);
  }
  EXPECT_EQ(value_of(0x20000000000001, PointType::uint64), std::nullopt);
  EXPECT_EQ(value_of(0x20000000000001, PointType::int64), std::nullopt);
  EXPECT_EQ(value_of(static_cast<std::uint64_t>(-0x20000000000001), PointType::int64), std::nullopt);
}

TEST(ValueBits, EverySixteenBitsComeBack) {
  for (std::uint32_t bits = 0; bits <= 0xFFFF; ++bits) {
    ASSERT_EQ(bits_of(*value_of(bits, PointType::int16), PointType::int16), bits);
    ASSERT_EQ(bits_of(*value_of(bits, PointType::uint16), PointType::uint16), bits);
  }
}

}  // namespace
}  // namespace hysteron::runtime::modbus
