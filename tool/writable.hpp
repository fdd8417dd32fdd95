// Whether outputs can be written, asked before long work.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace hysteron::tool {

/// The folder of an output file is there and can be written, and the name is no folder. Throws InputError HY700. A
/// folder that is not there is more often a slip than a wish: none is made.
void refuse_unwritable(const std::string& file);

/// The same for a folder that is to be made, with those above it.
void refuse_unwritable_folder(const std::string& folder);

/// A file that is there with another text was generated, too, and is not someone's own: a project has a main.cpp and a
/// CMakeLists.txt of its own. Throws InputError HY731 with this mend.
void refuse_foreign_file(const std::filesystem::path& path, std::string_view text, const std::string& mend);

}  // namespace hysteron::tool
