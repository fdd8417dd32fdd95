// A program beside ours that turns one text into another file, such as dot of Graphviz: called and not linked.
#pragma once

#include <string>
#include <vector>

namespace hysteron::tool {

struct OutsideProgram {
  std::string name{};
  std::string variable{};  ///< of the environment, which names another one
  std::string package{};   ///< of Debian
  int missing = 0;         ///< the error where there is none
  int failed = 0;          ///< the error where it gives nothing
  std::string trial{};     ///< a command that shows whether it works at all
};

/// Where it is. `without` says what needs none. Throws InputError `missing`.
[[nodiscard]] std::string found(const OutsideProgram& program, const std::string& without);

/// What it makes of a text, which is given to it as a file behind the arguments. Throws InputError `missing`, `failed`.
[[nodiscard]] std::string converted(const OutsideProgram& program, const std::vector<std::string>& arguments,
                                    const std::string& text, const std::string& without);

}  // namespace hysteron::tool
