// The import of TwinCAT's own files, .TcPOU, .TcDUT and .TcGVL: the declaration and the body in Structured Text that
// the editor keeps apart, and the blocks, functions, types and global variables of other files that they name.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "codegen/import/plcopen_import.hpp"

namespace hysteron {

/// A file of a project, and what is in it.
struct ProjectFile {
  std::string path{};
  std::string text{};
};

/// The file of an object by its name, or of a list by one of its variables, without regard to case; nothing where the
/// project has none.
using FindObject = std::function<std::optional<ProjectFile>(std::string_view name)>;

/// Whether a text is a file of an object of TwinCAT.
bool is_twincat_object(std::string_view text);

/// The text of an object and of all that it needs, those that others need first. A FUNCTION_BLOCK has a sequential
/// body; that of the file itself has the sample time of the options. Comments and layout stay. Throws InputError: HY743
/// where a file is no such XML, HY744 with every method, property, action and body in another language.
std::string import_twincat(const ProjectFile& file, const FindObject& find, const ImportOptions& options);

}  // namespace hysteron
