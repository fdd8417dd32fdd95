#include "tool/row_program.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>

#include "support/errors.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"
#include "tool/compiler.hpp"
#include "tool/process.hpp"

namespace hysteron::tool {

void write_scratch(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    throw InputError(error::unwritable_file, {.file = path.string()},
                     fmt::format("The file {} cannot be written.", path.string()),
                     "make room on the disk, or set TMPDIR to another folder.");
  }
}

std::vector<Signal> run_rows(const RowProgram& program, const Drive& drive) {
  std::vector<double> rows;
  rows.reserve(drive.steps * drive.inputs.size());
  for (std::size_t k = 0; k < drive.steps; ++k) {
    for (const Signal& input : drive.inputs) {
      rows.push_back(at_step(input, k));
    }
  }
  std::string bytes(rows.size() * sizeof(double), '\0');
  if (!rows.empty()) {
    std::memcpy(bytes.data(), rows.data(), bytes.size());
  }
  const TemporaryFolder folder(program.scratch);
  const Streams streams{
      .input = folder.path() / "in", .output = folder.path() / "out", .errors = folder.path() / "err"};
  write_scratch(streams.input, bytes);
  const int code = run_program(program.command, streams);
  const auto written = code == 0 ? read_text_file(streams.output.string()) : std::string();
  if (code != 0 || written.size() != drive.steps * program.outputs * sizeof(double)) {
    throw InputError(error::generated_code_fails, {},
                     fmt::format("The program generated from {} does not run to its end (exit code {}):{}",
                                 program.name, code, first_lines(streams.errors)),
                     "see whether programs may be run from the folder for temporary files; TMPDIR sets another.");
  }
  std::vector<Signal> outputs(program.outputs, Signal(drive.steps));
  for (std::size_t k = 0; k < drive.steps; ++k) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      std::memcpy(&outputs[i][k], written.data() + (k * outputs.size() + i) * sizeof(double), sizeof(double));
    }
  }
  return outputs;
}

}  // namespace hysteron::tool
