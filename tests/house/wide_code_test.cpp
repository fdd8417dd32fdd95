// Code for processors that not every machine has must not reach the others through an inline function.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/scratch_folder.hpp"

namespace hysteron::house {
namespace {

/// The functions that a file of objects defines and that the linker would merge with others of their name.
std::set<std::string> inline_functions(const std::string& objects, const test::ScratchFolder& folder) {
  const std::string list = folder / "symbols";
  const std::string command = "nm --defined-only " + objects + " > " + list + " 2> /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::set<std::string> found;
  std::ifstream lines(list);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string address;
    std::string kind;
    std::string name;
    if (words >> address >> kind >> name && (kind == "W" || kind == "w")) {
      found.insert(name);
    }
  }
  return found;
}

TEST(WideCode, SharesNoInlineFunctionWithOtherCode) {
  const test::ScratchFolder folder;
  std::ifstream listed(HYSTERON_OBJECTS);
  std::set<std::string> wide;
  std::set<std::string> others;
  std::size_t wide_files = 0;
  for (std::string object; std::getline(listed, object);) {
    const bool is_wide =
        object.find("lanes_code") != std::string::npos || object.find("wide_code") != std::string::npos;
    wide_files += is_wide ? 1 : 0;
    (is_wide ? wide : others).merge(inline_functions(object, folder));
  }
  ASSERT_EQ(wide_files, 2U) << "the sources of hysteron_registers() in CMakeLists.txt";
  ASSERT_GT(wide.size(), 100U);
  ASSERT_GT(others.size(), 1000U);
  std::vector<std::string> shared;
  std::ranges::set_intersection(wide, others, std::back_inserter(shared));
  EXPECT_TRUE(shared.empty()) << shared.size() << " inline functions are compiled for every processor and for wide "
                              << "registers; the linker keeps one of them. The first: " << shared.front();
}

}  // namespace
}  // namespace hysteron::house
