#include "support/numbers.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "support/rounded_text.hpp"

namespace hysteron {
namespace {

TEST(NumberText, IsWhatAPersonWouldWrite) {
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(-0.0), "-0");
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(0.1F), "0.1");
  EXPECT_EQ(number_text(25.0), "25");
  EXPECT_EQ(number_text(1234.5), "1234.5");
  EXPECT_EQ(number_text(0.00015625), "0.00015625");
  EXPECT_EQ(number_text(1.6e-11), "1.6e-11");
  EXPECT_EQ(number_text(-1e22), "-1e22");
  EXPECT_EQ(number_text(1e15), "1000000000000000");
  EXPECT_EQ(number_text(1e16), "1e16");
  EXPECT_EQ(number_text(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(number_text(5e-324), "5e-324");
  EXPECT_EQ(number_text(std::numeric_limits<double>::max()), "1.7976931348623157e308");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "-inf");
  EXPECT_EQ(number_text(std::nan("")), "nan");
}

TEST(NumberText, ARoundingIsNotShownToAReader) {
  EXPECT_EQ(number_text(300'000 * 1e-9), "0.00030000000000000003");
  EXPECT_EQ(rounded_text(300'000 * 1e-9), "0.0003");
  EXPECT_EQ(rounded_text(50e-6), "0.00005");
  EXPECT_EQ(rounded_text(0.0033052155286844667), "0.00330521552868");
  EXPECT_EQ(rounded_text(-0.1 - 0.2), "-0.3");
  EXPECT_EQ(rounded_text(0.0), "0");
  EXPECT_EQ(rounded_text(infinity), "inf");
  EXPECT_EQ(rounded_text(not_a_number), "nan");
}

TEST(NumberText, TwoNumbersThatDifferHaveTextsThatShowBy) {
  using Texts = std::pair<std::string, std::string>;
  EXPECT_EQ(distinct_texts(0.015, 0.005, 6), Texts("0.015", "0.005"));
  EXPECT_EQ(distinct_texts(0.101, 0.101, 6), Texts("0.101", "0.101"));
  EXPECT_EQ(distinct_texts(0.10132, 0.10128, 3), Texts("0.10132", "0.10128"));
  EXPECT_EQ(distinct_texts(0.1014996, 0.1015004, 3), Texts("0.1014996", "0.1015004")) << "0.101 and 0.102 exaggerate";
  EXPECT_EQ(distinct_texts(1e9, 1e9 + 0.25, 6), Texts("1000000000", "1000000000.25"));
  EXPECT_EQ(distinct_texts(-0.0, 0.0, 3), Texts("-0", "0"));
  EXPECT_EQ(distinct_texts(1.0, infinity, 3), Texts("1", "inf"));
  EXPECT_EQ(distinct_texts(not_a_number, 1.0, 3), Texts("nan", "1"));
  const double next = std::nextafter(1.0, 2.0);
  const auto [one, other] = distinct_texts(1.0, next, 3);
  EXPECT_NE(one, other);
}

TEST(NumberText, LiteralsAlwaysHaveAPoint) {
  EXPECT_EQ(real_literal(25.0), "25.0");
  EXPECT_EQ(real_literal(0.0), "0.0");
  EXPECT_EQ(real_literal(1e-11), "1.0e-11");
  EXPECT_EQ(real_literal(-1.6e-11F), "-1.6e-11");
  EXPECT_EQ(real_literal(0.5), "0.5");
  EXPECT_EQ(real_literal(1e6), "1000000.0");
}

// The C library's own reader is the second implementation.
TEST(NumberText, ReadsBackToTheSameBits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 200000; ++i) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) {
      continue;
    }
    for (const auto& text : {number_text(value), real_literal(value)}) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr)), std::bit_cast<std::uint64_t>(value))
          << text;
      const auto read = parse_number(text);
      ASSERT_EQ(read.status, NumberStatus::Finite) << text;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(read.value), std::bit_cast<std::uint64_t>(value)) << text;
    }
    const auto single = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(single)) {
      const auto text = real_literal(single);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(std::strtof(text.c_str(), nullptr)), std::bit_cast<std::uint32_t>(single))
          << text;
    }
  }
}

TEST(ParseNumber, ReadsWhatLogsContain) {
  for (const auto& [text, value] :
       {std::pair{"1", 1.0}, std::pair{"-1.5", -1.5}, std::pair{"+1.5", 1.5}, std::pair{".5", 0.5},
        std::pair{"5.", 5.0}, std::pair{"1e3", 1000.0}, std::pair{"1.5E-3", 0.0015}, std::pair{"-0", -0.0}}) {
    const auto read = parse_number(text);
    EXPECT_EQ(read.status, NumberStatus::Finite) << text;
    EXPECT_EQ(read.value, value) << text;
  }
}

TEST(ParseNumber, RefusesEverythingElse) {
  for (const auto* text :
       {"", " 1", "1 ", "1,5", "0x10", "1e", "e5", "+", "-", "+-1", "--1", "++1", ".", "1.2.3", "on", "1'000"}) {
    EXPECT_EQ(parse_number(text).status, NumberStatus::NotANumber) << text;
  }
  for (const auto* text : {"nan", "NaN", "inf", "-Inf", "+INFINITY", "-nan(ind)"}) {
    EXPECT_EQ(parse_number(text).status, NumberStatus::NotFinite) << text;
  }
  EXPECT_EQ(parse_number("1e400").status, NumberStatus::OutOfRange);
  EXPECT_EQ(parse_number("-1e-400").status, NumberStatus::OutOfRange);
}

}  // namespace
}  // namespace hysteron
