// Which registers this processor has, of those that code was compiled for (hysteron_registers() in CMakeLists.txt).
#pragma once

namespace hysteron {

/// Of 256 bits (AVX2): four numbers.
[[nodiscard]] bool has_registers_of_four();

/// Of 512 bits (AVX-512): eight numbers.
[[nodiscard]] bool has_registers_of_eight();

}  // namespace hysteron
