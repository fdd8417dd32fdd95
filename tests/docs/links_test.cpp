// Links between the pages lead somewhere: the file is there, and the heading in it.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/docs/page.hpp"

namespace hysteron::test {
namespace {

/// Why a link leads nowhere; empty where it does not.
std::string fault_of(const Page& page, const Link& link) {
  if (link.target.starts_with("http://") || link.target.starts_with("https://")) {
    return {};
  }
  const auto hash = link.target.find('#');
  const auto file = link.target.substr(0, hash);
  const auto target = file.empty() ? page.path : page.path.parent_path() / file;
  if (!std::filesystem::exists(target)) {
    return "there is no " + target.lexically_normal().string();
  }
  if (hash != std::string::npos && !read_page(target).anchors.contains(link.target.substr(hash + 1))) {
    return file + " has no heading for #" + link.target.substr(hash + 1);
  }
  return {};
}

TEST(Links, LeadSomewhere) {
  std::size_t followed = 0;
  for (const auto& path : all_pages()) {
    const Page page = read_page(path);
    for (const Link& link : page.links) {
      EXPECT_EQ(fault_of(page, link), "") << path.string() << ":" << link.line;
      ++followed;
    }
  }
  EXPECT_GT(followed, 200U);
}

TEST(Links, EveryPageIsReachedFromTheIndex) {
  std::set<std::filesystem::path> reached;
  std::vector<std::filesystem::path> open{source_folder() / "docs" / "README.md"};
  while (!open.empty()) {
    const auto path = open.back();
    open.pop_back();
    if (!reached.insert(path).second) {
      continue;
    }
    const Page page = read_page(path);
    for (const Link& link : page.links) {
      const auto file = link.target.substr(0, link.target.find('#'));
      const auto target = (path.parent_path() / file).lexically_normal();
      if (file.ends_with(".md") && std::filesystem::exists(target)) {
        open.push_back(target);
      }
    }
  }
  for (const auto& path : all_pages()) {
    if (is_below(path, "docs/") && !is_below(path, "docs/errors/")) {
      EXPECT_TRUE(reached.contains(path)) << path << " is reached by no link";
    }
  }
}

}  // namespace
}  // namespace hysteron::test
