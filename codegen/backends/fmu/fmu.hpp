// The FMU target: what an FMU holds beside its binary. The tool compiles the sources and packs the archive.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

enum class FmiVersion : std::uint8_t { Two, Three };

struct FmuOptions {
  FmiVersion version = FmiVersion::Three;
  bool float32 = false;  ///< real numbers of the target are float
};

struct FmuContents {
  std::string model_identifier{};      ///< the name of the FMU and of its binary
  std::string binary{};                ///< where a binary for 64-bit Linux on x86 belongs in the archive
  std::vector<std::string> sources{};  ///< the C files to be compiled, by their names in the archive
  std::vector<GeneratedFile> files{};  ///< by their names in the archive; modelDescription.xml is the first
};

/// A co-simulation FMU. The text depends on the program alone, to the byte. Throws InputError (HY404) where the diagram
/// states no sample time.
FmuContents generate_fmu(const Program& program, const FmuOptions& options = {});

}  // namespace hysteron
