// The rooms of the house and the arrows between them: which folder may include which.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/house/source_files.hpp"

namespace hysteron::house {
namespace {

using Arrows = std::map<std::string, std::set<std::string>, std::less<>>;

/// A room may include itself and these. blocks includes nothing of ours, and codegen and runtime never each other, so
/// that a block stands alone and a target carries no compiler.
const Arrows& allowed() {
  static const Arrows arrows{
      {"blocks", {}},
      {"support", {}},
      {"database", {"support"}},
      {"records", {"support"}},
      {"plots", {"support"}},
      {"codegen", {"blocks", "support", "plots"}},
      {"lsp", {"codegen", "blocks", "support"}},
      {"runtime", {"blocks", "support", "database"}},
      {"tuning", {"blocks", "codegen", "support", "records"}},
      {"robots", {"tuning", "codegen", "blocks", "support", "records"}},
      {"diagnosis", {"tuning", "codegen", "blocks", "support", "records", "plots"}},
      {"bindings", {"blocks", "codegen", "tuning", "diagnosis", "support", "records", "plots"}},
      {"fleet", {"support", "database", "records", "plots"}},
      {"tool",
       {"blocks", "codegen", "runtime", "tuning", "diagnosis", "fleet", "lsp", "robots", "support", "records", "plots",
        "database"}},
      {"examples", {"blocks", "codegen", "runtime", "tuning", "diagnosis", "support", "records", "plots"}},
      {"bench", {"blocks", "codegen", "runtime", "tuning", "diagnosis", "support", "records", "plots"}},
      {"docs", {"blocks", "codegen", "runtime", "tuning", "diagnosis", "tool", "support", "records", "plots"}},
      {"tests",
       {"blocks", "codegen", "runtime", "tuning", "diagnosis", "fleet", "lsp", "robots", "tool", "support", "records",
        "plots", "database", "examples", "bench", "bindings"}},
  };
  return arrows;
}

/// The floors of the diagnosis, from the ground: a folder includes what lies below it, so that a fit knows nothing of
/// verdicts, and a verdict nothing of the words that are made of it.
const std::vector<std::string>& floors_of_diagnosis() {
  static const std::vector<std::string> floors{"model",  "noise",   "effects",  "search", "evidence", "faults",
                                               "remedy", "verdict", "findings", "report", "stages"};
  return floors;
}

/// The path that a line includes; empty where it includes nothing.
std::string_view included_path(std::string_view line) {
  const auto hash = line.find_first_not_of(" \t");
  if (hash == std::string_view::npos || line[hash] != '#') {
    return {};
  }
  const auto word = line.find_first_not_of(" \t", hash + 1);
  if (word == std::string_view::npos || !line.substr(word).starts_with("include")) {
    return {};
  }
  const auto open = line.find_first_of("\"<", word);
  const auto close = open == std::string_view::npos ? open : line.find_first_of("\">", open + 1);
  return close == std::string_view::npos ? std::string_view{} : line.substr(open + 1, close - open - 1);
}

/// The room that a line includes; empty where it includes none of ours.
std::string included_room(std::string_view line) {
  const std::string_view path = included_path(line);
  const auto slash = path.find('/');
  std::string room(slash == std::string_view::npos ? "" : path.substr(0, slash));
  return allowed().contains(room) ? room : "";
}

/// The floor of a file of the diagnosis; the front door and what it answers lie on none.
std::optional<std::size_t> floor_of(std::string_view path) {
  const auto& floors = floors_of_diagnosis();
  for (std::size_t i = 0; i < floors.size(); ++i) {
    if (path.starts_with("diagnosis/" + floors[i] + "/")) {
      return i;
    }
  }
  return std::nullopt;
}

std::string arrows_up_the_stairs(const SourceText& file) {
  const std::optional<std::size_t> own = floor_of(file.path);
  std::string found;
  for (std::size_t i = 0; own && i < file.lines.size(); ++i) {
    const std::string_view path = included_path(file.lines[i]);
    if (floor_of(path) > own || path == "diagnosis/diagnose.hpp") {
      found += fmt::format("{}:{}: {} lies above {}\n", file.path, i + 1, path, floors_of_diagnosis()[*own]);
    }
  }
  return found;
}

std::string forbidden_arrows(const SourceText& file) {
  const auto& targets = allowed().at(file.room());
  std::string found;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const std::string target = included_room(file.lines[i]);
    if (!target.empty() && target != file.room() && !targets.contains(target)) {
      found += file.path + ":" + std::to_string(i + 1) + ": " + file.room() + " may not include " + target + "\n";
    }
  }
  return found;
}

TEST(Includes, FollowTheArrowsBetweenTheRooms) {
  std::vector<std::string> rooms;
  for (const auto& [room, targets] : allowed()) {
    rooms.push_back(room);
  }
  const auto files = source_files(rooms);
  ASSERT_GT(files.size(), 150U);
  std::string found;
  for (const SourceText& file : files) {
    found += forbidden_arrows(file);
  }
  EXPECT_EQ(found, "");
}

TEST(Includes, AForbiddenArrowIsFoundHoweverItIsWritten) {
  const std::string expected = "codegen/x.cpp:2: codegen may not include runtime\n";
  for (const char* line :
       {"#include \"runtime/task.hpp\"", "#include <runtime/task.hpp>", "  #  include \"runtime/t.hpp\""}) {
    EXPECT_EQ(forbidden_arrows({.path = "codegen/x.cpp", .lines = {"#include <cmath>", line}}), expected);
  }
  EXPECT_EQ(forbidden_arrows({.path = "blocks/x.hpp", .lines = {"#include \"support/numbers.hpp\""}}),
            "blocks/x.hpp:1: blocks may not include support\n");
  EXPECT_EQ(forbidden_arrows({.path = "tuning/x.hpp", .lines = {"#include \"records/csv.hpp\""}}), "");
}

TEST(Includes, LeadDownTheFloorsOfTheDiagnosis) {
  std::string found;
  for (const SourceText& file : source_files({"diagnosis"})) {
    if (std::ranges::count(file.path, '/') > 1) {
      EXPECT_TRUE(floor_of(file.path)) << file.path << " lies on no floor";
    }
    found += arrows_up_the_stairs(file);
  }
  EXPECT_EQ(found, "");
  EXPECT_EQ(
      arrows_up_the_stairs({.path = "diagnosis/noise/x.cpp", .lines = {"#include \"diagnosis/model/model.hpp\""}}), "");
  EXPECT_EQ(
      arrows_up_the_stairs({.path = "diagnosis/noise/x.cpp", .lines = {"#include \"diagnosis/search/sets.hpp\""}}),
      "diagnosis/noise/x.cpp:1: diagnosis/search/sets.hpp lies above noise\n");
}

/// Every folder with sources is a room that the table knows.
TEST(Includes, EveryFolderWithSourcesIsARoom) {
  const std::filesystem::path root = HYSTERON_SOURCE_DIR;
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || name == "build" || name.starts_with(".") || allowed().contains(name)) {
      continue;
    }
    EXPECT_TRUE(source_files({name}).empty()) << name << " has sources, and is not in the table of rooms";
  }
}

}  // namespace
}  // namespace hysteron::house
