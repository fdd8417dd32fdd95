// One record in the words of a tool: the numbers that each dialect must give.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "records/read.hpp"
#include "records/record.hpp"

namespace hysteron::records {

inline constexpr int samples = 40;

inline double drive(int k) {
  return std::round(1e4 * (1.6 * std::sin(0.7 * k) + 0.9 * std::sin(0.23 * k + 0.4))) / 1e4;
}

/// {k} the row, {t} its seconds, {u} and {y} = 3·u with four decimals.
inline std::string written(std::string_view head, std::string_view row, std::string_view tail = "") {
  std::string text(head);
  for (int k = 0; k < samples; ++k) {
    text += fmt::format(fmt::runtime(row), fmt::arg("k", k), fmt::arg("t", 1e-3 * k), fmt::arg("u", drive(k)),
                        fmt::arg("y", 3.0 * drive(k)));
  }
  return text + std::string(tail);
}

struct Dialect {
  std::string_view name;
  std::string text;
  ReadOptions options{};
};

/// What was understood, a line each.
inline std::string notes_of(const Record& record) {
  return fmt::format("{}", fmt::join(record.notes(), "\n"));
}

/// u, and y = 3 u, every millisecond.
inline void expect_the_numbers(const Dialect& one) {
  SCOPED_TRACE(one.name);
  SCOPED_TRACE(one.text.substr(0, 300));
  Record record = Record::even(0.0, 1.0, 0);
  ASSERT_NO_THROW(record = parse_record("log.csv", one.text, one.options));
  ASSERT_EQ(record.size(), static_cast<std::size_t>(samples));
  EXPECT_DOUBLE_EQ(record.sample_time(), 1e-3);
  ASSERT_NO_THROW((void)record.column("u"));
  ASSERT_NO_THROW((void)record.column("y"));
  for (std::size_t k = 0; k < record.size(); ++k) {
    EXPECT_NEAR(record.time()[k] - record.time()[0], 1e-3 * static_cast<double>(k), 1e-9);
    EXPECT_NEAR(record.column("u").values[k], drive(static_cast<int>(k)), 6e-5);
    EXPECT_NEAR(record.column("y").values[k], 3.0 * drive(static_cast<int>(k)), 6e-5);
  }
}

}  // namespace hysteron::records
