// What `hysteron diagnose` prints and writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "support/atomic_file.hpp"

namespace hysteron::tool {

/// The verdict for the terminal.
[[nodiscard]] std::string diagnosis_text(const diagnosis::Diagnosis& found);

/// All files of a diagnosis, below a folder.
[[nodiscard]] std::vector<OutputFile> diagnosis_files(const std::filesystem::path& folder,
                                                      const diagnosis::Diagnosis& found);

}  // namespace hysteron::tool
