// The page of what a task says: each line on it is one that the sources can say, and each kind of line is on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "runtime/task/safe_outputs.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using hysteron::test::contents_of;

const std::filesystem::path source_folder = HYSTERON_SOURCE_DIR;

/// The sources of what speaks while a task runs, literals that stand side by side as the one that they are.
std::string spoken() {
  std::string all;
  for (const char* const folder : {"runtime", "tool", "support"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder / folder)) {
      if (entry.path().extension() == ".cpp") {
        all += contents_of(entry.path());
      }
    }
  }
  all = std::regex_replace(all, std::regex("\"\\s*\\n\\s*\""), "");
  return std::regex_replace(all, std::regex("\\\\\""), "\"");
}

std::string page_of_notices() {
  return contents_of(source_folder / "docs/reference/notices.md");
}

/// What stands in a line between its names and numbers.
std::vector<std::string> pieces_of(const std::string& line) {
  std::vector<std::string> pieces;
  std::string::size_type begin = 0;
  for (;;) {
    const auto gap = line.find("…", begin);
    std::string piece = line.substr(begin, gap - begin);
    const auto first = piece.find_first_not_of(" .,;:");
    const auto last = piece.find_last_not_of(" .,;:");
    if (first != std::string::npos && last - first > 2) {
      pieces.push_back(piece.substr(first, last - first + 1));
    }
    if (gap == std::string::npos) {
      return pieces;
    }
    begin = gap + std::string("…").size();
  }
}

TEST(Notices, EachLineOfThePageIsOneThatTheSourcesSay) {
  const std::string all = spoken();
  const std::string page = page_of_notices();
  const std::regex row("\\n\\| `([^`]+)` \\|");
  std::size_t lines = 0;
  for (std::sregex_iterator at(page.begin(), page.end(), row), end; at != end; ++at) {
    const std::string line = (*at)[1];
    if (line.starts_with("hysteron ")) {
      continue;  // of the exit codes
    }
    ++lines;
    for (const std::string& piece : pieces_of(line)) {
      EXPECT_NE(all.find(piece), std::string::npos) << line << "\nno source says: " << piece;
    }
  }
  EXPECT_GT(lines, 50U);
}

TEST(Notices, EachNameThatALineBeginsWithIsOnThePage) {
  const std::string all = spoken();
  const std::string page = page_of_notices();
  std::set<std::string> names;
  for (const auto& begins :
       {std::regex("\\btell\\(\\s*\"([A-Z][^\"]*)\","), std::regex("beside\\.emplace\\(\"([A-Z][^\"]*)\",")}) {
    for (std::sregex_iterator at(all.begin(), all.end(), begins), end; at != end; ++at) {
      names.insert((*at)[1]);
    }
  }
  EXPECT_GE(names.size(), 14U);
  for (const std::string& name : names) {
    EXPECT_NE(page.find("\n| **" + name + "** |"), std::string::npos) << name;
  }
}

TEST(Notices, EachFaultHasItsRow) {
  const std::string page = page_of_notices();
  for (auto fault = static_cast<unsigned>(Fault::hang); fault <= static_cast<unsigned>(Fault::overload); ++fault) {
    const std::string row =
        "\n| " + std::to_string(fault) + " | " + std::string(name_of(static_cast<Fault>(fault))) + " | ";
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace hysteron::runtime
