// Reading a whole file, with an error that says why it cannot be read.
#pragma once

#include <string>

namespace hysteron {

/// The bytes of a file. Throws InputError HY100 where it is missing, a directory, not permitted or not readable.
[[nodiscard]] std::string read_text_file(const std::string& path);

}  // namespace hysteron
