// The thresholds of the evidence and the table in the documentation that prints them.
#include "diagnosis/policy.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

namespace hysteron::diagnosis {
namespace {

TEST(Policy, TheDocumentationHasEachThresholdAsItIs) {
  std::ifstream file(HYSTERON_SOURCE_DIR "/docs/diagnosis.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  for (const Threshold& one : policy::all) {
    const std::string unit = one.unit == "1" ? "" : fmt::format(" {}", one.unit);
    const std::string row = fmt::format("| {} | {:g}{} | {} | {} |{} |", one.name, one.value, unit, one.decides,
                                        one.origin, one.is_rule() ? " yes" : "");
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(Policy, NoThresholdStandsTwice) {
  std::set<std::string_view> names;
  for (const Threshold& one : policy::all) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_FALSE(one.origin.empty() || one.decides.empty()) << one.name;
  }
  EXPECT_LE(names.size(), 40U);
}

}  // namespace
}  // namespace hysteron::diagnosis
