// What kind of file a command was given, found from its name and, of JSON, from what is in it.
#pragma once

#include <string>
#include <string_view>

namespace hysteron::tool {

enum class FileKind { Record, Parameters, Diagram, Verdict };

/// A diagram ends in .st or .iecst, a parameter file in .toml; a .json with a verdict is a verdict. Everything else is
/// a record, whatever it is called: its reader finds out. Throws InputError HY100 where the file cannot be read.
[[nodiscard]] FileKind kind_of_file(const std::string& path);

/// "a record", "a parameter file", "a diagram", "a verdict".
[[nodiscard]] std::string_view words_of(FileKind kind);

}  // namespace hysteron::tool
