#include <CLI/CLI.hpp>
#include <iostream>

#include "lsp/server.hpp"
#include "tool/block_card.hpp"
#include "tool/commands.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view lsp_examples = R"(Examples:
  hysteron lsp

An editor starts it and speaks with it over its standard input and output, by the Language Server Protocol 3.17. It gives
the diagnostics of `check`, the card of a block, completion of block types, pins and variables, and the layout of `fmt`.
Exit codes: 0 the editor took leave by shutdown and exit; 1 it did not.
)";

}  // namespace

Action add_lsp(CLI::App& app) {
  app.footer(std::string(lsp_examples));
  return
      [](Console&) { return lsp::serve(std::cin, std::cout, [](const BlockType& block) { return card_text(block); }); };
}

}  // namespace hysteron::tool
