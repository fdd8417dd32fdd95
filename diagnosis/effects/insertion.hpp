// Changes to the text of a diagram: an effect put on an edge, a block replaced by a richer one.
//
// The text is what is changed, not the graph, so that what was fitted is what the user gets as improved.st, and a
// candidate is checked like anything that a user writes. Statements may then stand in any order; format_text puts them
// right.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/language/syntax.hpp"
#include "diagnosis/effects/edges.hpp"

namespace hysteron::diagnosis {

/// A block that stands between a signal and what reads its XOUT.
struct Helper {
  std::string block{};     ///< HY_DELAY
  std::string instance{};  ///< its name: no other declared one of the block
  std::string signal{};    ///< the text that drives its XIN
};

/// A block to be put on an edge: XIN is the signal, whatever read it reads XOUT instead.
struct Insertion {
  std::string block{};     ///< HY_CREEP, or a FUNCTION_BLOCK of the file
  std::string instance{};  ///< its name: no other declared one of the block
  std::string input = "XIN";
  std::string output = "XOUT";
  std::vector<std::pair<std::string, std::string>> wires{};  ///< further pins, and the text that drives each
  std::vector<Helper> helpers{};                             ///< that are put there too, for these to read
  std::string new_input{};  ///< an LREAL input that the block gets, with the default 0; empty: none
};

[[nodiscard]] std::string with_effect(const language::SourceFile& source, const Edge& edge, const Insertion& insertion);

/// With an output that gives the signal of an edge. The name is one that the block does not declare yet.
[[nodiscard]] std::string with_output(const language::SourceFile& source, const Edge& edge, std::string_view name);

/// With the sum of a block that adds to its XIN written out: its XIN is 0, and what read its XOUT reads both. The text
/// as it is where the block of that definition has no such instance with an XIN.
[[nodiscard]] std::string with_sum_outside(const language::SourceFile& source, std::uint32_t definition,
                                           std::string_view instance);

/// With the type of an instance replaced. All instances declared in the same breath, X, Y : TYPE, change.
[[nodiscard]] std::string with_block(const language::SourceFile& source, const language::Variable& instance,
                                     std::string_view block);

/// A name that a block does not declare yet: the wish, or the wish with a number behind it.
[[nodiscard]] std::string free_name(const language::FunctionBlock& block, std::string_view wish);

}  // namespace hysteron::diagnosis
