// Where the members of the generated C structures lie: each at a multiple of its size, as in the ABIs of ARM, RISC-V
// and x86-64.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/layout.hpp"

namespace hysteron {

enum class CStructure : std::uint8_t { Params, State, In, Out };
inline constexpr std::array<std::string_view, 4> c_structure_names{"params", "state", "in", "out"};

struct CStructurePlaces {
  std::vector<std::size_t> offsets{};  ///< by index of the parameter, cell, input or output
  std::size_t size = 0;
};
using CMemory = std::array<CStructurePlaces, c_structure_names.size()>;

/// In bytes. A structure without members holds one.
[[nodiscard]] CMemory c_memory(const Graph& graph, const Routine& routine, bool float32);

/// What a value of a type takes.
[[nodiscard]] std::size_t c_size(Type type, bool float32);

}  // namespace hysteron
