// What `hysteron diagnose` prints and writes.
#pragma once

#include <filesystem>
#include <string>

#include "diagnosis/diagnosis.hpp"

namespace hysteron::tool {

/// The verdict for the terminal.
[[nodiscard]] std::string diagnosis_text(const diagnosis::Diagnosis& found);

/// Writes the files of a diagnosis, all or none, and removes what an earlier diagnosis left there under names of ours:
/// the folder then holds one verdict. The caller has made sure that none of these is an input. Throws InputError HY700.
void write_diagnosis(const std::filesystem::path& folder, const diagnosis::Diagnosis& found);

}  // namespace hysteron::tool
