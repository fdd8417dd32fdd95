// The A2L file beside generated C: its structures by the symbols of the linker, and at their addresses once the program
// is linked.
#pragma once

#include <string>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::tool {

struct CalibrationOptions {
  bool wanted = false;
  std::string elf{};                   ///< the linked program; empty before there is one
  std::vector<std::string> symbols{};  ///< params=NAME, state=NAME+OFFSET
};

/// Throws InputError HY730 where --elf or --symbol stand alone, or a symbol is not said as STRUCTURE=NAME.
void check_calibration(const CalibrationOptions& options);

/// NAME.a2l. A structure that the program does not hold, and that --symbol does not name, is left out with a warning;
/// the parameters never are. Throws InputError HY745 where the program has no such symbol, several, or one of another
/// size.
[[nodiscard]] GeneratedFile calibration_file(const Program& program, const CalibrationOptions& options, bool float32,
                                             Diagnostics& warnings);

}  // namespace hysteron::tool
