// A diagram as a network of function blocks: boxes for instances, operators and functions, and the wires between them.
//
// The order of execution is that of the statements, so every editor computes what the text says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "codegen/backends/st/pou.hpp"
#include "codegen/graph/definition.hpp"

namespace hysteron::plcopen {

/// Where a wire comes from: an element of the network, and its pin where it is a block.
struct Source {
  std::size_t element = 0;
  std::string pin{};
};

struct Input {
  std::string pin{};
  Source from{};
};

struct Element {
  enum class Kind : std::uint8_t { Read, Assign, Block };
  Kind kind = Kind::Read;
  std::string text{};      ///< what is read or assigned; of a block its type or function
  std::string instance{};  ///< empty for a function
  std::vector<Input> inputs{};
  std::vector<std::string> outputs{};
  std::uint32_t order = 0;  ///< of execution, from 1; 0: a read
  int x = 0;                ///< left
  int y = 0;                ///< top
};

struct Network {
  std::string name{};  ///< of the POU
  std::vector<StSection> sections{};
  std::vector<Element> elements{};
};

/// What the networks of a program are made with.
struct NetworkOptions {
  bool float32 = false;
  bool small_literals = false;  ///< see StDialect
};

/// The networks of the blocks of the text, those that others contain first, the top block last; and the blocks of the
/// library that they call.
struct Networks {
  std::vector<Network> list{};
  struct Used {
    const BlockType* block = nullptr;
    std::vector<bool> ahead{};  ///< by output: all instances hand out memory alone
  };
  std::vector<Used> library{};  ///< by name
};

/// Throws InputError HY742 with all that no network can hold: several rates, arrays, values that differ between
/// instances of one block.
Networks make_networks(const Program& program, const NetworkOptions& options);

}  // namespace hysteron::plcopen
