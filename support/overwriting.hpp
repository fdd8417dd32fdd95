// Whether an output would take the place of a file that the same command reads: asked before any work.
#pragma once

#include <string>
#include <vector>

#include "support/diagnostic.hpp"

namespace hysteron {

/// A file that is read. An empty name is none, and is ignored.
struct InputFile {
  std::string file{};
  std::string named_by{};  ///< the option, or the key of a file; empty where the command names it as its argument
};

struct OutputChoice {
  std::string file{};
  std::string mend = "give the output another name.";
  Place place{};  ///< where it is named; else the error is at the output itself
};

/// Whether two names are of one file, or would be: by links, by relative paths.
[[nodiscard]] bool same_file(const std::string& one, const std::string& other);

/// Throws InputError HY709 where the output is one of the inputs, under whatever name. An empty output is none.
void refuse_to_overwrite(const OutputChoice& output, const std::vector<InputFile>& inputs);

}  // namespace hysteron
