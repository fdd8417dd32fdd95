// The A2L target: a description of the generated C structures for tools of measurement and calibration, in ASAM MCD-2
// MC (ASAP2) 1.6. Parameters are CHARACTERISTICs; inputs, outputs and states are MEASUREMENTs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "codegen/backends/c/memory.hpp"
#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

/// A structure in the memory of the target.
struct A2lObject {
  bool there = true;                       ///< else it is left out
  std::string symbol{};                    ///< of the linker
  std::uint64_t offset = 0;                ///< of the structure in the symbol
  std::optional<std::uint32_t> address{};  ///< of the structure; none before the program is linked
};

struct A2lOptions {
  bool float32 = false;
  bool big_endian = false;
  std::array<A2lObject, c_structure_names.size()> objects{};  ///< by CStructure
};

/// NAME.a2l. Throws InputError HY404 where the diagram states no sample time.
[[nodiscard]] GeneratedFile generate_a2l(const Program& program, const A2lOptions& options);

/// The bytes of each structure, for whoever looks for it.
[[nodiscard]] std::array<std::size_t, c_structure_names.size()> a2l_sizes(const Program& program, bool float32);

}  // namespace hysteron
