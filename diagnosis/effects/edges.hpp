// The edges of a diagram: the wires on which an effect can be inserted, each once, by the name an engineer gives it.
//
// An edge is either everything that reads one signal (`HYST.XOUT`, `U`), or one place where a signal is computed or
// handed on (`HYST.XIN` where the text says `HYST(XIN := U - OFFSET)`, `Y` where it says `Y := A.XOUT + B.XOUT`).
// Where both are the same wire, the name of the signal is kept and the other one is an alias.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron::diagnosis {

struct Edge {
  std::string name{};                   ///< PLANT.HYST.XOUT, in capitals
  std::vector<std::string> aliases{};   ///< other names of the same wire: Y, HYST.XIN
  std::uint32_t definition = 0;         ///< the FUNCTION_BLOCK that it lies in, by its place in the file
  std::string prefix{};                 ///< of the instance of that block: "PLANT.", empty in the top block
  std::string local{};                  ///< the name within the block: HYST.XOUT
  std::string source{};                 ///< the text that computes the signal: HYST.XOUT, or U - OFFSET
  std::vector<language::Span> reads{};  ///< the places in the text that are to read the changed signal instead
};

/// A FUNCTION_BLOCK of the file where it is used.
struct BlockInstance {
  std::uint32_t definition = 0;  ///< by its place in the file
  std::string prefix{};          ///< "PLANT.", empty for the top block
};

/// A block and all that it contains, each where it is used, the outer ones first.
[[nodiscard]] std::vector<BlockInstance> instances_of(const Definitions& definitions, std::uint32_t top);

/// The edges of a block and of all that it contains, those of the outer blocks first. Only LREAL signals, and only
/// those that something reads.
[[nodiscard]] std::vector<Edge> edges_of(const Definitions& definitions, std::uint32_t top);

/// The same of a text that compiled before.
[[nodiscard]] std::vector<Edge> edges_of_text(const std::string& text, std::string_view top);

/// The definition of the top block of a compiled program, by its place in the file.
[[nodiscard]] std::uint32_t top_definition(const Definitions& definitions, std::string_view name);

/// The edge of a name or alias, without regard to case; null where there is none.
[[nodiscard]] const Edge* find_edge(const std::vector<Edge>& edges, std::string_view name);

}  // namespace hysteron::diagnosis
