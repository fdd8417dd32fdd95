// What every source file owes its reader: a header an opening comment and a guard, all a length that can be read and
// nothing left undone.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "tests/house/source_files.hpp"

namespace hysteron::house {
namespace {

constexpr std::size_t longest_file = 500;

/// In two halves, so that this file does not find itself.
constexpr std::array<std::string_view, 4> undone_words{
    "TO"
    "DO",
    "FIX"
    "ME",
    "GTEST_"
    "SKIP",
    "DISABLED"
    "_"};

/// Where such a word may stand, and why.
struct Allowed {
  std::string_view path;
  std::string_view word;
  std::string_view reason;
};
constexpr std::array<Allowed, 12> allowed_words{{
    {"tests/house/instructions_test.cpp", undone_words[2], "without valgrind, outside continuous integration"},
    {"tests/support/measured_records.hpp", undone_words[2], "without the folder of measured records"},
    {"tests/records/measured_test.cpp", undone_words[2], "without the folder of measured records"},
    {"tests/support/in_browser.hpp", undone_words[2], "without chromium"},
    {"tests/codegen/backends/outside_compilers_test.cpp", undone_words[2],
     "without MATIEC or STruC++, outside compilers"},
    {"tests/tool/test_bench_test.cpp", undone_words[2], "without MATIEC, an outside compiler"},
    {"tests/runtime/mqtt/broker.hpp", undone_words[2], "without mosquitto"},
    {"tests/runtime/mqtt/sparkplug_decoder.hpp", undone_words[2], "without protoc"},
    {"tests/codegen/lanes_test.cpp", undone_words[2], "on a processor without registers of 512 bits"},
    {"tests/tuning/rollout_test.cpp", undone_words[2], "on a processor without registers of 512 bits"},
    {"tests/clients/points_test.cpp", undone_words[2], "without node, or without the clients that a script fetches"},
    {"tests/tool/troubled_disk_test.cpp", undone_words[2], "where nobody may have a disk of his own, as in a chroot"},
}};

std::vector<SourceText> all_sources() {
  return source_files({"bench", "bindings", "blocks", "codegen", "diagnosis", "docs", "examples", "fleet", "gateways",
                       "plots", "records", "robots", "runtime", "support", "tests", "tool", "trials", "tuning"},
                      {".hpp", ".cpp", ".py", ".js"});
}

TEST(Sources, AreShortEnoughToBeRead) {
  for (const SourceText& file : all_sources()) {
    EXPECT_LE(file.lines.size(), longest_file) << file.path << ": one concept a file; divide it";
  }
}

TEST(Sources, HeadersOpenWithWhatTheyAreFor) {
  for (const SourceText& file : all_sources()) {
    if (file.is_header()) {
      ASSERT_FALSE(file.lines.empty()) << file.path;
      EXPECT_TRUE(file.lines.front().starts_with("// ")) << file.path << " opens without a comment";
    }
  }
}

TEST(Sources, HeadersAreIncludedOnce) {
  for (const SourceText& file : all_sources()) {
    if (file.is_header()) {
      EXPECT_NE(std::ranges::find(file.lines, "#pragma once"), file.lines.end()) << file.path;
    }
  }
}

/// Whether the text names a file, alone or by a common beginning: `sets`, `sets.hpp`, `inverse*`.
bool names(const std::string& readme, const std::string& stem) {
  for (std::size_t length = 1; length <= stem.size(); ++length) {
    if (readme.find("`" + stem.substr(0, length) + "*`") != std::string::npos) {
      return true;
    }
  }
  return readme.find("`" + stem + "`") != std::string::npos || readme.find("`" + stem + ".hpp`") != std::string::npos;
}

/// Where a folder's README has a table of files and their jobs.
/// The text of the nearest README above a file that has a table of files; empty where none has.
std::string table_of_files(const std::filesystem::path& file) {
  const std::filesystem::path root = HYSTERON_SOURCE_DIR;
  for (std::filesystem::path folder = file.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    std::ifstream readme(root / folder / "README.md");
    const std::string text{std::istreambuf_iterator<char>(readme), std::istreambuf_iterator<char>()};
    if (text.find(" | job |") != std::string::npos) {
      return text;
    }
  }
  return "";
}

TEST(Sources, AFoldersTableOfFilesNamesItsHeaders) {
  std::size_t named = 0;
  for (const SourceText& file : all_sources()) {
    const std::filesystem::path path = file.path;
    const std::string text = file.is_header() ? table_of_files(path) : "";
    if (!text.empty()) {
      EXPECT_TRUE(names(text, path.stem().string())) << "the README above " << path << " lacks it";
      ++named;
    }
  }
  EXPECT_GT(named, 50U) << "or nothing was tested";
}

/// Two of them side by side are wrong as GCC 12 compiles them: support/single.hpp.
TEST(Sources, RoundToThirtyTwoBitsInOnePlace) {
  const std::array<std::string_view, 4> spellings{
      "static_cast<double>(static_cast<"
      "float>",
      "static_cast<Real>(static_cast<"
      "float>",
      "static_cast<S>(static_cast<"
      "float>",
      "(double)("
      "float)"};
  std::size_t read = 0;
  for (const SourceText& file : all_sources()) {
    std::string text;
    for (const std::string& line : file.lines) {
      std::ranges::copy_if(line, std::back_inserter(text), [](char c) { return c != ' '; });
    }
    read += text.find("nearest_single(") != std::string::npos ? 1 : 0;
    for (const std::string_view spelling : spellings) {
      EXPECT_EQ(text.find(spelling), std::string::npos) << file.path << ": write nearest_single() for " << spelling;
    }
  }
  EXPECT_GT(read, 5U) << "files that round so";
}

TEST(Sources, NothingIsLeftUndone) {
  for (const SourceText& file : all_sources()) {
    for (const std::string_view word : undone_words) {
      const bool allowed = std::ranges::any_of(allowed_words, [&](const Allowed& one) {
        return one.path == file.path && one.word == word && !one.reason.empty();
      });
      for (std::size_t i = 0; !allowed && i < file.lines.size(); ++i) {
        EXPECT_EQ(file.lines[i].find(word), std::string::npos) << file.path << ":" << i + 1 << ": " << word;
      }
    }
  }
}

TEST(Sources, EveryAllowanceIsNeeded) {
  for (const SourceText& file : all_sources()) {
    for (const Allowed& one : allowed_words) {
      if (one.path == file.path) {
        EXPECT_TRUE(std::ranges::any_of(
            file.lines, [&](const std::string& line) { return line.find(one.word) != std::string::npos; }))
            << one.path << " no longer has " << one.word;
      }
    }
  }
}

}  // namespace
}  // namespace hysteron::house
