// Where measured records lie. They are not part of the project: each comes from a public repository of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace hysteron::records {

/// The folder named by the environment variable HYSTERON_DATA; else the first that exists of ../shared/data as seen
/// from the current folder and from `source_folder`; else nothing. Throws InputError HY100 where HYSTERON_DATA names
/// no folder: a mistyped path is not passed over.
[[nodiscard]] std::optional<std::filesystem::path> data_folder(const std::filesystem::path& source_folder = {});

/// A file below that folder, such as "piezo-picma-dbo/identify_1hz.csv"; nothing where there is none.
[[nodiscard]] std::optional<std::filesystem::path> find_record(std::string_view name,
                                                               const std::filesystem::path& source_folder = {});

}  // namespace hysteron::records
