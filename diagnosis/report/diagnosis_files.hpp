// The files that a diagnosis is written as: verdict.json, report.html, improved.st, …
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/diagnosis.hpp"
#include "support/atomic_file.hpp"

namespace hysteron::diagnosis {

/// Whether a file of this name may be among those of a diagnosis.
[[nodiscard]] bool is_diagnosis_file(std::string_view name);

/// The name of the traces of a number from 1 on: the only ones, or one of several.
[[nodiscard]] std::string traces_file(std::size_t number, std::size_t count);

/// All files of a diagnosis, below a folder.
[[nodiscard]] std::vector<OutputFile> diagnosis_files(const std::filesystem::path& folder, const Diagnosis& found);

}  // namespace hysteron::diagnosis
