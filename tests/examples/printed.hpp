// What an example prints, held against what its README shows: word by word, numbers as far as another C library may
// change them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "examples/example.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"

namespace hysteron::examples {

/// The words of a text. Numbers that are rounding alone, or that another libm may change in the last digit shown, are
/// compared by `alike`.
inline std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

inline bool alike(const std::string& a, const std::string& b) {
  const ParsedNumber x = parse_number(a);
  const ParsedNumber y = parse_number(b);
  if (x.status != NumberStatus::Finite || y.status != NumberStatus::Finite) {
    return a == b;
  }
  const bool rounding = std::fabs(x.value) < 1e-14 && std::fabs(y.value) < 1e-14;
  return rounding || std::fabs(x.value - y.value) <= 0.1 * std::fabs(y.value);
}

/// The first block of text in the README of an example, by the name of its folder.
inline void expect_readme_shows(const std::string& example, const std::string& printed) {
  const std::string page = read_text_file(path_of(example + "/README.md").string());
  const std::size_t table = page.find("```text\n");
  ASSERT_NE(table, std::string::npos);
  const auto shown = words_of(page.substr(table + 8, page.find("```", table + 8) - table - 8));
  const auto wanted = words_of(printed);
  ASSERT_EQ(shown.size(), wanted.size()) << printed;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_TRUE(alike(shown[i], wanted[i])) << shown[i] << " in the README, " << wanted[i] << " printed";
  }
}

}  // namespace hysteron::examples
