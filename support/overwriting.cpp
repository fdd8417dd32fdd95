#include "support/overwriting.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "support/errors.hpp"

namespace hysteron {

namespace fs = std::filesystem;

bool same_file(const std::string& one, const std::string& other) {
  std::error_code unknown;
  if (one == other || fs::equivalent(one, other, unknown)) {
    return true;
  }
  // Neither needs to be there yet.
  const fs::path first = fs::weakly_canonical(fs::absolute(one, unknown), unknown);
  return !first.empty() && first == fs::weakly_canonical(fs::absolute(other, unknown), unknown);
}

void refuse_to_overwrite(const OutputChoice& output, const std::vector<InputFile>& inputs) {
  for (const InputFile& input : inputs) {
    if (output.file.empty() || input.file.empty() || !same_file(output.file, input.file)) {
      continue;
    }
    throw InputError(error::overwrites_input, output.place.file.empty() ? Place{.file = output.file} : output.place,
                     fmt::format("The output {} would overwrite the input {}{}.", output.file, input.file,
                                 input.named_by.empty() ? "" : fmt::format(", which {} names", input.named_by)),
                     output.mend);
  }
}

}  // namespace hysteron
