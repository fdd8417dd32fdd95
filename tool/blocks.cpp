#include <fmt/format.h>

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
#include "support/errors.hpp"
#include "support/names.hpp"
#include "tool/block_card.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view blocks_examples = R"(Examples:
  hysteron blocks                 all blocks, by group
  hysteron blocks HY_LAG          equation, pins, units, ranges, defaults, feedthrough, delay
  hysteron blocks lag --json
  hysteron blocks FT_PT1          by the name of another library: OSCAT, CODESYS, Simulink
  hysteron blocks motor.fmu       an FMU: its pins, parameters, units, and what is left out
  hysteron blocks --markdown      the reference of the whole library

A unit with a quote, such as 'x, stands for whatever unit is connected; 'x/s is that unit per second.
)";

constexpr std::array groups{Group::Memory,  Group::Arithmetic, Group::Function, Group::Shaping, Group::Dynamics,
                            Group::Control, Group::Logic,      Group::Time,     Group::Rate};

struct BlocksOptions {
  std::string name;
  bool json = false;
  bool markdown = false;
};

const BlockType& find_block(const std::string& name) {
  if (equal_ignoring_case(std::filesystem::path(name).extension().string(), ".fmu")) {
    return fmu_block(name);
  }
  for (const auto& candidate : {name, "HY_" + name, std::string(block_of_other_name(name))}) {
    if (const BlockType* const block = find_block_type(candidate)) {
      return *block;
    }
  }
  std::vector<std::string_view> known;
  for (const BlockType& block : block_types()) {
    known.push_back(block.about.name);
  }
  auto near = nearest_name(name, known);
  near = near.empty() ? nearest_name("HY_" + name, known) : near;
  throw InputError(error::unknown_block, {}, fmt::format("There is no block {} in the library.", name),
                   near.empty() ? "`hysteron blocks` lists them." : fmt::format("did you mean {}?", near));
}

std::vector<const BlockType*> blocks_of(Group group) {
  std::vector<const BlockType*> list;
  for (const BlockType& block : block_types()) {
    if (block.about.group == group) {
      list.push_back(&block);
    }
  }
  std::sort(list.begin(), list.end(),
            [](const BlockType* a, const BlockType* b) { return a->about.name < b->about.name; });
  return list;
}

std::string listed() {
  std::size_t width = 0;
  for (const BlockType& block : block_types()) {
    width = std::max(width, block.about.name.size());
  }
  std::string text;
  for (const Group group : groups) {
    text += fmt::format("{}{}\n", text.empty() ? "" : "\n", group_name(group));
    for (const BlockType* const block : blocks_of(group)) {
      text += fmt::format("  {:<{}}  {}\n", block->about.name, width, block->about.title);
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

int show_blocks(const BlocksOptions& options, Console& console) {
  if (!options.name.empty()) {
    const BlockType& block = find_block(options.name);
    console.print(options.json       ? card_json(block).dump(2) + "\n"
                  : options.markdown ? block_page(block)
                                     : card_text(block));
  } else if (options.json) {
    auto list = nlohmann::json::array();
    for (const BlockType& block : block_types()) {
      list.push_back(card_json(block));
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
  app.add_option("NAME", options->name, "The block to describe, with or without its HY_; or the file of an FMU.")
      ->option_text(" ");
  auto* const json = app.add_flag("--json", options->json, "Prints JSON.");
  app.add_flag("--markdown", options->markdown, "Prints Markdown, as in the reference.")->excludes(json);
  app.footer(std::string(blocks_examples));
  return [options](Console& console) { return show_blocks(*options, console); };
}

}  // namespace hysteron::tool
