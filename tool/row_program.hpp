// Programs that read rows of inputs as doubles and write rows of outputs as doubles: no digit is lost.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tuning/simulation.hpp"

namespace hysteron::tool {

struct RowProgram {
  std::vector<std::string> command{};
  std::string name{};  ///< of the diagram, for messages
  std::size_t outputs = 0;
  std::filesystem::path scratch{};  ///< a folder for its streams
};

/// Runs one over inputs; the values of its outputs, each over all steps. Throws InputError HY726 where it does not come
/// to its end.
[[nodiscard]] std::vector<Signal> run_rows(const RowProgram& program, const Drive& drive);

/// Writes a file that nobody keeps. Throws InputError HY700.
void write_scratch(const std::filesystem::path& path, const std::string& text);

}  // namespace hysteron::tool
