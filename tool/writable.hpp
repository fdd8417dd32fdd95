// Whether outputs can be written, asked before long work.
#pragma once

#include <string>

namespace hysteron::tool {

/// The folder of an output file is there and can be written, and the name is no folder. Throws InputError HY700. A
/// folder that is not there is more often a slip than a wish: none is made.
void refuse_unwritable(const std::string& file);

/// The same for a folder that is to be made, with those above it.
void refuse_unwritable_folder(const std::string& folder);

}  // namespace hysteron::tool
