// What `hysteron diagnose` prints and writes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "support/atomic_file.hpp"

namespace hysteron::tool {

/// The verdict for the terminal.
[[nodiscard]] std::string diagnosis_text(const diagnosis::Diagnosis& found);

/// Whether a file of this name may be among those of a diagnosis.
[[nodiscard]] bool is_diagnosis_file(std::string_view name);

/// All files of a diagnosis, below a folder.
[[nodiscard]] std::vector<OutputFile> diagnosis_files(const std::filesystem::path& folder,
                                                      const diagnosis::Diagnosis& found);

/// Writes them, all or none, and removes what an earlier diagnosis left there under names of ours: the folder then
/// holds one verdict. The caller has made sure that none of these is an input. Throws InputError HY700.
void write_diagnosis(const std::filesystem::path& folder, const diagnosis::Diagnosis& found);

}  // namespace hysteron::tool
