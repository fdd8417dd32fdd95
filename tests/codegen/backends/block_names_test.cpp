// No target knows a block by its name: what it writes for a block follows from the block's pins and its trace. The
// names are those of the catalogue, and the files are those that lie there, so that neither list has to be kept.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/batch/batch.hpp"
#include "codegen/backends/c/c.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/drawing/diagram_dot.hpp"
#include "codegen/backends/fmu/fmu.hpp"
#include "codegen/backends/plcopen/plcopen.hpp"
#include "codegen/backends/st/st.hpp"
#include "codegen/program_hash.hpp"
#include "codegen/trace/block_type.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/house/source_files.hpp"

namespace hysteron::testing {
namespace {

// --- what is written ---

constexpr std::string_view prefix = "HY_";
constexpr std::string_view other_prefix = "QZ_";  // as long, so that lines break where they did

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
  return text;
}

std::string renamed(const std::string& text) {
  return replaced(replaced(text, prefix, other_prefix), "hy_", "qz_");
}

/// Copies of blocks that differ from them in their names alone.
class RenamedBlocks {
 public:
  Program of(const Program& program) {
    Program result = program;
    for (Node& node : result.graph.nodes) {
      if (node.block != nullptr) {
        node.block = copy_of(*node.block);
      }
    }
    return result;
  }
  [[nodiscard]] std::size_t count() const { return copies_.size(); }

 private:
  const BlockType* copy_of(const BlockType& block) {
    const auto [found, is_new] = copies_.try_emplace(&block, nullptr);
    if (is_new) {
      BlockType& copy = blocks_.emplace_back(block);
      copy.about.name = names_.emplace_back(renamed(std::string(block.about.name)));
      found->second = &copy;
    }
    return found->second;
  }

  std::map<const BlockType*, const BlockType*> copies_;
  std::deque<BlockType> blocks_;
  std::deque<std::string> names_;
};

using Files = std::vector<GeneratedFile>;

/// Everything that is written for a program, by who writes it. Empty where it refuses the program. Not the blocks as
/// calls: that text asks the catalogue for each by its name.
std::map<std::string, Files> written(const Program& program) {
  std::map<std::string, Files> all;
  const auto keep = [&](const std::string& target, const std::function<Files()>& generate) {
    try {
      all[target] = generate();
    } catch (const InputError&) {
      all[target] = {};
    }
  };
  keep("cpp", [&] { return generate_cpp(program); });
  keep("batch", [&] { return Files{generate_batch(program)}; });
  for (const bool float32 : {false, true}) {
    keep(float32 ? "c, float" : "c", [&] { return generate_c(program, {.float32 = float32}); });
  }
  for (const FmiVersion version : {FmiVersion::Two, FmiVersion::Three}) {
    keep(version == FmiVersion::Two ? "fmu 2" : "fmu 3",
         [&] { return generate_fmu(program, {.version = version}).files; });
  }
  for (const char* const name : {"portable", "codesys", "twincat", "siemens-scl"}) {
    const StOptions options{.dialect = *st_dialect(name)};
    keep(fmt::format("st, {}", name), [&] { return generate_st(program, options); });
  }
  keep("plcopen", [&] { return generate_plcopen(program, {.dialect = "portable"}); });
  keep("drawing", [&] { return Files{{"diagram.dot", diagram_dot(program).text}}; });
  return all;
}

TEST(BlockNames, ABlockOfAnotherNameIsWrittenAlike) {
  RenamedBlocks blocks;
  std::map<std::string, std::size_t> files;
  for (std::uint64_t seed = 5100; seed < 5140; ++seed) {
    const Program program =
        RandomDiagram(seed, "P", 12, {.rates = true, .types = true, .functions = true, .vectors = true}).program();
    const auto wanted = written(program);
    const Program other = blocks.of(program);
    const auto got = written(other);
    for (const auto& [target, wanted_files] : wanted) {
      const Files& got_files = got.at(target);
      ASSERT_EQ(wanted_files.size(), got_files.size()) << target << ", seed " << seed;
      for (std::size_t i = 0; i < got_files.size(); ++i) {
        // The hash of a diagram has the names of its blocks in it.
        ASSERT_EQ(renamed(replaced(wanted_files[i].text, program_hash(program), "HASH")),
                  renamed(replaced(got_files[i].text, program_hash(other), "HASH")))
            << target << ", " << got_files[i].name << ", seed " << seed;
      }
      files[target] += got_files.size();
    }
  }
  for (const auto& [target, count] : files) {
    EXPECT_GT(count, 0U) << target << " wrote nothing";
  }
  EXPECT_GE(blocks.count(), documented_blocks().size()) << "not every block stood in a diagram";
}

// --- what writes it ---

/// Folders of targets, and of what they are told. The pages of the reference show each block at work, so that they
/// know all of them; they are no target.
constexpr std::array<std::string_view, 2> folders_of_targets{"codegen/backends", "codegen/plcopen"};
constexpr std::string_view folder_of_pages = "codegen/backends/reference/";

bool is_of_target(const house::SourceText& file) {
  const std::string_view path = file.path;
  const bool of_tool = std::ranges::any_of(std::array{"tool/target", "tool/fmu.", "tool/batch_", "tool/generate"},
                                           [&](std::string_view begin) { return path.starts_with(begin); });
  return of_tool ||
         (!path.starts_with(folder_of_pages) &&
          std::ranges::any_of(folders_of_targets, [&](std::string_view one) { return path.starts_with(one); }));
}

std::string without_comment(const std::string& line) {
  return line.substr(0, line.find("//"));
}

/// What follows the prefix in a line, with the prefix: names of blocks, and beginnings of such.
std::vector<std::string> names_in(const std::string& line) {
  std::vector<std::string> names;
  for (std::size_t at = line.find(prefix); at != std::string::npos; at = line.find(prefix, at + 1)) {
    const auto end = std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(at), line.end(),
                                      [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    names.emplace_back(line.begin() + static_cast<std::ptrdiff_t>(at), end);
  }
  return names;
}

std::set<std::string> headers_of_blocks() {
  std::set<std::string> headers;
  for (const house::SourceText& file : house::source_files({"blocks"})) {
    if (file.path == "blocks/catalogue.hpp") {
      for (const std::string& line : file.lines) {
        if (line.starts_with("#include \"blocks/")) {
          headers.insert(line);
        }
      }
    }
  }
  return headers;
}

TEST(BlockNames, NoTargetHasOne) {
  const std::vector<const BlockType*> catalogue = documented_blocks();
  const std::set<std::string> headers = headers_of_blocks();
  ASSERT_GT(headers.size(), 100U);
  std::size_t read = 0;
  for (const house::SourceText& file : house::source_files({"codegen", "tool"})) {
    if (!is_of_target(file)) {
      continue;
    }
    ++read;
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      EXPECT_FALSE(headers.contains(file.lines[i])) << file.path << ":" << i + 1 << " knows a block";
      for (const std::string& name : names_in(without_comment(file.lines[i]))) {
        const bool is_block =
            name.size() > prefix.size() &&
            std::ranges::any_of(catalogue, [&](const BlockType* block) { return block->about.name.starts_with(name); });
        EXPECT_FALSE(is_block || name == fmu_type_name)
            << file.path << ":" << i + 1 << " has the name of a block, " << name;
      }
    }
  }
  EXPECT_GT(read, 90U) << "or nothing was read";
}

}  // namespace
}  // namespace hysteron::testing
