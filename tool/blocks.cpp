#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "codegen/backends/reference/block_page.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/graph/other_names.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/wrapped.hpp"
#include "tool/block_card.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view blocks_examples = R"(Examples:
  hysteron blocks                 all blocks, by group
  hysteron blocks HY_LAG          equation, pins, units, ranges, defaults, feedthrough, delay
  hysteron blocks lag --json
  hysteron blocks friction        the blocks that tell of it
  hysteron blocks FT_PT1          by the name of another library: OSCAT, CODESYS, Simulink
  hysteron blocks motor.fmu       an FMU: its pins, parameters, units, and what is left out
  hysteron blocks --markdown      the reference of the whole library

A unit with a quote, such as 'x, stands for whatever unit is connected; 'x/s is that unit per second.
)";

constexpr std::array groups{Group::Memory,  Group::Arithmetic, Group::Function, Group::Shaping, Group::Dynamics,
                            Group::Control, Group::Logic,      Group::Time,     Group::Rate};

struct BlocksOptions {
  std::vector<std::string> words;  ///< of a name, or to look for
  bool json = false;
  bool markdown = false;
};

/// The block of a name, with or without its HY_, or by the name of another library; null where there is none.
const BlockType* named_block(const std::string& name) {
  if (equal_ignoring_case(std::filesystem::path(name).extension().string(), ".fmu")) {
    return &fmu_block(name);
  }
  std::string joined = name;  // dead time is HY_DEAD_TIME
  std::ranges::replace(joined, ' ', '_');
  for (const auto& candidate : {joined, "HY_" + joined, std::string(block_of_other_name(name))}) {
    if (const BlockType* const block = find_documented_block(candidate)) {
      return block;
    }
  }
  return nullptr;
}

/// The blocks whose name or title has the word, then those that only speak of it.
std::vector<const BlockType*> blocks_that_tell_of(const std::string& word) {
  const std::string wanted = in_capitals(word);
  const auto has = [&](std::string_view text) { return in_capitals(text).find(wanted) != std::string::npos; };
  std::vector<const BlockType*> named;
  std::vector<const BlockType*> others;
  for (const BlockType* const block : documented_blocks()) {
    if (has(block->about.name) || has(block->about.title)) {
      named.push_back(block);
    } else if (has(block->about.meaning)) {
      others.push_back(block);
    }
  }
  named.insert(named.end(), others.begin(), others.end());
  return named;
}

std::size_t widest_name() {
  std::size_t width = 0;
  for (const BlockType* const block : documented_blocks()) {
    width = std::max(width, block->about.name.size());
  }
  return width;
}

std::string line_of(const BlockType& block) {
  return fmt::format("  {:<{}}  {}\n", block.about.name, widest_name(), block.about.title);
}

/// The blocks that are named in part after another: hysteresis is the standard's switch, and several models of it.
std::string further_blocks(const BlockType& shown) {
  constexpr std::string_view ours = "HY_";
  if (!shown.about.name.starts_with(ours)) {
    return "";
  }
  const std::string part = "_" + std::string(shown.about.name.substr(ours.size())) + "_";
  std::string text;
  for (const BlockType* const block : documented_blocks()) {
    if (block != &shown && (std::string(block->about.name) + "_").find(part) != std::string::npos) {
      text += line_of(*block);
    }
  }
  return text.empty() ? text : "\nfurther blocks of the name\n" + text;
}

[[noreturn]] void refuse_unknown(const std::string& name) {
  if (const std::string first = name.substr(0, name.find(' ')); first != name && named_block(first) != nullptr) {
    throw InputError(error::unknown_block, {}, fmt::format("There is no block {} in the library.", name),
                     fmt::format("ask for one at a time: `hysteron blocks {}`.", first));
  }
  std::vector<std::string_view> known;
  for (const BlockType* const block : documented_blocks()) {
    known.push_back(block->about.name);
  }
  auto near = nearest_name(name, known);
  near = near.empty() ? nearest_name("HY_" + name, known) : near;
  throw InputError(error::unknown_block, {}, fmt::format("There is no block {} in the library.", name),
                   near.empty() ? "`hysteron blocks` lists them." : fmt::format("did you mean {}?", near));
}

std::vector<const BlockType*> blocks_of(Group group) {
  std::vector<const BlockType*> list = documented_blocks();
  std::erase_if(list, [&](const BlockType* block) { return block->about.group != group; });
  std::sort(list.begin(), list.end(),
            [](const BlockType* a, const BlockType* b) { return a->about.name < b->about.name; });
  return list;
}

std::string listed() {
  std::string text;
  for (const Group group : groups) {
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", group_name(group));
    for (const BlockType* const block : blocks_of(group)) {
      text += line_of(*block);
    }
  }
  return text;
}

std::string reference() {
  std::string text = "# The blocks\n";
  for (const Group group : groups) {
    auto title = std::string(group_name(group));
    title.front() = static_cast<char>(title.front() - 'a' + 'A');
    text += fmt::format("\n## {}\n", title);
    for (const BlockType* const block : blocks_of(group)) {
      text += "\n" + block_page(*block, {.heading = 3});
    }
  }
  return text;
}

/// What a word that names no block leads to.
std::string found(const std::string& word, const BlocksOptions& options) {
  const std::vector<const BlockType*> blocks = blocks_that_tell_of(word);
  if (blocks.empty()) {
    refuse_unknown(word);
  }
  auto list = nlohmann::json::array();
  std::string text = options.markdown ? std::string() : fmt::format("blocks that tell of {}\n", word);
  for (const BlockType* const block : blocks) {
    list.push_back(card_json(*block));
    text += options.markdown ? block_page(*block) + "\n" : line_of(*block);
  }
  return options.json ? list.dump(2) + "\n" : text;
}

int show_blocks(const BlocksOptions& options, Console& console) {
  if (!options.words.empty()) {
    const std::string name = fmt::format("{}", fmt::join(options.words, " "));
    const BlockType* const block = named_block(name);
    console.print(block == nullptr   ? found(name, options)
                  : options.json     ? card_json(*block).dump(2) + "\n"
                  : options.markdown ? block_page(*block)
                                     : card_text(*block, terminal_width(stdout)) + further_blocks(*block));
  } else if (options.json) {
    auto list = nlohmann::json::array();
    for (const BlockType* const block : documented_blocks()) {
      list.push_back(card_json(*block));
    }
    console.print(list.dump(2) + "\n");
  } else {
    console.print(options.markdown ? reference() : listed());
  }
  return exit_ok;
}

}  // namespace

Action add_blocks(CLI::App& app) {
  const auto options = std::make_shared<BlocksOptions>();
  app.add_option("NAME", options->words,
                 "The block to describe, with or without its HY_; the file of an FMU; or words to look for.")
      ->option_text(" ");
  auto* const json = app.add_flag("--json", options->json, "Prints JSON.");
  app.add_flag("--markdown", options->markdown, "Prints Markdown, as in the reference.")->excludes(json);
  app.footer(std::string(blocks_examples));
  return [options](Console& console) { return show_blocks(*options, console); };
}

}  // namespace hysteron::tool
